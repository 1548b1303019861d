// Scalars of binary files, in either byte order.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/io/readers.h"

namespace triglyph {
namespace {

static_assert(std::endian::native == std::endian::little);

template <typename T>
double load_as(const char* bytes, bool is_big_endian) noexcept {
  char raw[sizeof(T)];
  std::memcpy(raw, bytes, sizeof(T));
  if (is_big_endian) std::reverse(raw, raw + sizeof(T));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return static_cast<double>(value);
}

template <typename T>
T convert(double value) noexcept {
  if constexpr (std::is_floating_point_v<T>) {
    constexpr double kLargest = std::numeric_limits<T>::max();
    // Between the largest float and the next power of two, rounding could still reach infinity.
    return static_cast<T>(std::clamp(value, -kLargest, kLargest)) + T{0};  // -0 + 0 = 0
  } else {
    constexpr double kLow = std::numeric_limits<T>::min(), kHigh = std::numeric_limits<T>::max();
    return static_cast<T>(std::clamp(std::nearbyint(value), kLow, kHigh));
  }
}

template <typename T>
void store_as(double value, bool is_big_endian, char* bytes) noexcept {
  const T converted = convert<T>(value);
  std::memcpy(bytes, &converted, sizeof(T));
  if (is_big_endian) std::reverse(bytes, bytes + sizeof(T));
}

// Calls visit() with a value of the C++ type of the scalar.
template <typename Visit>
auto with_type(Scalar scalar, const Visit& visit) noexcept {
  switch (scalar) {
    case Scalar::Int8:
      return visit(std::int8_t{});
    case Scalar::UInt8:
      return visit(std::uint8_t{});
    case Scalar::Int16:
      return visit(std::int16_t{});
    case Scalar::UInt16:
      return visit(std::uint16_t{});
    case Scalar::Int32:
      return visit(std::int32_t{});
    case Scalar::UInt32:
      return visit(std::uint32_t{});
    case Scalar::Float32:
      return visit(float{});
    case Scalar::Float64:
      break;
  }
  return visit(double{});
}

}  // namespace

std::size_t size_of(Scalar scalar) noexcept {
  return with_type(scalar, [](auto type) { return sizeof(type); });
}

bool is_integer(Scalar scalar) noexcept {
  return scalar != Scalar::Float32 && scalar != Scalar::Float64;
}

double load(const char* bytes, Scalar scalar, bool is_big_endian) noexcept {
  return with_type(scalar,
                   [&](auto type) { return load_as<decltype(type)>(bytes, is_big_endian); });
}

void store(double value, Scalar scalar, bool is_big_endian, char* bytes) noexcept {
  with_type(scalar, [&](auto type) { store_as<decltype(type)>(value, is_big_endian, bytes); });
}

double round_to(Scalar scalar, double value) noexcept {
  return with_type(scalar,
                   [&](auto type) { return static_cast<double>(convert<decltype(type)>(value)); });
}

double step_at(Scalar scalar, double value) noexcept {
  return with_type(scalar, [&](auto type) -> double {
    using T = decltype(type);
    if constexpr (std::is_floating_point_v<T>) {
      const T magnitude = std::min(std::abs(convert<T>(value)), std::numeric_limits<T>::max() / 2);
      return static_cast<double>(std::nextafter(magnitude, std::numeric_limits<T>::max())) -
             static_cast<double>(magnitude);
    } else {
      return 1;
    }
  });
}

}  // namespace triglyph
