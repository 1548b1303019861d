#include "engine/scheme/tsq/triangle_shape.h"

#include <complex>

namespace triglyph {

FlatCorners reshape(const FlatTriangle& triangle, double x, double height) {
  using Complex = std::complex<double>;
  const std::array<Complex, 3> target{Complex(0, 0), Complex(1, 0), Complex(x, height)};
  const std::array<Complex, 3> corners{
      Complex(0, 0), Complex(triangle.base, 0),
      Complex(triangle.base * triangle.x, triangle.base * triangle.height)};
  const Complex target_mean = (target[0] + target[1] + target[2]) / 3.0;
  const Complex mean = (corners[0] + corners[1] + corners[2]) / 3.0;
  Complex product = 0;
  double norm = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    product += std::conj(target[i] - target_mean) * (corners[i] - mean);
    norm += std::norm(target[i] - target_mean);
  }
  const Complex turn_and_scale = product / norm;
  FlatCorners moved;
  for (std::size_t i = 0; i < 3; ++i) {
    const Complex corner = mean + turn_and_scale * (target[i] - target_mean);
    moved.x[i] = corner.real();
    moved.y[i] = corner.imag();
  }
  return moved;
}

}  // namespace triglyph
