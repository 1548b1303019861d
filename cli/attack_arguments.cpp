#include "cli/attack_arguments.h"

#include <algorithm>

#include "engine/attack/collusion.h"
#include "engine/base/error.h"

namespace triglyph {

void AttackArguments::add_to(CLI::App& verb) {
  verb.add_option("--attack", names_,
                  "Attack, such as noise:0.3 or simplify:50+noise:0.1; may be given several times")
      ->type_name("ATTACK")
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
  verb.add_option("--protocol", protocol_, "All attacks of a protocol; see docs/attacks.md")
      ->check(CLI::IsMember(strings(protocol_names())).description(""))
      ->type_name(CLI::detail::join(protocol_names(), "|"));
  verb.add_option("--seed", seed_,
                  "Seed of the lots that attacks draw; the same seed gives the same meshes "
                  "(default: 1)")
      ->type_name("N");
}

std::vector<Attack> AttackArguments::attacks() const {
  std::vector<Attack> attacks;
  if (!protocol_.empty()) attacks = protocol(protocol_);
  for (const std::string& name : names_) {
    Attack attack = Attack::parsed(name);
    const bool is_known = std::any_of(attacks.begin(), attacks.end(), [&](const Attack& other) {
      return other.text() == attack.text();
    });
    if (!is_known) attacks.push_back(std::move(attack));
  }
  return attacks;
}

Attack AttackArguments::in_a_row() const {
  if (!protocol_.empty()) {
    throw Error(ErrorCode::Usage, {}, "",
                "the attacks of a protocol are alternatives; give those to be done one after the "
                "other by --attack");
  }
  if (names_.empty()) return Attack::parsed("none");
  return Attack::parsed(CLI::detail::join(names_, "+"));
}

std::string list_of_collusions() {
  std::string text;
  for (const CollusionKind& kind : collusion_kinds()) {
    std::string name(kind.name);
    name.resize(14, ' ');
    text += "  " + name + std::string(kind.help) + "\n";
  }
  return text;
}

std::string list_of_attacks() {
  std::string text;
  for (const AttackKind& kind : attack_kinds()) {
    std::string name(kind.name);
    if (kind.parameter) name += kind.parameter->usual ? "[:N]" : ":N";
    name.resize(std::max<std::size_t>(14, name.size() + 1), ' ');
    text += "  " + name + std::string(kind.help);
    if (kind.parameter) text += "; N: " + std::string(kind.parameter->meaning);
    text += "\n";
  }
  return text;
}

}  // namespace triglyph
