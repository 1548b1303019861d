// What a measurement of survival found, as a table for the eye, as JSON and as CSV.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "engine/survival/survival.h"

namespace triglyph {

// One mesh, or all of them together, under every scheme.
struct SurvivalBlock {
  std::filesystem::path mesh;  // empty: all of them
  std::size_t points = 0;
  std::size_t triangles = 0;
  std::vector<std::string> schemes;
  std::vector<SchemeSurvival> results;  // by scheme
};

// Prints one table: a row for each attack and each measure of distortion, columns for the schemes.
void print_survival(std::ostream& out, const SurvivalBlock& block);

// Returns one line of JSON for each scheme.
[[nodiscard]] std::string survival_json(const SurvivalBlock& block);

// Returns the heading of the rows, and one row for each scheme and attack.
[[nodiscard]] std::string survival_csv_heading();
[[nodiscard]] std::string survival_csv(const SurvivalBlock& block);

}  // namespace triglyph
