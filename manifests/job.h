// What is to be done to one mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "engine/mark.h"

namespace triglyph {

struct JobSettings {
  Message message;             // 1 to 256 bytes; not used by fill
  bool fill = false;           // the paper's experiment: a random message as long as the capacity
  std::optional<double> step;  // cell width; nothing: the default of a message or of fill
  MarkOptions options;

  // The options with the cell width that applies.
  [[nodiscard]] MarkOptions resolved() const {
    MarkOptions result = options;
    if (step || fill) result.scheme_options.step = step.value_or(kFillStep);
    return result;
  }
};

struct Job {
  std::size_t index = 0;  // place in the run, from 0
  std::filesystem::path mesh;
  std::filesystem::path out;
  JobSettings settings;
};

}  // namespace triglyph
