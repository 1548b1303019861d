// What is to be done to one mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "engine/marking/mark.h"

namespace triglyph {

// What the user asked for. Word format and cell width belong to the scheme and to what is marked,
// so they are settled last, by resolved().
struct JobSettings {
  Message message;    // 1 to 256 bytes; not used by fill
  bool fill = false;  // the paper's experiment: a random message as long as the capacity
  std::string scheme = "tsq";
  std::optional<int> marker_bits;
  std::optional<int> subscript_bits;  // fill: as many; else as few as tell the units apart
  std::optional<int> part_bits;
  std::optional<double> step;
  AieGroups groups = AieGroups::One;
  std::optional<double> radius_edges;
  std::optional<double> radius;
  std::optional<int> site_rings;
  ConflictRule conflict_rule = MarkOptions{}.conflict_rule;
  CostFunction cost = CostFunction::Displacement;
  std::optional<LayoutMethod> layout;
  LayoutOptions layout_search;  // how long, should the layout search
  AssignMethod assign = MarkOptions{}.assign;
  std::uint32_t redundancy = MarkOptions{}.redundancy;
  std::optional<double> max_move_rel_diag;
  double drop_dearest = 0;
  bool detail = false;  // write down every unit, so that verify can say which are damaged

  // With iie, whose use that is, always.
  [[nodiscard]] bool wants_detail() const { return detail || scheme == "iie"; }

  // Throws Error Usage for an unknown scheme.
  [[nodiscard]] MarkOptions resolved() const;
};

struct Job {
  std::size_t index = 0;  // place in the run, from 0
  std::filesystem::path mesh;
  std::filesystem::path out;
  JobSettings settings;
};

}  // namespace triglyph
