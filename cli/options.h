// Arguments that several verbs share, and what they become once they are known to make sense.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "manifests/job.h"

namespace triglyph {

// Names to choose from, as the parser wants them.
[[nodiscard]] std::vector<std::string> strings(std::span<const std::string_view> names);

// --key-file. Without it the public trial key is used and a warning printed.
class KeyArgument {
 public:
  void add_to(CLI::App& verb);
  [[nodiscard]] Key load() const;

 private:
  std::filesystem::path file_;
};

// Scheme and word format: what extraction must know beside the key.
class SchemeArguments {
 public:
  void add_to(CLI::App& verb);
  void apply_to(JobSettings& settings) const;

 private:
  std::string scheme_ = "tsq";
  std::optional<int> marker_bits_;
  std::optional<int> subscript_bits_;
  std::optional<int> part_bits_;
  std::optional<double> step_;
  std::optional<double> radius_edges_;
  std::optional<double> radius_;
  std::optional<int> site_rings_;
  std::string groups_{name_of(AieGroups::One)};
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
