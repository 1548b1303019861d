// What surrounds a run, whatever its verb.
#pragma once

#include "manifests/flow.h"
#include "manifests/supervisor.h"

namespace triglyph {

class Resume;

struct RunContext {
  FlowOptions flow = {};
  const Resume* resume = nullptr;    // of marking; null: everything is done, and nothing remembered
  const WorkOrder* order = nullptr;  // null: the run is not supervised
  bool copies_companions = false;    // of marking; see copy_companions()
  bool keeps_shapes = true;  // of marking: the ledger keeps what FileMarking::kept_shape() gives
  bool keeps_times = false;  // of marking: outputs get the modification time of their mesh
};

}  // namespace triglyph
