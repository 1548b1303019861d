// Arguments that several verbs share, and what they become once they are known to make sense.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/base/options.h"
#include "engine/message/key.h"

namespace triglyph {

// Names to choose from, as the parser wants them.
[[nodiscard]] std::vector<std::string> strings(std::span<const std::string_view> names);

// Adds an option for every declaration to the verb; what the user gives is collected in `values`,
// which must outlive the verb. A value out of range ends the parse with Error Usage.
void add_declared_options(CLI::App& verb, const std::vector<OptionSpec>& specs,
                          OptionValues& values);

// --key-file. Without it the public trial key is used and a warning printed.
class KeyArgument {
 public:
  void add_to(CLI::App& verb);
  [[nodiscard]] Key load() const;

 private:
  std::filesystem::path file_;
};

// --key-file, any number of times.
class KeysArgument {
 public:
  void add_to(CLI::App& verb);
  [[nodiscard]] std::vector<Key> load() const;  // at least one

 private:
  std::vector<std::filesystem::path> files_;
};

// --threads and --memory.
class MachineArguments {
 public:
  void add_threads_to(CLI::App& verb);
  void add_memory_to(CLI::App& verb);
  [[nodiscard]] int threads() const { return threads_; }
  [[nodiscard]] std::uint64_t memory_bytes() const { return memory_; }

 private:
  int threads_ = 0;
  std::uint64_t memory_ = std::uint64_t{4} << 30;
};

}  // namespace triglyph
