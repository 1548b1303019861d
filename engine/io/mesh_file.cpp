#include "engine/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/text.h"
#include "engine/geometry/box.h"
#include "engine/io/byte_parts.h"
#include "engine/io/file_bytes.h"
#include "engine/io/gltf.h"
#include "engine/io/number_text.h"
#include "engine/io/readers.h"
#include "engine/mesh/triangulate.h"
#include "engine/mesh/weld.h"

namespace triglyph {
namespace {

constexpr std::size_t kStyleSample = 4096;    // vertices from which the number style is learned
constexpr int kMostDigits = 17;               // a double holds no more
constexpr std::size_t kPatchBlock = 1 << 16;  // vertices patched by one thread

struct Reader {
  std::string_view ending;
  FileContent (*read)(const Source& source);
};
constexpr std::array<Reader, 6> kReaders = {{{".obj", read_obj},
                                             {".off", read_off},
                                             {".ply", read_ply},
                                             {".stl", read_stl},
                                             {".gltf", read_gltf},
                                             {".glb", read_gltf}}};
constexpr auto kEndings = [] {
  std::array<std::string_view, kReaders.size()> endings;
  for (std::size_t i = 0; i < endings.size(); ++i) endings[i] = kReaders[i].ending;
  return endings;
}();

// Endings of meshes in formats that other tools convert.
constexpr std::array<std::string_view, 14> kConvertible = {
    ".3ds",  ".3mf",  ".abc",  ".blend", ".dae", ".fbx", ".usd",
    ".usda", ".usdc", ".usdz", ".vrml",  ".wrl", ".x",   ".x3d"};

FileContent read_content(const Source& source) {
  const std::string ending = lower_case_ending(source.path);
  for (const Reader& reader : kReaders) {
    if (reader.ending == ending) return reader.read(source);
  }
  std::string why = "'";
  why.append(ending);
  if (std::find(kConvertible.begin(), kConvertible.end(), ending) != kConvertible.end()) {
    why.append("' is not read; export the mesh as .glb, .obj, .ply or .stl, ");
    why.append("for example with Blender or assimp");
  } else {
    why.append("' is an unknown ending (known:");
    for (const std::string_view known : kEndings) why.append(" ").append(known);
    why.append(")");
  }
  throw Error(ErrorCode::Unsupported, source.path, "", why);
}

// Returns the number token at `begin`, which the reader has accepted.
std::string_view number_at(std::span<const char> bytes, std::uint64_t begin) {
  std::uint64_t end = begin;
  const auto is_part = [](char c) {
    return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
  };
  while (end < bytes.size() && is_part(bytes[end])) ++end;
  return {bytes.data() + begin, end - begin};
}

}  // namespace

std::span<const std::string_view> mesh_endings() noexcept {
  return kEndings;
}

struct MeshFile::Content {
  FileBytes file;
  std::vector<char> owned;  // instead of `file`, for files in memory
  std::span<const char> bytes;
  std::vector<char> image;  // what `places` refers to, if not to `bytes`
  std::string why_fixed;
  std::shared_ptr<const GltfFile> gltf;
  FileFormat format = FileFormat::Obj;
  CoordinatePlaces places;
  std::array<NumberStyle, 3> learnt;          // the style of each axis, in text
  std::array<NumberStyle, 3> style;           // of coordinates that are moved
  std::array<int, 3> axis_order = {0, 1, 2};  // in the order of the file
  Vec3 magnitude = {0, 0, 0};
  std::vector<std::uint32_t> point_of_vertex;
  std::size_t face_count = 0;
  Faces faces;  // only of a file that has polygons
  Mesh mesh;

  void fill(const std::filesystem::path& path);
  void learn_styles();
  [[nodiscard]] double round(double value, int axis) const;
  [[nodiscard]] std::uint64_t first_byte(std::size_t vertex) const {
    return places.offset(vertex, axis_order[0]);
  }
  void patch_text(std::span<const Vec3> positions, std::size_t begin, std::size_t end,
                  std::vector<char>& out) const;
  void patch_binary(std::span<const Vec3> positions, std::size_t begin, std::size_t end,
                    char* out) const;
  void patch_image(std::span<const Vec3> positions, char* out) const;
  // Returns the value that vertex v has in the file once points lie at the positions.
  [[nodiscard]] double stored(std::span<const Vec3> positions, std::size_t v, int axis) const {
    const std::uint32_t point = point_of_vertex[v];
    const double from = mesh.positions[point][axis], to = positions[point][axis];
    return to == from ? from : round(to, axis);
  }
  [[nodiscard]] std::vector<BoundsChange> bounds_changes(std::span<const Vec3> positions) const;
  [[nodiscard]] std::vector<char> patched_gltf(std::span<const Vec3> positions) const;
};

void MeshFile::Content::fill(const std::filesystem::path& path) {
  FileContent content = read_content({bytes, path});
  if (content.vertices.size() > kMaxCount || content.faces.corners.size() > kMaxCount) {
    throw Error(ErrorCode::Unsupported, path, "",
                "more vertices or corners than 32 bits can number");
  }
  format = content.format;
  places = std::move(content.places);
  image = std::move(content.image);
  why_fixed = std::move(content.why_fixed);
  gltf = std::move(content.gltf);
  face_count = content.faces.ends.size();
  Weld welded = weld(content.vertices);
  std::vector<Vec3>().swap(content.vertices);
  point_of_vertex = std::move(welded.point_of_vertex);
  mesh.positions = std::move(welded.points);
  mesh.triangles = triangulate(content.faces, point_of_vertex, mesh.positions);
  if (content.faces.corners.size() > 3 * face_count) faces = std::move(content.faces);
  for (const Vec3& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      magnitude[axis] = std::max(magnitude[axis], std::abs(p[axis]));
    }
  }
  if (point_of_vertex.empty()) return;
  std::sort(axis_order.begin(), axis_order.end(),
            [&](int a, int b) { return places.offset(0, a) < places.offset(0, b); });
  if (places.is_text) learn_styles();
}

void MeshFile::Content::learn_styles() {
  std::vector<std::string_view> tokens;
  const std::size_t count = point_of_vertex.size();
  const std::size_t stride = std::max<std::size_t>(count / kStyleSample, 1);
  for (std::size_t v = 0; v < count; v += stride) {
    for (int axis = 0; axis < 3; ++axis) {
      tokens.push_back(number_at(bytes, places.offset(v, axis)));
    }
  }
  const NumberStyle shared = learn_style(tokens);
  for (int axis = 0; axis < 3; ++axis) {
    learnt[axis] = is_integer(places.scalar[axis]) ? NumberStyle{} : shared;
  }
  style = learnt;
}

double MeshFile::Content::round(double value, int axis) const {
  const Scalar scalar = places.scalar[axis];
  if (places.is_text && !is_integer(scalar)) return round_to(style[axis], value);
  return round_to(scalar, value);
}

void MeshFile::Content::patch_text(std::span<const Vec3> positions, std::size_t begin,
                                   std::size_t end, std::vector<char>& out) const {
  const std::size_t count = point_of_vertex.size();
  std::uint64_t copied = begin == 0 ? 0 : first_byte(begin);
  const std::uint64_t stop = end == count ? bytes.size() : first_byte(end);
  out.reserve(stop - copied + (stop - copied) / 16);
  const auto copy_up_to = [&](std::uint64_t offset) {
    out.insert(out.end(), bytes.begin() + static_cast<std::ptrdiff_t>(copied),
               bytes.begin() + static_cast<std::ptrdiff_t>(offset));
    copied = offset;
  };
  char text[kNumberCapacity];
  for (std::size_t v = begin; v < end; ++v) {
    const std::uint32_t point = point_of_vertex[v];
    const Vec3 &from = mesh.positions[point], &to = positions[point];
    if (from == to) continue;
    for (const int axis : axis_order) {
      if (to[axis] == from[axis]) continue;
      const double rounded = round(to[axis], axis);
      if (rounded == from[axis]) continue;
      const std::uint64_t offset = places.offset(v, axis);
      copy_up_to(offset);
      out.insert(
          out.end(), text,
          format_number(style[axis], is_integer(places.scalar[axis]) ? rounded : to[axis], text));
      copied += number_at(bytes, offset).size();
    }
  }
  copy_up_to(stop);
}

void MeshFile::Content::patch_binary(std::span<const Vec3> positions, std::size_t begin,
                                     std::size_t end, char* out) const {
  for (std::size_t v = begin; v < end; ++v) {
    const std::uint32_t point = point_of_vertex[v];
    const Vec3 &from = mesh.positions[point], &to = positions[point];
    for (int axis = 0; axis < 3; ++axis) {
      if (to[axis] == from[axis] || round(to[axis], axis) == from[axis]) continue;
      store(to[axis], places.scalar[axis], places.is_big_endian, out + places.offset(v, axis));
    }
  }
}

void MeshFile::Content::patch_image(std::span<const Vec3> positions, char* out) const {
  parallel_blocks(
      point_of_vertex.size(),
      [&](std::size_t begin, std::size_t end) { patch_binary(positions, begin, end, out); },
      kPatchBlock);
}

std::vector<BoundsChange> MeshFile::Content::bounds_changes(std::span<const Vec3> positions) const {
  std::vector<BoundsChange> changes;
  for (const GltfFile::Accessor& accessor : gltf->accessors) {
    Box before, after;
    for (std::size_t v = accessor.first; v < accessor.first + accessor.count; ++v) {
      const std::uint32_t point = point_of_vertex[v];
      const Vec3& from = mesh.positions[point];
      before.extend(from);
      after.extend(from == positions[point] ? from
                                            : Vec3(stored(positions, v, 0), stored(positions, v, 1),
                                                   stored(positions, v, 2)));
    }
    for (int axis = 0; axis < 3 && accessor.count > 0; ++axis) {
      if (before.low[axis] != after.low[axis]) {
        changes.push_back({accessor.index, axis, false, after.low[axis]});
      }
      if (before.high[axis] != after.high[axis]) {
        changes.push_back({accessor.index, axis, true, after.high[axis]});
      }
    }
  }
  return changes;
}

std::vector<char> MeshFile::Content::patched_gltf(std::span<const Vec3> positions) const {
  const std::vector<BoundsChange> changes = bounds_changes(positions);
  if (!image.empty()) {
    std::vector<char> moved = image;
    patch_image(positions, moved.data());
    return rewritten_gltf(*gltf, moved, bytes.size(), changes).bytes;
  }
  RewrittenGltf out = rewritten_gltf(*gltf, bytes, bytes.size(), changes);
  patch_image(positions, out.bytes.data() + out.shift);
  return std::move(out.bytes);
}

std::string_view name_of(FileFormat format) noexcept {
  switch (format) {
    case FileFormat::Obj:
      return "obj";
    case FileFormat::Off:
      return "off";
    case FileFormat::PlyAscii:
      return "ply ascii";
    case FileFormat::PlyLittle:
      return "ply binary_little_endian";
    case FileFormat::PlyBig:
      return "ply binary_big_endian";
    case FileFormat::StlAscii:
      return "stl ascii";
    case FileFormat::StlBinary:
      return "stl binary";
    case FileFormat::Gltf:
      return "gltf";
    case FileFormat::Glb:
      return "glb";
  }
  return "unknown";
}

MeshFile MeshFile::open(const std::filesystem::path& path) {
  auto content = std::make_unique<Content>();
  content->file = FileBytes::open(path);
  content->bytes = content->file.bytes();
  content->fill(path);
  return MeshFile(std::move(content));
}

MeshFile MeshFile::read(std::vector<char> bytes, const std::filesystem::path& name) {
  auto content = std::make_unique<Content>();
  if (bytes.empty()) throw Error(ErrorCode::Unreadable, name, "", "is empty");
  content->owned = std::move(bytes);
  content->bytes = content->owned;
  content->fill(name);
  return MeshFile(std::move(content));
}

MeshFile::MeshFile(std::unique_ptr<Content> content) : content_(std::move(content)) {}
MeshFile::MeshFile(MeshFile&&) noexcept = default;
MeshFile& MeshFile::operator=(MeshFile&&) noexcept = default;
MeshFile::~MeshFile() = default;

FileFormat MeshFile::format() const {
  return content_->format;
}
std::span<const char> MeshFile::bytes() const {
  return content_->bytes;
}
const std::string& MeshFile::why_fixed() const {
  return content_->why_fixed;
}
std::size_t MeshFile::vertex_count() const {
  return content_->point_of_vertex.size();
}
std::size_t MeshFile::face_count() const {
  return content_->face_count;
}
const Mesh& MeshFile::mesh() const {
  return content_->mesh;
}

bool MeshFile::has_polygons() const {
  return !content_->faces.ends.empty();
}

std::vector<Triangle> MeshFile::triangles_at(std::span<const Vec3> positions) const {
  check(positions.size() == mesh().positions.size(), "as many positions as points");
  if (!has_polygons()) return mesh().triangles;
  return triangulate(content_->faces, content_->point_of_vertex, positions);
}

std::span<const std::uint32_t> MeshFile::point_of_vertex() const {
  return content_->point_of_vertex;
}

Vec3 MeshFile::round(const Vec3& point) const {
  return {content_->round(point[0], 0), content_->round(point[1], 1), content_->round(point[2], 2)};
}

bool MeshFile::is_decimal() const {
  const CoordinatePlaces& places = content_->places;
  return places.is_text && !content_->point_of_vertex.empty() && !is_integer(places.scalar[0]);
}

void MeshFile::set_more_digits(int count) {
  if (!is_decimal()) return;
  content_->style = content_->learnt;
  for (NumberStyle& style : content_->style) {
    style.decimals += count;
    style.significant = std::min(style.significant + count, kMostDigits);
  }
}

double MeshFile::number_step() const {
  double step = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Scalar scalar = content_->places.scalar[axis];
    const bool is_decimal = content_->places.is_text && !is_integer(scalar);
    const double largest = content_->magnitude[axis];
    step = std::max(
        step, is_decimal ? step_at(content_->style[axis], largest) : step_at(scalar, largest));
  }
  return step;
}

std::vector<char> MeshFile::patched(std::span<const Vec3> positions) const {
  const Content& content = *content_;
  check(positions.size() == content.mesh.positions.size(), "one position for every point");
  const bool is_finite = std::all_of(positions.begin(), positions.end(), [](const Vec3& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
  });
  check(is_finite, "positions are finite");
  if (!content.why_fixed.empty()) {
    throw Error(ErrorCode::Unsupported, {}, "", content.why_fixed);
  }
  if (content.gltf) return content.patched_gltf(positions);
  const std::size_t count = content.point_of_vertex.size();
  if (!content.places.is_text || count == 0) {
    std::vector<char> out(content.bytes.begin(), content.bytes.end());
    content.patch_image(positions, out.data());
    return out;
  }
  std::vector<std::vector<char>> parts((count + kPatchBlock - 1) / kPatchBlock);
  parallel_blocks(
      count,
      [&](std::size_t begin, std::size_t end) {
        content.patch_text(positions, begin, end, parts[begin / kPatchBlock]);
      },
      kPatchBlock);
  return join(std::move(parts));
}

}  // namespace triglyph
