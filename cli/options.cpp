#include "cli/options.h"

#include <iostream>

namespace triglyph {
namespace {

Key trial_key() {
  std::cerr << "triglyph: warning: no --key-file, using the public trial key that anyone can read "
               "and forge\n";
  return Key::trial();
}

// What help shows behind the option's name.
std::string type_name(const OptionSpec& spec) {
  switch (spec.kind) {
    case OptionKind::Flag:
      return "";
    case OptionKind::Count:
    case OptionKind::Number:
      return "N";
    case OptionKind::Choice:
      return CLI::detail::join(spec.choices, "|");
    case OptionKind::Text:
      return "TEXT";
  }
  return "";
}

// The line of help: what it is, its range and its default.
std::string description(const OptionSpec& spec) {
  std::string text = spec.help;
  if (spec.kind == OptionKind::Count || spec.kind == OptionKind::Number) {
    text += "; " + spec.domain();
  }
  if (!spec.default_text.empty()) text += " [" + spec.default_text + "]";
  return text;
}

}  // namespace

std::vector<std::string> strings(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

void add_declared_options(CLI::App& verb, const std::vector<OptionSpec>& specs,
                          OptionValues& values) {
  for (const OptionSpec& spec : specs) {
    if (spec.kind == OptionKind::Flag) {
      verb.add_flag_function(
          spec.flag(), [&spec, &values](std::int64_t count) { values[spec.key] = count > 0; },
          description(spec));
      continue;
    }
    verb.add_option_function<std::string>(
            spec.flag(),
            [&spec, &values](const std::string& text) { values[spec.key] = spec.parsed(text); },
            description(spec))
        ->type_name(type_name(spec));
  }
}

void KeyArgument::add_to(CLI::App& verb) {
  verb.add_option("--key-file", file_, "Secret key made by keygen; a public trial key without it")
      ->type_name("FILE");
}

Key KeyArgument::load() const {
  return file_.empty() ? trial_key() : Key::load(file_);
}

void KeysArgument::add_to(CLI::App& verb) {
  verb.add_option("--key-file", files_,
                  "Secret key made by keygen, may be given several times; a public trial key "
                  "without it")
      ->type_name("FILE")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
}

std::vector<Key> KeysArgument::load() const {
  if (files_.empty()) return {trial_key()};
  std::vector<Key> keys;
  for (const std::filesystem::path& file : files_) keys.push_back(Key::load(file));
  return keys;
}

void MachineArguments::add_threads_to(CLI::App& verb) {
  verb.add_option("--threads", threads_, "Threads to use [all]")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
}

void MachineArguments::add_memory_to(CLI::App& verb) {
  verb.add_option("--memory", memory_,
                  "Memory for meshes in work, such as 4G; a larger mesh goes alone")
      ->transform(CLI::AsSizeValue(false))
      ->default_str("4G");
}

}  // namespace triglyph
