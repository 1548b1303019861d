// Arguments that several verbs share, and the values that they are validated to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/base/options.h"
#include "engine/message/key.h"

namespace triglyph {

// Converts names to the type that the parser takes.
[[nodiscard]] std::vector<std::string> strings(std::span<const std::string_view> names);

// Adds one option per declaration to the verb. The values that the user gives are collected in
// `values`. Declarations and values must outlive the verb. A value out of range ends the parse with
// Error Usage.
void add_declared_options(CLI::App& verb, const std::vector<OptionSpec>& specs,
                          OptionValues& values);

// The option --key-file. Without it the public trial key is used, and a warning is printed.
class KeyArgument {
 public:
  void add_to(CLI::App& verb);
  [[nodiscard]] Key load() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }  // empty: trial key

 private:
  std::filesystem::path file_;
};

// The option --key-file, which may be given several times.
class KeysArgument {
 public:
  void add_to(CLI::App& verb);
  [[nodiscard]] std::vector<Key> load() const;  // at least one

 private:
  std::vector<std::filesystem::path> files_;
};

// Returns a formatter of help that breaks long descriptions into lines of about 100 characters.
[[nodiscard]] std::shared_ptr<CLI::Formatter> make_help_formatter();

// The options --threads and --memory.
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
