// glTF 2.0. Reads the positions and the triangles of every mesh, each in its own space, as one
// mesh: the transforms of nodes, skins and morph targets are not applied and stay as they are.
// Seams between primitives close, since equal positions are one point.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "engine/base/error.h"
#include "engine/io/base64.h"
#include "engine/io/file_bytes.h"
#include "engine/io/gltf_compression.h"
#include "engine/io/gltf_json.h"

namespace triglyph {
namespace {

constexpr std::uint64_t kTriangles = 4, kStrip = 5, kFan = 6;  // modes of a primitive

// A stretch of bytes of the image.
struct GltfView {
  std::uint64_t place = 0, size = 0;
  std::uint64_t stride = 0;  // 0: values follow each other
};

// The elements of an accessor without its sparse part.
struct GltfElements {
  Scalar scalar = Scalar::Float32;
  std::uint64_t components = 1;
  std::uint64_t count = 0;
  bool has_view = false;
  std::uint64_t place = 0, stride = 0;

  [[nodiscard]] std::uint64_t size() const { return components * size_of(scalar); }
  [[nodiscard]] std::uint64_t end() const { return place + (count - 1) * stride + size(); }
};

class GltfReader {
 public:
  explicit GltfReader(const Source& source)
      : source_(source),
        chunks_(find_gltf_chunks(source)),
        gltf_(parse_gltf(parser_, source, chunks_)),
        buffers_(gltf_.items("buffers")),
        views_(gltf_.items("bufferViews")),
        accessors_(gltf_.items("accessors")) {
    file_->is_binary = chunks_.is_binary;
    file_->json = chunks_.json;
    file_->json_size = chunks_.json_size;
  }

  FileContent read() {
    content_.format = chunks_.is_binary ? FileFormat::Glb : FileFormat::Gltf;
    content_.places.is_text = false;
    content_.places.scalar = {Scalar::Float32, Scalar::Float32, Scalar::Float32};
    for (const GltfObject& mesh : gltf_.items("meshes")) {
      for (const GltfObject& primitive : mesh.items("primitives")) read_primitive(primitive);
    }
    if (content_.vertices.empty()) gltf_.fail("no mesh has positions");
    if (content_.why_fixed.empty()) find_shared_bytes();
    if (!content_.why_fixed.empty()) content_.places.tokens.resize(content_.vertices.size());
    content_.gltf = std::move(file_);
    return std::move(content_);
  }

 private:
  struct Positions {
    std::size_t first = 0, count = 0;
  };

  [[nodiscard]] std::span<const char> image() const {
    return content_.image.empty() ? source_.bytes : std::span<const char>(content_.image);
  }

  // Returns the image as one that bytes can be appended to.
  std::vector<char>& growing_image() {
    if (content_.image.empty()) content_.image.assign(source_.bytes.begin(), source_.bytes.end());
    return content_.image;
  }

  const GltfObject& at(const std::vector<GltfObject>& list, const char* name,
                       std::uint64_t index) const {
    if (index >= list.size()) {
      gltf_.fail(std::string(name) + "[" + std::to_string(index) + "] is not there");
    }
    return list[index];
  }

  void fix(const std::string& why) {
    if (content_.why_fixed.empty()) content_.why_fixed = why;
  }

  GltfView buffer(std::uint64_t index) {
    const auto known = read_buffers_.find(index);
    if (known != read_buffers_.end()) return known->second;
    const GltfObject& object = at(buffers_, "buffers", index);
    const std::uint64_t length = object.needed_number("byteLength");
    const auto uri = object.text("uri");
    GltfView view;
    if (!uri) {
      if (index != 0 || !chunks_.data) object.fail("has neither a uri nor a binary chunk");
      view = {*chunks_.data, chunks_.data_size, 0};
    } else if (uri->starts_with("data:")) {
      view = decoded_buffer(object, index, *uri);
    } else {
      view = other_file(object, *uri);
    }
    if (view.size < length) {
      object.fail("has " + std::to_string(view.size) + " bytes, not " + std::to_string(length));
    }
    view.size = length;
    read_buffers_.emplace(index, view);
    return view;
  }

  GltfView decoded_buffer(const GltfObject& object, std::uint64_t index, std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
      object.refuse("a data URI that is not in base64");
    }
    const std::string_view text = uri.substr(comma + 1);
    std::vector<char>& bytes = growing_image();
    const std::size_t first = bytes.size();
    if (!append_from_base64(text, bytes)) object.fail("its data URI is not base64");
    const std::size_t size = bytes.size() - first;
    file_->data_uris.push_back({static_cast<std::size_t>(index), first, size});
    return {first, size, 0};
  }

  // Appends the bytes of a file beside this one. Names that lead elsewhere are refused: a mesh from
  // anywhere must not make the program read any file.
  GltfView other_file(const GltfObject& object, std::string_view uri) {
    const std::filesystem::path name =
        std::filesystem::path(percent_decoded(uri)).lexically_normal();
    const bool leads_away = uri.find(':') != std::string_view::npos || name.empty() ||
                            name.is_absolute() || *name.begin() == "..";
    if (leads_away) object.refuse("its buffer is not in a file beside or below this one");
    fix("its coordinates are in another file, " + name.string() +
        "; pack both into one .glb, for example with Blender or gltf-transform");
    const auto known = other_files_.find(name);
    if (known != other_files_.end()) return known->second;
    const FileBytes file = FileBytes::open(source_.path.parent_path() / name);
    std::vector<char>& bytes = growing_image();
    const GltfView view{bytes.size(), file.bytes().size(), 0};
    bytes.insert(bytes.end(), file.bytes().begin(), file.bytes().end());
    other_files_.emplace(name, view);
    return view;
  }

  GltfView view(std::uint64_t index) {
    const auto known = read_views_.find(index);
    if (known != read_views_.end()) return known->second;
    const GltfObject& object = at(views_, "bufferViews", index);
    GltfView result;
    std::optional<GltfObject> packed;
    if (const auto extensions = object.child("extensions")) {
      packed = extensions->child("EXT_meshopt_compression");
      if (!packed) packed = extensions->child("KHR_meshopt_compression");
    }
    const GltfObject& range = packed ? *packed : object;
    const GltfView whole = buffer(range.needed_number("buffer"));
    const std::uint64_t offset = range.number("byteOffset").value_or(0);
    result.size = range.needed_number("byteLength");
    if (offset > whole.size || result.size > whole.size - offset) {
      range.fail("reaches beyond its buffer");
    }
    result.place = whole.place + offset;
    result.stride = range.number("byteStride").value_or(0);
    if (packed) result = unpacked(object, *packed, result);
    read_views_.emplace(index, result);
    return result;
  }

  GltfView unpacked(const GltfObject& object, const GltfObject& packed, const GltfView& range) {
    fix("its coordinates are compressed (EXT_meshopt_compression); decode them, for example with "
        "gltfpack without -c, or with Blender");
    MeshoptView how;
    how.count = packed.needed_number("count");
    how.stride = packed.needed_number("byteStride");
    how.mode = packed.text("mode").value_or("");
    how.filter = packed.text("filter").value_or("");
    const std::vector<char> bytes(
        image().begin() + static_cast<std::ptrdiff_t>(range.place),
        image().begin() + static_cast<std::ptrdiff_t>(range.place + range.size));
    std::vector<char>& out = growing_image();
    const std::uint64_t first = out.size();
    if (!decode_meshopt(how, bytes, out)) packed.fail("cannot be decoded");
    return {first, out.size() - first, object.number("byteStride").value_or(0)};
  }

  GltfElements elements(std::uint64_t index) {
    const GltfObject& object = at(accessors_, "accessors", index);
    GltfElements result;
    result.scalar = component_type_of(object);
    result.components = components_of(object);
    result.count = object.needed_number("count");
    const auto view_index = object.number("bufferView");
    result.has_view = view_index.has_value();
    if (view_index)
      place(object, view(*view_index), object.number("byteOffset").value_or(0), result);
    return result;
  }

  // Sets the place of the elements, all of which lie in the view.
  static void place(const GltfObject& object, const GltfView& view, std::uint64_t offset,
                    GltfElements& result) {
    result.stride = view.stride == 0 ? result.size() : view.stride;
    if (result.stride < result.size()) object.fail("its elements overlap: the stride is too small");
    if (result.count == 0) return;
    const bool fits = offset <= view.size && result.size() <= view.size - offset &&
                      (result.count - 1) <= (view.size - offset - result.size()) / result.stride;
    if (!fits) object.fail("reaches beyond its buffer view");
    result.place = view.place + offset;
  }

  // Reads the positions of an accessor once, however many primitives use it.
  Positions positions(std::uint64_t index) {
    const auto known = read_positions_.find(index);
    if (known != read_positions_.end()) return known->second;
    const GltfObject& object = at(accessors_, "accessors", index);
    const GltfElements base = elements(index);
    if (base.components != 3) object.fail("positions are VEC3");
    if (base.scalar == Scalar::UInt32) object.fail("positions are floats, bytes or shorts");
    if (!content_.vertices.empty() && base.scalar != content_.places.scalar[0]) {
      object.refuse("positions of several number types in one file");
    }
    content_.places.scalar = {base.scalar, base.scalar, base.scalar};
    const auto sparse = object.child("sparse");
    if (!base.has_view && !sparse) object.fail("positions without values");
    // No primitive needs more points than the file has bytes for, unless they overlap.
    if (base.count > kMaxCount || base.count + content_.vertices.size() > image().size()) {
      object.refuse("more positions than a file of this size holds without sharing bytes");
    }
    const Positions result{content_.vertices.size(), static_cast<std::size_t>(base.count)};
    const auto step = static_cast<std::int32_t>(size_of(base.scalar));
    content_.vertices.resize(result.first + result.count, Vec3(0, 0, 0));
    content_.places.tokens.resize(result.first + result.count);
    for (std::uint64_t i = 0; i < base.count; ++i) {
      const std::uint64_t place = base.place + i * base.stride;
      content_.places.tokens[result.first + i] = {place, step, 2 * step};
      if (base.has_view) content_.vertices[result.first + i] = point_at(object, place, base.scalar);
    }
    if (base.has_view && base.count > 0) grids_.push_back({base, index, true});
    if (sparse) read_sparse(object, *sparse, base, result);
    read_positions_.emplace(index, result);
    file_->accessors.push_back({static_cast<std::size_t>(index), result.first, result.count});
    return result;
  }

  Vec3 point_at(const GltfObject& object, std::uint64_t place, Scalar scalar) const {
    Vec3 point;
    if (scalar == Scalar::Float32) {  // by far the most
      float values[3];
      std::memcpy(values, image().data() + place, sizeof values);
      if (!(std::isfinite(values[0]) && std::isfinite(values[1]) && std::isfinite(values[2]))) {
        object.fail("coordinate is not finite");
      }
      return {values[0], values[1], values[2]};
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t number = place + static_cast<std::uint64_t>(axis) * size_of(scalar);
      point[axis] = load(image().data() + number, scalar, false);
      if (!std::isfinite(point[axis])) object.fail("coordinate is not finite");
    }
    return point;
  }

  void read_sparse(const GltfObject& object, const GltfObject& sparse, const GltfElements& base,
                   const Positions& result) {
    const GltfObject index_part = sparse.needed_child("indices");
    const GltfObject value_part = sparse.needed_child("values");
    GltfElements indices, values = base;
    indices.scalar = component_type_of(index_part);
    indices.count = values.count = sparse.needed_number("count");
    values.has_view = true;
    place(index_part, view(index_part.needed_number("bufferView")),
          index_part.number("byteOffset").value_or(0), indices);
    place(value_part, view(value_part.needed_number("bufferView")),
          value_part.number("byteOffset").value_or(0), values);
    for (std::uint64_t i = 0; i < values.count; ++i) {
      const double index =
          load(image().data() + indices.place + i * indices.stride, indices.scalar, false);
      if (!(index >= 0 && index < static_cast<double>(result.count))) {
        index_part.fail("an index is out of range");
      }
      const std::size_t v = result.first + static_cast<std::size_t>(index);
      const std::uint64_t place = values.place + i * values.stride;
      content_.vertices[v] = point_at(object, place, base.scalar);
      content_.places.tokens[v].x = place;
    }
    if (values.count > 0) grids_.push_back({values, accessors_.size(), true});
    if (!base.has_view && values.count < result.count) {
      fix(object.place() + " gives only some of its points a place in the file");
    }
  }

  void read_primitive(const GltfObject& primitive) {
    const auto position = primitive.needed_child("attributes").number("POSITION");
    if (!position) return;  // the extension or the viewer has another use for it
    const std::uint64_t mode = primitive.number("mode").value_or(kTriangles);
    if (mode > kFan) primitive.fail("has no known mode");
    const std::optional<std::uint64_t> indices = primitive.number("indices");
    const std::uint64_t key = indices.value_or(accessors_.size());
    if (!read_primitives_.emplace(*position, key, mode).second) return;  // as another mesh has it
    for (const GltfObject& target : primitive.items("targets")) {
      if (const auto delta = target.number("POSITION")) morphs_.insert(*delta);
    }
    if (const auto extensions = primitive.child("extensions")) {
      if (const auto draco = extensions->child("KHR_draco_mesh_compression")) {
        return read_draco(*draco);
      }
    }
    const Positions vertices = positions(*position);
    if (mode < kTriangles) return;  // points and lines move along
    read_corners(primitive, vertices, indices);
    add_triangles(mode);
  }

  // Reads the vertices of a primitive's corners.
  void read_corners(const GltfObject& primitive, const Positions& vertices,
                    const std::optional<std::uint64_t>& indices) {
    corners_.clear();
    if (!indices) {
      for (std::size_t i = 0; i < vertices.count; ++i) {
        corners_.push_back(static_cast<std::uint32_t>(vertices.first + i));
      }
      return;
    }
    const GltfObject& object = at(accessors_, "accessors", *indices);
    if (object.child("sparse")) object.refuse("indices with a sparse part");
    const GltfElements list = elements(*indices);
    if (!list.has_view || list.components != 1 ||
        (list.scalar != Scalar::UInt8 && list.scalar != Scalar::UInt16 &&
         list.scalar != Scalar::UInt32)) {
      object.fail("indices are unsigned bytes, shorts or integers");
    }
    if (list.count > image().size()) object.fail("reaches beyond its buffer view");
    switch (list.scalar) {
      case Scalar::UInt8:
        return take_corners<std::uint8_t>(primitive, vertices, list);
      case Scalar::UInt16:
        return take_corners<std::uint16_t>(primitive, vertices, list);
      default:
        return take_corners<std::uint32_t>(primitive, vertices, list);
    }
  }

  template <typename Index>
  void take_corners(const GltfObject& primitive, const Positions& vertices,
                    const GltfElements& list) {
    corners_.resize(list.count);
    const char* place = image().data() + list.place;
    for (std::uint64_t i = 0; i < list.count; ++i, place += list.stride) {
      Index index = 0;
      std::memcpy(&index, place, sizeof index);
      if (index >= vertices.count) {
        primitive.fail("index " + std::to_string(index) + " of " + std::to_string(vertices.count) +
                       " positions");
      }
      corners_[i] = static_cast<std::uint32_t>(vertices.first + index);
    }
  }

  void add_triangles(std::uint64_t mode) {
    Faces& faces = content_.faces;
    // Indices may serve several primitives, but not so often that the file no longer tells how much
    // memory its mesh takes.
    constexpr std::uint64_t kMostShared = 32;
    if (faces.corners.size() + 3 * corners_.size() > kMostShared * image().size()) {
      gltf_.refuse("more corners than a file of this size holds without sharing indices");
    }
    if (mode == kTriangles) {
      corners_.resize(corners_.size() / 3 * 3);
      std::size_t end = faces.corners.size();
      const std::size_t before = faces.ends.size();
      if (end == 0) {
        faces.corners.swap(corners_);
      } else {
        faces.corners.insert(faces.corners.end(), corners_.begin(), corners_.end());
      }
      faces.ends.resize(before + (faces.corners.size() - end) / 3);
      for (std::size_t face = before; face < faces.ends.size(); ++face) {
        faces.ends[face] = static_cast<std::uint32_t>(end += 3);
      }
      return;
    }
    for (std::size_t i = 2; i < corners_.size(); ++i) {
      const bool is_odd = mode == kStrip && i % 2 != 0;
      const std::uint32_t first = mode == kFan ? corners_[0] : corners_[i - (is_odd ? 1 : 2)];
      const std::uint32_t second = corners_[i - (is_odd ? 2 : 1)];
      faces.corners.insert(faces.corners.end(), {first, second, corners_[i]});
      faces.ends.push_back(static_cast<std::uint32_t>(faces.corners.size()));
    }
  }

  void read_draco(const GltfObject& draco) {
    const GltfView range = view(draco.needed_number("bufferView"));
    DracoMesh mesh;
    const std::uint64_t position = draco.needed_child("attributes").needed_number("POSITION");
    if (!decode_draco(image().subspan(range.place, range.size), position, mesh)) {
      draco.fail("cannot be decoded");
    }
    fix("its coordinates are compressed (KHR_draco_mesh_compression); decode them, for example "
        "with "
        "gltf-transform or Blender");
    const auto first = static_cast<std::uint32_t>(content_.vertices.size());
    content_.vertices.insert(content_.vertices.end(), mesh.points.begin(), mesh.points.end());
    content_.places.tokens.resize(content_.vertices.size());
    for (const Triangle& t : mesh.triangles) {
      content_.faces.corners.insert(content_.faces.corners.end(),
                                    {first + t[0], first + t[1], first + t[2]});
      content_.faces.ends.push_back(static_cast<std::uint32_t>(content_.faces.corners.size()));
    }
  }

  // A set of elements that something reads.
  struct Grid {
    GltfElements elements;
    std::uint64_t accessor = 0;
    bool has_positions = false;
  };

  // Positions are changed in place, so nothing else may be read from their bytes.
  void find_shared_bytes() {
    for (std::uint64_t index = 0; index < accessors_.size(); ++index) {
      if (read_positions_.contains(index) && !morphs_.contains(index)) continue;
      if (!accessors_[index].number("bufferView")) continue;
      const auto buffer_index =
          at(views_, "bufferViews", *accessors_[index].number("bufferView")).number("buffer");
      if (!buffer_index || !read_buffers_.contains(*buffer_index)) continue;
      const GltfElements other = elements(index);
      if (other.count > 0) grids_.push_back({other, index, false});
    }
    std::stable_sort(grids_.begin(), grids_.end(), [](const Grid& a, const Grid& b) {
      return a.elements.place < b.elements.place;
    });
    std::uint64_t compared = 0;
    constexpr std::uint64_t kMostCompared = 50'000'000;
    for (std::size_t i = 0; i < grids_.size(); ++i) {
      const std::uint64_t end = grids_[i].elements.end();
      for (std::size_t j = i + 1; j < grids_.size() && grids_[j].elements.place < end; ++j) {
        if (++compared > kMostCompared) gltf_.refuse("too many accessors share their bytes");
        if (!conflict(grids_[i], grids_[j])) continue;
        fix("accessors[" + std::to_string(grids_[i].accessor) + "] and accessors[" +
            std::to_string(grids_[j].accessor) + "] share bytes, so positions cannot move alone");
        return;
      }
    }
  }

  // Returns whether the bytes of positions in one grid have another meaning in the other. The
  // ranges of the two overlap, and the second does not begin before the first.
  static bool conflict(const Grid& a, const Grid& b) {
    if (!a.has_positions && !b.has_positions) return false;
    if (a.elements.stride != b.elements.stride) return true;
    const std::uint64_t phase = (b.elements.place - a.elements.place) % a.elements.stride;
    if (a.has_positions && b.has_positions && phase == 0) return false;  // the same points
    return phase < a.elements.size() || phase + b.elements.size() > a.elements.stride;
  }

  const Source& source_;
  GltfChunks chunks_;
  simdjson::dom::parser parser_;
  GltfObject gltf_;
  std::vector<GltfObject> buffers_, views_, accessors_;
  std::map<std::uint64_t, GltfView> read_buffers_, read_views_;
  std::map<std::filesystem::path, GltfView> other_files_;
  std::map<std::uint64_t, Positions> read_positions_;
  std::set<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t>> read_primitives_;
  std::set<std::uint64_t> morphs_;
  std::vector<Grid> grids_;
  std::vector<std::uint32_t> corners_;
  std::shared_ptr<GltfFile> file_ = std::make_shared<GltfFile>();
  FileContent content_;
};

}  // namespace

FileContent read_gltf(const Source& source) {
  return GltfReader(source).read();
}

}  // namespace triglyph
