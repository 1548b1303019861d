// What surrounds a run, whatever its verb.
#pragma once

#include "manifests/flow.h"
#include "manifests/shard.h"
#include "manifests/supervisor.h"

namespace triglyph {

class Resume;

struct RunContext {
  FlowOptions flow = {};
  const Resume* resume = nullptr;    // of marking; null: everything is done, and nothing remembered
  const WorkOrder* order = nullptr;  // null: the run is not supervised
  Shard shard = {};                  // of marking: the jobs are these of a larger run
  std::uint64_t jobs_of_all = 0;     // of marking in shards: the jobs of the larger run
  bool copies_companions = false;    // of marking; see copy_companions()
  bool keeps_shapes = true;  // of marking: the ledger keeps what FileMarking::kept_shape() gives
  bool keeps_times = false;  // of marking: outputs get the modification time of their mesh
};

}  // namespace triglyph
