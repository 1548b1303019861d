// The attacks that a command names.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/options.h"
#include "engine/attack/attack.h"

namespace triglyph {

// The options --attack, --protocol and --seed.
class AttackArguments {
 public:
  void add_to(CLI::App& verb);

  [[nodiscard]] bool names_any() const { return !names_.empty() || !protocol_.empty(); }
  // Returns the attacks named, each once: those of the protocol, then the others. Throws Error
  // Usage as Attack::parsed() does.
  [[nodiscard]] std::vector<Attack> attacks() const;
  // Returns the attacks of --attack as one that does them in the order given; "none" without any.
  // Throws Error Usage as Attack::parsed() does, and for a protocol, whose attacks have no order.
  [[nodiscard]] Attack in_a_row() const;
  [[nodiscard]] std::uint64_t seed() const { return seed_; }

 private:
  std::vector<std::string> names_;
  std::string protocol_;
  std::uint64_t seed_ = 1;
};

// Returns the kinds of collusions, a line each, for help.
[[nodiscard]] std::string list_of_collusions();

// Returns the kinds of attacks with their numbers, a line each, for help.
[[nodiscard]] std::string list_of_attacks();

}  // namespace triglyph
