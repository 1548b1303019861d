// The state of a run as OpenMetrics, the text format of Prometheus.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/progress.h"
#include "cli/run_arguments.h"

namespace triglyph {

struct RunMetrics {
  Progress progress;
  std::vector<std::uint64_t> results;  // number of files of each of RunName::kinds
  std::uint64_t workers = 0;           // processes that were started so far
  std::uint64_t resident_bytes = 0;    // of the worker; 0: there is none
  std::optional<int> exit_code;        // nothing: the run goes on
};

// Returns the whole file, from the first "# TYPE" to "# EOF". Every metric bears the verb as label.
[[nodiscard]] std::string metrics_text(const RunName& name, const RunMetrics& metrics);

}  // namespace triglyph
