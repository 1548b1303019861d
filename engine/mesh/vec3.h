// Points and directions in double precision: OpenMesh's vector, under the engine's name.
#pragma once

#include <OpenMesh/Core/Geometry/VectorT.hh>

namespace triglyph {

using Vec3 = OpenMesh::Vec3d;

[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) {
  return a | b;
}
[[nodiscard]] inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return a % b;
}

}  // namespace triglyph
