// A whole collection: a oneTBB flow graph over the jobs, bounded by memory, with records in order.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "manifests/manifest.h"
#include "manifests/record.h"

namespace triglyph {

struct RunOptions {
  std::uint64_t memory_bytes = std::uint64_t{4}
                               << 30;  // of meshes being worked on; a larger one goes alone
  int threads = 0;                     // 0: all that the machine offers
};

// Marks every job. `on_record` is called in job order, one call at a time. When `stop` becomes true
// no further job is started, meshes in work end as Interrupted unless they are already being
// written out, and no half-written file is left. Never throws for what a mesh holds; Error
// Malformed if the manifest breaks off.
void run_jobs(JobSource& jobs, const Key& key, const RunOptions& options,
              const std::function<void(const Record&)>& on_record, const std::atomic<bool>& stop);

}  // namespace triglyph
