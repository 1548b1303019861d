// The marking of one mesh in a run.
#pragma once

#include <cstdint>
#include <filesystem>

#include "engine/marking/options.h"

namespace triglyph {

struct Job {
  std::size_t index = 0;  // place in the run, from 0
  std::filesystem::path mesh;
  std::filesystem::path out;
  MarkRequest request;
};

}  // namespace triglyph
