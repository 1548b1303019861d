// What `triglyph profile` prints of its runs.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "manifests/trace_summary.h"

namespace triglyph {

struct ProfileWorkload {
  std::size_t meshes = 0;
  std::uint64_t triangles = 0;  // of all meshes together
  std::uint64_t bytes = 0;      // likewise
};

// One run over the whole workload.
struct ProfileRun {
  int threads = 1;
  double wall_seconds = 0;
  double processor_seconds = 0;              // user and system
  std::map<std::string, StageTotal> stages;  // as summarise_trace() returns them
};

// Print the median of all runs with each number of threads: times, rates, parallel efficiency, and
// where the threads' time went.
void print_profile(std::ostream& out, const ProfileWorkload& workload,
                   const std::vector<ProfileRun>& runs);

// Returns every run as Google Benchmark's JSON does, so that its tools read it: benchmarks
// "mark/threads:2" and, of each stage, "mark/threads:2/stage:load", whose times are those of all
// threads together. The processor time of a stage is not known; its wall time stands for it.
[[nodiscard]] nlohmann::ordered_json profile_json(const ProfileWorkload& workload,
                                                  const std::vector<ProfileRun>& runs);

}  // namespace triglyph
