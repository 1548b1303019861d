// The marking of one mesh in a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "engine/marking/mesh_of_copies.h"
#include "engine/marking/options.h"
#include "manifests/recipients.h"

namespace triglyph {

struct Job {
  std::size_t index = 0;  // place in what this process does, from 0
  std::filesystem::path mesh;
  std::filesystem::path out;
  MarkRequest request;
  std::shared_ptr<const Recipients> recipients = {};  // null: the job is not for several
  std::shared_ptr<const MeshOfCopies> copies = {};    // of jobs that are copies of one mesh
  std::size_t place = 0;  // in the whole run, of which this process may do a shard, from 0
};

}  // namespace triglyph
