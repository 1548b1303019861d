// Linear systems of three right sides at a time, which are the coordinates of points.
#pragma once

#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/geometry/vec3.h"

namespace triglyph {

// A diagonal preconditioner, and when to stop.
struct ConjugateGradients {
  std::span<const double> diagonal;  // not negative; where it is 0 nothing is changed
  int iterations = 0;                // at most
  double tolerance = 0;              // of the residual, in relation to the first one

  // Improves x towards the solution of A x = right for a symmetric positive definite A.
  // apply(vectors, image) fills `image` with A times the vectors. O(iterations) calls of it, the
  // rest in parallel; the same for any number of threads.
  template <typename Apply>
  void improve(std::vector<Vec3>& x, std::span<const Vec3> right, const Apply& apply) const;

 private:
  [[nodiscard]] static Vec3 times_each(const Vec3& a, const Vec3& b) {
    return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
  }
  [[nodiscard]] static Vec3 over_each(const Vec3& a, const Vec3& b) {
    Vec3 result;
    for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = b[axis] > 0 ? a[axis] / b[axis] : 0;
    return result;
  }
  // Returns the inner products of the three right sides.
  [[nodiscard]] static Vec3 dots(std::span<const Vec3> a, std::span<const Vec3> b) {
    return parallel_reduce(
        a.size(), Vec3{}, [&](std::size_t i) { return times_each(a[i], b[i]); },
        [](Vec3 sum, const Vec3& next) { return sum += next; });
  }
};

template <typename Apply>
void ConjugateGradients::improve(std::vector<Vec3>& x, std::span<const Vec3> right,
                                 const Apply& apply) const {
  const auto each = [&](const auto& body) { parallel_for(x.size(), body, kBlock); };
  const auto scaled_at = [&](const Vec3& v, std::size_t i) {
    return diagonal[i] > 0 ? v / diagonal[i] : Vec3();
  };
  std::vector<Vec3> rest(x.size());
  std::vector<Vec3> scaled(x.size());
  std::vector<Vec3> image(x.size());
  apply(x, image);
  each([&](std::size_t i) {
    rest[i] = right[i] - image[i];
    scaled[i] = scaled_at(rest[i], i);
  });
  std::vector<Vec3> direction = scaled;
  Vec3 size = dots(rest, scaled);
  const double enough = tolerance * tolerance * size.max();
  for (int iteration = 0; iteration < iterations && size.max() > enough; ++iteration) {
    apply(direction, image);
    const Vec3 length = over_each(size, dots(direction, image));
    each([&](std::size_t i) {
      x[i] += times_each(length, direction[i]);
      rest[i] -= times_each(length, image[i]);
      scaled[i] = scaled_at(rest[i], i);
    });
    const Vec3 next = dots(rest, scaled);
    const Vec3 turn = over_each(next, size);
    each([&](std::size_t i) { direction[i] = scaled[i] + times_each(turn, direction[i]); });
    size = next;
  }
}

}  // namespace triglyph
