#include "engine/geometry/spatial_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/box.h"
#include "engine/geometry/embree_device.h"

namespace triglyph {
namespace {

// Padding of radii in Embree's units. Coordinates passed to Embree lie in [-1, 1]; rounding to
// float moves a corner by less than 2^-24 per axis, and Embree's arithmetic adds a few times that.
constexpr double kFloatPad = 4e-7;

float float_above(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

}  // namespace

struct SpatialIndex::Scene {
  std::span<const Vec3> positions;
  std::span<const Triangle> triangles;
  Vec3 centre{0, 0, 0};
  double scale = 1;  // Embree units per model unit
  RTCScene handle = nullptr;

  ~Scene() {
    if (handle != nullptr) rtcReleaseScene(handle);
  }

  struct Query {
    const Scene* scene;
    Vec3 point;
    ClosestPoint best;
    double best_squared;
  };

  [[nodiscard]] Vec3 closest_on(const Vec3& query, std::uint32_t index) const {
    const Triangle& triangle = triangles[index];
    return closest_on_triangle(query, positions[triangle[0]], positions[triangle[1]],
                               positions[triangle[2]]);
  }

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const Scene& scene = *query.scene;
    const Vec3 point = scene.closest_on(query.point, arguments->primID);
    const double squared = (point - query.point).sqrnorm();
    const bool nearer = squared < query.best_squared ||
                        (squared == query.best_squared && arguments->primID < query.best.triangle);
    if (!nearer) return false;
    query.best_squared = squared;
    query.best.triangle = arguments->primID;
    query.best.point = point;
    const float radius = float_above(std::sqrt(squared) * scene.scale + kFloatPad);
    if (!(radius < arguments->query->radius)) return false;
    arguments->query->radius = radius;
    return true;
  }

  struct BallQuery {
    const Scene* scene;
    Vec3 centre;
    double squared_radius;
    std::size_t most;
    std::vector<std::uint32_t> found;
  };

  static bool collect(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<BallQuery*>(arguments->userPtr);
    const Scene& scene = *query.scene;
    const Vec3 point = scene.closest_on(query.centre, arguments->primID);
    if ((point - query.centre).sqrnorm() <= query.squared_radius) {
      query.found.push_back(arguments->primID);
    }
    if (query.found.size() <= query.most) return false;
    arguments->query->radius = 0;  // ends the query
    return true;
  }

  // Returns the query in Embree's units, with the radius padded against rounding.
  [[nodiscard]] RTCPointQuery point_query(const Vec3& point, double reach) const {
    const Vec3 local = (point - centre) * scale;
    RTCPointQuery query{};
    query.x = static_cast<float>(local[0]);
    query.y = static_cast<float>(local[1]);
    query.z = static_cast<float>(local[2]);
    // the rounding of the query point grows with its distance from the box
    const double pad = kFloatPad * std::max(1.0, local.max_abs());
    query.radius = std::isfinite(reach) ? float_above(reach * scale * (1 + 1e-6) + pad)
                                        : std::numeric_limits<float>::infinity();
    return query;
  }

  void attach_triangles() {
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    // every triangle has its own corners, so an index of few triangles of a large mesh stays small
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               3 * triangles.size()));
    auto* corners = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), triangles.size()));
    if (points == nullptr || corners == nullptr) throw std::bad_alloc();
    for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
      const Vec3 point = (positions[triangles[i / 3][i % 3]] - centre) * scale;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        points[3 * i + axis] = static_cast<float>(point[axis]);
      }
      corners[i] = static_cast<std::uint32_t>(i);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(handle, geometry);
    rtcReleaseGeometry(geometry);
  }
};

SpatialIndex::SpatialIndex(std::span<const Vec3> positions, std::span<const Triangle> triangles)
    : scene_(std::make_unique<Scene>()) {
  scene_->positions = positions;
  scene_->triangles = triangles;
  if (triangles.empty()) return;
  Box box;
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t point : triangle) box.extend(positions[point]);
  }
  scene_->centre = (box.low + box.high) * 0.5;
  const double half = 0.5 * box.size().max();
  scene_->scale = half > 0 ? 1 / half : 1;
  run_isolated([&] {
    scene_->handle = rtcNewScene(embree_device());
    scene_->attach_triangles();
    rtcCommitScene(scene_->handle);
  });
}

SpatialIndex::~SpatialIndex() = default;
SpatialIndex::SpatialIndex(SpatialIndex&&) noexcept = default;

ClosestPoint SpatialIndex::closest(const Vec3& query, double reach) const {
  Scene::Query state{scene_.get(), query, {}, std::numeric_limits<double>::infinity()};
  state.best.distance = std::numeric_limits<double>::infinity();
  if (scene_->handle == nullptr) return state.best;
  RTCPointQuery point_query = scene_->point_query(query, reach);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_->handle, &point_query, &context, &Scene::visit, &state);
  state.best.distance = std::sqrt(state.best_squared);
  if (state.best.distance <= reach) return state.best;
  return {std::numeric_limits<double>::infinity(), kNoTriangle, Vec3(0, 0, 0)};
}

double SpatialIndex::distance_to(const Vec3& query, std::uint32_t triangle) const {
  return std::sqrt((scene_->closest_on(query, triangle) - query).sqrnorm());
}

Plane SpatialIndex::prism_side(std::uint32_t triangle, std::size_t edge) const {
  const auto corner = [&](std::size_t i) {
    return scene_->positions[scene_->triangles[triangle][i % 3]];
  };
  const Vec3 along = corner(edge + 1) - corner(edge);
  const Vec3 outwards = cross(along, cross(along, corner(edge + 2) - corner(edge)));
  const double length = outwards.norm();
  return {corner(edge), length > 0 ? outwards / length : Vec3(0, 0, 0)};
}

std::optional<std::vector<std::uint32_t>> SpatialIndex::triangles_in_ball(const Vec3& centre,
                                                                          double radius,
                                                                          std::size_t most) const {
  Scene::BallQuery state{scene_.get(), centre, radius * radius, most, {}};
  if (scene_->handle == nullptr) return std::move(state.found);
  RTCPointQuery point_query = scene_->point_query(centre, radius);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_->handle, &point_query, &context, &Scene::collect, &state);
  if (state.found.size() > most) return std::nullopt;
  std::sort(state.found.begin(), state.found.end());
  return std::move(state.found);
}

Vec3 closest_on_triangle(const Vec3& query, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = query - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = query - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + ab * (d1 / (d1 - d3));
  const Vec3 cp = query - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6 && d4 - d3 + d5 - d6 > 0) {
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const double total = va + vb + vc;
  if (!(total > 0)) return a;  // a degenerate triangle that the edge cases missed
  return a + ab * (vb / total) + ac * (vc / total);
}

}  // namespace triglyph
