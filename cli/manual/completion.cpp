#include "cli/manual/completion.h"

#include <algorithm>

namespace triglyph {
namespace {

// Everything that does not depend on the declared arguments. What the words before the cursor mean
// is decided by _triglyph_arguments, which sets options, and choices or kind of the value asked
// for.
constexpr const char* kCompletion = R"(
_triglyph() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  # bash makes "=" a word of its own
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  local verb='' word options='' choices='' kind=''
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ " $_triglyph_verbs " == *" $word "* ]]; then
      verb=$word
      break
    fi
  done
  _triglyph_arguments "$verb" "$previous"
  COMPREPLY=()
  if [[ -n $choices ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
  elif [[ $kind == directory ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$current")
  elif [[ $kind == value ]]; then
    return
  elif [[ $kind != file && $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [[ -z $verb && -z $kind ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$_triglyph_verbs" -- "$current")
  else
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}
complete -F _triglyph triglyph
)";

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

// The names in "TEXT:{a,b}" or "a|b", separated by spaces; empty if the value is no choice.
std::string choices_of(const std::string& type) {
  const auto open = type.find('{');
  std::string list;
  if (open != type.npos) {
    list = type.substr(open + 1, type.find('}') - open - 1);
    std::replace(list.begin(), list.end(), ',', ' ');
  } else if (type.find('|') != type.npos) {
    list = type;
    std::replace(list.begin(), list.end(), '|', ' ');
  }
  return list;
}

// What the value after an option is completed with, as an assignment of the script.
std::string completion_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::string choices = choices_of(type);
  if (!choices.empty()) return "choices='" + choices + "'";
  if (type == "DIR") return "kind=directory";
  if (type.find("FILE") != type.npos || type.find("MESH") != type.npos ||
      type.find("RECORDS") != type.npos) {
    return "kind=file";
  }
  return "kind=value";
}

// One branch of the script: the options of a verb, and what stands behind each.
std::string branch(const std::string& verb, const CLI::App& app) {
  std::string names;
  std::string values;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) continue;
    for (const std::string& name : option->get_lnames()) {
      names += (names.empty() ? "--" : " --") + name;
      if (option->get_items_expected_max() == 0) continue;
      values += "        --" + name + ") " + completion_of(*option) + " ;;\n";
    }
  }
  return "    '" + verb + "')\n      options='" + names + "'\n      case $2 in\n" + values +
         "      esac\n      ;;\n";
}

}  // namespace

std::string bash_completion(const CLI::App& app,
                            const std::map<std::string, const CLI::App*>& others) {
  std::string verbs;
  std::string branches = branch("", app);
  for (const CLI::App* verb : verbs_of(app)) {
    verbs += (verbs.empty() ? "" : " ") + verb->get_name();
    const auto other = others.find(verb->get_name());
    branches += branch(verb->get_name(), other == others.end() ? *verb : *other->second);
  }
  return "# bash completion of triglyph; made while building\n_triglyph_verbs='" + verbs +
         "'\n\n_triglyph_arguments() {\n  case $1 in\n" + branches + "  esac\n}\n" + kCompletion;
}

}  // namespace triglyph
