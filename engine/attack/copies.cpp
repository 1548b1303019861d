#include "engine/attack/copies.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/error.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kNoPartner = 0xffffffff;

// Pairs the points of the first file with those of another, one to one.
class Partners {
 public:
  explicit Partners(std::size_t points) : of_(points, kNoPartner), back_(points, kNoPartner) {}

  // Returns whether the two are partners now: not if either has another one.
  bool join(std::uint32_t first, std::uint32_t other) {
    if (of_[first] == kNoPartner && back_[other] == kNoPartner) {
      of_[first] = other;
      back_[other] = first;
    }
    return of_[first] == other;
  }

  [[nodiscard]] bool is_complete() const {
    return std::find(of_.begin(), of_.end(), kNoPartner) == of_.end();
  }
  [[nodiscard]] std::span<const std::uint32_t> of() const { return of_; }

 private:
  std::vector<std::uint32_t> of_;    // the other file's point of each of the first
  std::vector<std::uint32_t> back_;  // and the first file's of each of the other
};

// Says whether both files have the same triangles. How polygons are cut depends on where points
// lie, so the other file's are cut where those of the first lie.
bool have_same_triangles(const MeshFile& first, const MeshFile& other, const Partners& partners) {
  const auto of = partners.of();
  std::vector<Vec3> positions(of.size());
  for (std::size_t p = 0; p < of.size(); ++p) positions[of[p]] = first.mesh().positions[p];
  const std::vector<Triangle>& triangles = first.mesh().triangles;
  const std::vector<Triangle> others = other.triangles_at(positions);
  return std::equal(triangles.begin(), triangles.end(), others.begin(), others.end(),
                    [&](const Triangle& a, const Triangle& b) {
                      return Triangle{of[a[0]], of[a[1]], of[a[2]]} == b;
                    });
}

std::optional<Partners> partners_by_vertices(const MeshFile& first, const MeshFile& other) {
  if (first.vertex_count() != other.vertex_count()) return std::nullopt;
  Partners partners(first.mesh().positions.size());
  for (std::size_t v = 0; v < first.vertex_count(); ++v) {
    if (!partners.join(first.point_of_vertex()[v], other.point_of_vertex()[v])) return std::nullopt;
  }
  if (!partners.is_complete() || !have_same_triangles(first, other, partners)) return std::nullopt;
  return partners;
}

// As an Error says it: "has 812 points, a.obj 810".
std::string counts(std::size_t own, std::string_view what, const fs::path& first,
                   std::size_t wanted) {
  return "has " + std::to_string(own) + " " + std::string(what) + ", " + first.string() + " " +
         std::to_string(wanted);
}

Partners partners_by_corners(const MeshFile& first, const fs::path& first_path,
                             const MeshFile& other, const fs::path& path) {
  const std::vector<Triangle>& triangles = first.mesh().triangles;
  const std::vector<Triangle>& others = other.mesh().triangles;
  if (triangles.size() != others.size()) {
    throw Error(ErrorCode::Usage, path, "",
                counts(others.size(), "triangles", first_path, triangles.size()));
  }
  Partners partners(first.mesh().positions.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (partners.join(triangles[t][corner], others[t][corner])) continue;
      throw Error(ErrorCode::Usage, path, "",
                  "differs from " + first_path.string() + " at triangle " + std::to_string(t + 1) +
                      "; copies have the same faces in the same order");
    }
  }
  if (partners.is_complete()) return partners;
  throw Error(ErrorCode::Usage, path, "",
              "lists its vertices otherwise than " + first_path.string() +
                  ", and points in no triangle cannot be matched then");
}

Mesh matched_copy(const MeshFile& first, const fs::path& first_path, const fs::path& path) {
  const MeshFile other = MeshFile::open(path);
  const std::vector<Vec3>& points = other.mesh().positions;
  const std::size_t wanted = first.mesh().positions.size();
  if (points.size() != wanted) {
    throw Error(ErrorCode::Usage, path, "", counts(points.size(), "points", first_path, wanted));
  }
  std::optional<Partners> partners = partners_by_vertices(first, other);
  if (!partners) partners = partners_by_corners(first, first_path, other, path);
  Mesh copy{std::vector<Vec3>(wanted), first.mesh().triangles};
  for (std::size_t p = 0; p < wanted; ++p) copy.positions[p] = points[partners->of()[p]];
  return copy;
}

}  // namespace

Copies read_copies(std::span<const fs::path> paths) {
  Copies copies;
  if (paths.empty()) return copies;
  const MeshFile first = MeshFile::open(paths.front());
  copies.format = first.format();
  copies.meshes.push_back(first.mesh());
  for (const fs::path& path : paths.subspan(1)) {
    copies.meshes.push_back(matched_copy(first, paths.front(), path));
  }
  return copies;
}

}  // namespace triglyph
