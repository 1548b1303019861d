// Marking of a collection: many meshes in parallel, within a memory budget, and nothing twice.
#pragma once

#include <atomic>
#include <functional>

#include "manifests/manifest.h"
#include "manifests/record.h"
#include "manifests/resume.h"
#include "manifests/run_context.h"

namespace triglyph {

// What a run tells as it goes, one call at a time.
struct RunEvents {
  // A job is done: its output is there, or will never be. In the order in which jobs are done. A
  // worker that takes over from another calls it again for what that one did.
  std::function<void(const Record&)> completed = {};
  // The same in the order of the jobs.
  std::function<void(const Record&)> delivered = {};
};

// Marks every job that is not done already; see Resume. When `stop` becomes true, no further job is
// started, meshes in process end as Interrupted unless their output is being published, and no
// incomplete file is left. An error of a mesh goes into its record, as does what killed an earlier
// worker. Throws Error Malformed if a line of the manifest is invalid.
void run_jobs(JobSource& jobs, const Key& key, const RunContext& context, const RunEvents& events,
              const std::atomic<bool>& stop);

// Says what run_jobs() would do with every job, in their order, and does nothing. Throws as it
// does.
void plan_jobs(JobSource& jobs, const Resume& resume,
               const std::function<void(const Job&, const Decision&)>& on_decision,
               const std::atomic<bool>& stop);

}  // namespace triglyph
