// Smooth displacement of a surface: the scalar fields that bend like a thin plate on an elastic
// bed, and the one of least energy under linear constraints.
//
// This work is based on
// Botsch, Sorkine. On linear variational surface deformation methods. IEEE TVCG 14 (2008), for the
// discretisation, and
// Vanek, Mandel, Brezina. Algebraic multigrid by smoothed aggregation. Computing 56 (1996), for
// the subspace of large meshes.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// A dense matrix, column by column.
struct Columns {
  std::size_t rows = 0;
  std::size_t count = 0;
  std::vector<double> values;

  Columns(std::size_t rows_, std::size_t count_)
      : rows(rows_), count(count_), values(rows_ * count_, 0) {}
  [[nodiscard]] std::span<double> column(std::size_t i) { return {values.data() + i * rows, rows}; }
  [[nodiscard]] std::span<const double> column(std::size_t i) const {
    return {values.data() + i * rows, rows};
  }
};

// The energy E = K M^-1 K with K = L + M / length^2: L the cotangent Laplacian, M the area of each
// point. Meshes of more than some tens of thousands of points are represented by a smooth subspace.
class ThinPlate {
 public:
  // `length`, in model units, is the one below which fields are smooth. Factorises K: about
  // O(unknowns^1.5), one thread.
  ThinPlate(const Mesh& mesh, double length);
  ~ThinPlate();
  ThinPlate(const ThinPlate&) = delete;
  ThinPlate& operator=(const ThinPlate&) = delete;

  // Returns the number of degrees of freedom.
  [[nodiscard]] std::size_t unknowns() const;
  // Returns the area of each point, squared model units; degenerate ones have a little.
  [[nodiscard]] std::span<const double> areas() const;

  // A linear functional of fields, one coefficient a point, is given by calling
  // row(point, add) for each point, which calls add(functional, coefficient).
  using Row =
      std::function<void(std::size_t point, const std::function<void(std::size_t, double)>& add)>;
  // Returns the functionals in terms of the unknowns, a column each. O(coefficients).
  [[nodiscard]] Columns restricted(std::size_t functionals, const Row& row) const;
  // Returns a non-negative weight of the points as one of the unknowns, for sums of squares.
  [[nodiscard]] std::vector<double> restricted_weight(std::span<const double> weights) const;

  // Returns E^-1 times the columns. O(columns * fill), parallel over columns.
  [[nodiscard]] Columns solved(const Columns& columns) const;

  // Returns the field, one value a point.
  [[nodiscard]] std::vector<double> field(std::span<const double> unknowns) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace triglyph
