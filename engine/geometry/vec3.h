// Points and directions in double precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace triglyph {

struct Vec3 {
  constexpr Vec3() = default;
  constexpr Vec3(double x, double y, double z) : values{x, y, z} {}

  [[nodiscard]] constexpr const double& operator[](std::size_t axis) const { return values[axis]; }
  [[nodiscard]] constexpr double& operator[](std::size_t axis) { return values[axis]; }
  [[nodiscard]] const double* data() const { return values.data(); }
  [[nodiscard]] double* data() { return values.data(); }

  constexpr Vec3& operator+=(const Vec3& other) {
    for (std::size_t i = 0; i < 3; ++i) values[i] += other.values[i];
    return *this;
  }
  constexpr Vec3& operator-=(const Vec3& other) {
    for (std::size_t i = 0; i < 3; ++i) values[i] -= other.values[i];
    return *this;
  }
  constexpr Vec3& operator*=(double factor) {
    for (double& value : values) value *= factor;
    return *this;
  }
  constexpr Vec3& operator/=(double divisor) {
    for (double& value : values) value /= divisor;
    return *this;
  }

  // Replace each coordinate by the lesser, or by the greater, of the two.
  constexpr Vec3& minimize(const Vec3& other) {
    for (std::size_t i = 0; i < 3; ++i) values[i] = std::min(values[i], other.values[i]);
    return *this;
  }
  constexpr Vec3& maximize(const Vec3& other) {
    for (std::size_t i = 0; i < 3; ++i) values[i] = std::max(values[i], other.values[i]);
    return *this;
  }

  [[nodiscard]] constexpr double max() const { return std::max({values[0], values[1], values[2]}); }
  [[nodiscard]] double max_abs() const {
    return std::max({std::abs(values[0]), std::abs(values[1]), std::abs(values[2])});
  }
  // Returns the squared length.
  [[nodiscard]] constexpr double sqrnorm() const {
    return values[0] * values[0] + values[1] * values[1] + values[2] * values[2];
  }
  [[nodiscard]] double norm() const { return std::sqrt(sqrnorm()); }
  // Returns the unit vector of this direction; NaN for the zero vector.
  [[nodiscard]] Vec3 normalized() const;

  constexpr bool operator==(const Vec3&) const = default;

  std::array<double, 3> values{};
};

[[nodiscard]] constexpr Vec3 operator+(Vec3 a, const Vec3& b) {
  return a += b;
}
[[nodiscard]] constexpr Vec3 operator-(Vec3 a, const Vec3& b) {
  return a -= b;
}
[[nodiscard]] constexpr Vec3 operator-(const Vec3& a) {
  return {-a[0], -a[1], -a[2]};
}
[[nodiscard]] constexpr Vec3 operator*(Vec3 a, double factor) {
  return a *= factor;
}
[[nodiscard]] constexpr Vec3 operator*(double factor, Vec3 a) {
  return a *= factor;
}
[[nodiscard]] constexpr Vec3 operator/(Vec3 a, double divisor) {
  return a /= divisor;
}
[[nodiscard]] constexpr double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] constexpr Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Vec3 Vec3::normalized() const {
  return *this / norm();
}

}  // namespace triglyph
