#include "cli/manual/man_page.h"

#include <algorithm>
#include <cctype>

namespace triglyph {
namespace {

// Text as roff takes it literally: no line begins a request, no character an escape.
std::string escaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins_line = i == 0 || text[i - 1] == '\n';
    if (begins_line && (text[i] == '.' || text[i] == '\'')) result += "\\&";
    switch (text[i]) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      default:
        result += text[i];
    }
  }
  return result;
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + escaped(text) + "\\fR";
}

std::string with_dashes(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

// "Hide a message in meshes." as the end of a NAME line: "hide a message in meshes".
std::string as_phrase(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::string as_sentence(std::string text) {
  const char last = text.empty() ? '.' : text.back();
  if (last != '.' && last != '?') text += '.';
  return text;
}

// What stands behind the option; empty for a flag.
std::string value_name_of(const CLI::Option& option) {
  return option.get_items_expected_max() == 0 ? "" : option.get_type_name();
}

void append_option(std::string& page, const CLI::Option& option) {
  page += ".TP\n";
  const std::string value = value_name_of(option);
  if (option.get_positional()) {
    page += italic(value.empty() ? option.get_name() : value) + "\n";
  } else {
    std::string names;
    for (const std::string& name : option.get_snames()) names += bold("-" + name) + ", ";
    for (const std::string& name : option.get_lnames()) names += bold("--" + name) + ", ";
    names.resize(names.size() - 2);
    page += names + (value.empty() ? "" : " " + italic(value)) + "\n";
  }
  page += escaped(as_sentence(option.get_description())) + "\n";
  if (!option.get_default_str().empty()) {
    page += "The default is " + escaped(option.get_default_str()) + ".\n";
  }
}

std::vector<const CLI::Option*> options_of(const CLI::App& app, bool positional) {
  std::vector<const CLI::Option*> chosen;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional() == positional) chosen.push_back(option);
  }
  return chosen;
}

void append_options(std::string& page, const CLI::App& app, bool positional,
                    const std::string& heading) {
  const auto options = options_of(app, positional);
  if (options.empty()) return;
  page += ".SH " + heading + "\n";
  for (const CLI::Option* option : options) append_option(page, *option);
}

std::string synopsis(const CLI::App& app, const std::string& name) {
  std::string text = ".B " + escaped(name) + "\n[" + italic("OPTION") + "]...";
  for (const CLI::Option* option : options_of(app, true)) {
    const std::string value = option->get_type_name();
    std::string shown = italic(value.empty() ? option->get_name() : value);
    if (option->get_items_expected_max() > 1) shown += "...";
    text += option->get_required() ? " " + shown : " [" + shown + "]";
  }
  if (!app.get_subcommands([](const CLI::App*) { return true; }).empty()) {
    text += " " + italic("VERB") + " ...";
  }
  return text + "\n";
}

void append_verbs(std::string& page, const CLI::App& app) {
  const auto verbs = app.get_subcommands([](const CLI::App*) { return true; });
  if (verbs.empty()) return;
  page += ".SH VERBS\n";
  for (const CLI::App* verb : verbs) {
    page += ".TP\n" + bold(verb->get_name()) + "\n";
    page += escaped(as_sentence(verb->get_description())) + " See " +
            bold("triglyph-" + verb->get_name()) + "(1).\n";
  }
}

}  // namespace

std::string man_page(const CLI::App& app, const std::string& name, const std::string& version) {
  const std::string title = with_dashes(name);
  std::string page = ".TH " + upper_case(escaped(title)) + " 1 \"\" \"" + escaped(version) +
                     "\" \"User Commands\"\n";
  page +=
      ".SH NAME\n" + escaped(title) + " \\- " + escaped(as_phrase(app.get_description())) + "\n";
  page += ".SH SYNOPSIS\n" + synopsis(app, name);
  page += ".SH DESCRIPTION\n" + escaped(as_sentence(app.get_description())) + "\n";
  append_verbs(page, app);
  append_options(page, app, true, "ARGUMENTS");
  append_options(page, app, false, "OPTIONS");
  if (!app.get_footer().empty()) {
    page += ".SH EXAMPLES\n.nf\n" + escaped(app.get_footer()) + "\n.fi\n";
  }
  page += ".SH \"EXIT STATUS\"\n";
  for (const ExitCode& exit : kExitCodes) {
    page += ".TP\n" + bold(std::to_string(exit.code)) + "\n" + escaped(std::string(exit.meaning)) +
            "\n";
  }
  page += ".SH \"SEE ALSO\"\n" +
          (name == "triglyph" ? bold("triglyph-mark") + "(1), " + bold("triglyph-extract") + "(1)"
                              : bold("triglyph") + "(1)") +
          "\n";
  return page;
}

}  // namespace triglyph
