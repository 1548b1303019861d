#include "render/ray_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/box.h"
#include "engine/geometry/embree_device.h"
#include "render/colours.h"

namespace triglyph {
namespace {

constexpr int kLanes = 16;
constexpr float kBallOpacity = 0.45F;
constexpr float kEdgeOpacity = 0.55F;

struct SceneHandle {
  RTCScene handle = nullptr;
  SceneHandle() = default;
  SceneHandle(const SceneHandle&) = delete;
  SceneHandle& operator=(const SceneHandle&) = delete;
  ~SceneHandle() {
    if (handle != nullptr) rtcReleaseScene(handle);
  }
};

void* buffer_of(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t item,
                std::size_t count) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, item, count);
  if (buffer == nullptr) throw std::bad_alloc();
  return buffer;
}

void commit(RTCGeometry geometry, SceneHandle& scene) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.handle, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.handle);
}

// A packet of parallel rays and their hits.
struct Packet {
  alignas(64) std::array<int, kLanes> valid{};
  alignas(64) RTCRayHit16 rays{};

  [[nodiscard]] bool hits(int lane) const {
    return rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
  }
};

// Returns the position of sample i in a pixel: a low-discrepancy sequence, the same in every pixel.
std::array<double, 2> place_in_pixel(int i) {
  const double x = 0.5 + i * 0.7548776662466927;
  const double y = 0.5 + i * 0.5698402909980532;
  return {x - std::floor(x), y - std::floor(y)};
}

// A directional light in the axes of the camera.
struct Lamp {
  Vec3 from;
  float strength;
};
const std::array<Lamp, 3>& lamps() {
  static const auto unit = [](const Vec3& v) { return v / v.norm(); };
  static const std::array<Lamp, 3> all = {{{unit(Vec3(-0.5, 0.7, 0.8)), 0.72F},
                                           {unit(Vec3(0.9, 0.1, 0.6)), 0.22F},
                                           {unit(Vec3(0.1, -0.8, 0.5)), 0.08F}}};
  return all;
}

// Returns the light that a diffuse surface with a faint gloss reflects to the viewer. The normal is
// in the axes of the camera.
Colour lit(const Colour& paint, Vec3 normal) {
  if (normal[2] < 0) normal *= -1.0;  // back sides look like front sides
  float light = 0.16F + 0.08F * static_cast<float>(normal[1]);
  for (const Lamp& lamp : lamps()) {
    light += lamp.strength * static_cast<float>(std::max(0.0, dot(normal, lamp.from)));
  }
  const Vec3 halfway = lamps()[0].from + Vec3(0, 0, 1);
  const double gloss = std::max(0.0, dot(normal, halfway) / halfway.norm());
  const auto shine = static_cast<float>(0.06 * std::pow(gloss, 40));
  return {paint.red * light + shine, paint.green * light + shine, paint.blue * light + shine, 1};
}

}  // namespace

struct RayCaster::Tracer {
  const Scene& scene;
  Vec3 centre{0, 0, 0};
  double scale = 1;  // Embree units per model unit
  SceneHandle surface, dots, balls;

  explicit Tracer(const Scene& seen) : scene(seen) {
    const Box box = bounding_box(scene.mesh.positions);
    centre = (box.low + box.high) / 2;
    const double half = box.size().max() / 2;
    scale = half > 0 ? 1 / half : 1;
    run_isolated([&] {
      attach_surface();
      attach_balls(scene.dots, dots);
      attach_balls(scene.balls, balls);
    });
  }

  [[nodiscard]] std::array<float, 3> local(const Vec3& point) const {
    const Vec3 p = (point - centre) * scale;
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  }

  void attach_surface() {
    surface.handle = rtcNewScene(embree_device());
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t count = scene.mesh.positions.size();
    auto* points = static_cast<float*>(
        buffer_of(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float), count));
    for (std::size_t p = 0; p < count; ++p) {
      const auto at = local(scene.mesh.positions[p]);
      std::copy(at.begin(), at.end(), points + 3 * p);
    }
    auto* corners = static_cast<std::uint32_t*>(
        buffer_of(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                  scene.mesh.triangles.size()));
    for (const Triangle& triangle : scene.mesh.triangles) {
      corners = std::copy(triangle.begin(), triangle.end(), corners);
    }
    commit(geometry, surface);
  }

  void attach_balls(std::span<const Ball> list, SceneHandle& target) const {
    if (list.empty()) return;
    target.handle = rtcNewScene(embree_device());
    RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* spheres = static_cast<float*>(buffer_of(
        geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float), list.size()));
    for (const Ball& ball : list) {
      const auto at = local(ball.centre);
      spheres = std::copy(at.begin(), at.end(), spheres);
      *spheres++ = static_cast<float>(ball.radius * scale);
    }
    commit(geometry, target);
  }

  // In the camera's axes.
  [[nodiscard]] static Vec3 seen_from(const Camera& camera, const Vec3& direction) {
    return {dot(direction, camera.right), dot(direction, camera.up),
            dot(direction, camera.towards_viewer())};
  }

  // Returns the rays of samples first .. first + 15 of a pixel.
  void aim(const Camera& camera, int width, int height, int x, int y, int first, int samples,
           Packet& packet) const {
    const double pixel = 2 * camera.half_height / height;
    const Vec3 towards = camera.towards_viewer();
    const double away = 4 / scale + (camera.centre - centre).norm();  // outside the scene
    const Vec3 start = camera.centre + towards * std::min(camera.reach, away);
    for (int lane = 0; lane < kLanes; ++lane) {
      packet.valid[static_cast<std::size_t>(lane)] = first + lane < samples ? -1 : 0;
      const auto [dx, dy] = place_in_pixel(first + lane);
      const Vec3 from = start + camera.right * ((x + dx - width / 2.0) * pixel) +
                        camera.up * ((height / 2.0 - y - dy) * pixel);
      const auto origin = local(from);
      packet.rays.ray.org_x[lane] = origin[0];
      packet.rays.ray.org_y[lane] = origin[1];
      packet.rays.ray.org_z[lane] = origin[2];
      packet.rays.ray.dir_x[lane] = static_cast<float>(-towards[0]);
      packet.rays.ray.dir_y[lane] = static_cast<float>(-towards[1]);
      packet.rays.ray.dir_z[lane] = static_cast<float>(-towards[2]);
      packet.rays.ray.tnear[lane] = 0;
      packet.rays.ray.time[lane] = 0;
      packet.rays.ray.mask[lane] = 0xffffffff;
      packet.rays.ray.flags[lane] = 0;
    }
  }

  static void cast(const SceneHandle& target, Packet& packet) {
    for (int lane = 0; lane < kLanes; ++lane) {
      packet.rays.ray.tfar[lane] = std::numeric_limits<float>::infinity();
      packet.rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(packet.valid.data(), target.handle, &context, &packet.rays);
  }

  // Returns the colour of the lit surface where a lane hit it.
  [[nodiscard]] Colour surface_colour(const Packet& packet, int lane, const Camera& camera) const {
    const std::uint32_t face = packet.rays.hit.primID[lane];
    const double u = packet.rays.hit.u[lane];
    const double v = packet.rays.hit.v[lane];
    const std::array<double, 3> shares = {1 - u - v, u, v};
    const Triangle& corners = scene.mesh.triangles[face];
    Vec3 normal(0, 0, 0);
    if (scene.normals.size() == scene.mesh.triangles.size()) {
      normal = scene.normals[face];
    } else {
      for (std::size_t c = 0; c < 3; ++c)
        normal += scene.normals[std::size_t{3} * face + c] * shares[c];
      const double length = normal.norm();
      if (length > 0) normal /= length;
    }
    static const Colour clay = from_srgb(kClay);
    Colour paint = scene.face_colours.empty() ? clay : scene.face_colours[face];
    if (!scene.point_colours.empty()) {
      paint = {0, 0, 0, 0};
      for (std::size_t c = 0; c < 3; ++c) {
        const Colour part = times(scene.point_colours[corners[c]], static_cast<float>(shares[c]));
        paint = {paint.red + part.red, paint.green + part.green, paint.blue + part.blue, 1};
      }
    }
    Colour colour = lit(paint, seen_from(camera, normal));
    if (scene.edge_width > 0 && is_on_edge(corners, shares)) {
      colour = mix(colour, from_srgb(kInk), kEdgeOpacity);
    }
    return colour;
  }

  // Returns whether a hit is nearer to a side than half the width of a drawn edge.
  [[nodiscard]] bool is_on_edge(const Triangle& corners,
                                const std::array<double, 3>& shares) const {
    const auto& at = scene.mesh.positions;
    const double area = area_normal(at, corners).norm();
    for (std::size_t c = 0; c < 3; ++c) {
      const double side = (at[corners[(c + 1) % 3]] - at[corners[(c + 2) % 3]]).norm();
      if (side > 0 && shares[c] * area / side < scene.edge_width / 2) return true;
    }
    return false;
  }

  [[nodiscard]] static Colour ball_colour(const Packet& packet, int lane, unsigned paint,
                                          const Camera& camera) {
    Vec3 normal(packet.rays.hit.Ng_x[lane], packet.rays.hit.Ng_y[lane], packet.rays.hit.Ng_z[lane]);
    const double length = normal.norm();
    if (length > 0) normal /= length;
    return lit(from_srgb(paint), seen_from(camera, normal));
  }

  [[nodiscard]] Colour pixel(const Camera& camera, int width, int height, int x, int y,
                             int samples) const {
    Colour sum{0, 0, 0, 0};
    Packet met, dot_met, ball_met;
    for (int first = 0; first < samples; first += kLanes) {
      aim(camera, width, height, x, y, first, samples, met);
      if (dots.handle != nullptr) dot_met = met;
      if (balls.handle != nullptr) ball_met = met;
      cast(surface, met);
      if (dots.handle != nullptr) cast(dots, dot_met);
      if (balls.handle != nullptr) cast(balls, ball_met);
      std::uint32_t last_face = RTC_INVALID_GEOMETRY_ID;
      Colour last{};
      for (int lane = 0; lane < std::min(kLanes, samples - first); ++lane) {
        Colour colour{0, 0, 0, 0};
        float depth = std::numeric_limits<float>::infinity();
        if (met.hits(lane)) {
          // samples of a pixel that hit one face look alike, unless edges are drawn
          if (met.rays.hit.primID[lane] != last_face || scene.edge_width > 0) {
            last_face = met.rays.hit.primID[lane];
            last = surface_colour(met, lane, camera);
          }
          colour = last;
          depth = met.rays.ray.tfar[lane];
        }
        if (dots.handle != nullptr && dot_met.hits(lane) && dot_met.rays.ray.tfar[lane] < depth) {
          colour = ball_colour(dot_met, lane, kMarkBlue, camera);
          depth = dot_met.rays.ray.tfar[lane];
        }
        if (balls.handle != nullptr && ball_met.hits(lane) &&
            ball_met.rays.ray.tfar[lane] < depth) {
          colour =
              over(times(ball_colour(ball_met, lane, kBallGreen, camera), kBallOpacity), colour);
        }
        sum = {sum.red + colour.red, sum.green + colour.green, sum.blue + colour.blue,
               sum.alpha + colour.alpha};
      }
    }
    return times(sum, 1.0F / static_cast<float>(samples));
  }
};

RayCaster::RayCaster(const Scene& scene) : tracer_(std::make_unique<Tracer>(scene)) {
  check(!scene.mesh.triangles.empty(), "a scene has faces");
}

RayCaster::~RayCaster() = default;

Image RayCaster::draw(const Camera& camera, int width, int height, int samples) const {
  Image image(width, height);
  parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = tracer_->pixel(camera, width, height, x, y, samples);
    }
  });
  return image;
}

}  // namespace triglyph
