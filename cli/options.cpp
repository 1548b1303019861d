#include "cli/options.h"

#include <iostream>
#include <sstream>

namespace triglyph {
namespace {

Key trial_key() {
  std::cerr << "triglyph: warning: no --key-file, using the public trial key that anyone can read "
               "and forge\n";
  return Key::trial();
}

// Width of the descriptions in help: with the column of names, lines have 100 characters.
constexpr std::size_t kDescriptionWidth = 70;

// Returns the text in lines of at most kDescriptionWidth characters, broken at blanks.
std::string wrapped(const std::string& text) {
  std::istringstream stream(text);
  std::string result;
  std::size_t column = 0;
  for (std::string word; stream >> word; column += word.size()) {
    const bool is_full = column > 0 && column + 1 + word.size() > kDescriptionWidth;
    if (column > 0) result += is_full ? '\n' : ' ';
    column = is_full ? 0 : column + (column > 0 ? 1 : 0);
    result += word;
  }
  return result;
}

class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(CLI::Formatter::make_option_desc(option));
  }
};

// Returns what help shows behind the option's name.
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

// Returns the line of help, with the range and the default in parentheses.
std::string description(const OptionSpec& spec) {
  std::string note = spec.range_text();
  if (!spec.default_text.empty()) {
    note += (note.empty() ? "default: " : "; default: ") + spec.default_text;
  }
  return note.empty() ? spec.help : spec.help + " (" + note + ")";
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

std::shared_ptr<CLI::Formatter> make_help_formatter() {
  return std::make_shared<HelpFormatter>();
}

void KeyArgument::add_to(CLI::App& verb) {
  verb.add_option("--key-file", file_, "Secret key made by keygen (default: a public trial key)")
      ->type_name("FILE");
}

Key KeyArgument::load() const {
  return file_.empty() ? trial_key() : Key::load(file_);
}

void KeysArgument::add_to(CLI::App& verb) {
  verb.add_option("--key-file", files_,
                  "Secret key made by keygen; may be given several times (default: a public trial "
                  "key)")
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
  verb.add_option("--threads", threads_, "Threads to use (1 to 1024; default: all)")
      ->check(CLI::Range(1, 1024).description(""))
      ->type_name("N");
}

void MachineArguments::add_memory_to(CLI::App& verb) {
  verb.add_option(
          "--memory", memory_,
          "Memory for the meshes in process, such as 500M or 16G; a larger mesh is processed "
          "alone (default: 4G)")
      ->transform(CLI::AsSizeValue(false).description(""))
      ->type_name("SIZE");
}

}  // namespace triglyph
