// Stanford PLY, ASCII and binary, with elements and properties in any order and of any type. One
// walk over the rows serves both encodings; only the source of the next value differs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/base/error.h"
#include "engine/io/ply_header.h"
#include "engine/io/readers.h"
#include "engine/io/text_scan.h"

namespace triglyph {
namespace {

// Reads values from blank-separated text.
class TextPayload {
 public:
  TextPayload(const Source& source, const PlyHeader& header) : scan_(source) {
    scan_.move_to(source.bytes.data() + header.payload);
  }

  const char* start() {
    scan_.skip_space(false);
    return scan_.position();
  }
  double coordinate(Scalar) { return scan_.take_number(); }
  std::int64_t integer(Scalar) {
    (void)start();
    return scan_.take_integer("an integer", std::numeric_limits<std::int32_t>::min(),
                              std::numeric_limits<std::uint32_t>::max());
  }
  void skip(Scalar) {
    (void)start();
    if (scan_.take_token().empty()) fail("the file ends inside its elements");
  }
  void skip_many(Scalar scalar, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) skip(scalar);
  }
  bool skip_rows(const PlyElement&) { return false; }
  void expect_room(std::uint64_t count, std::size_t) {
    // A value takes at least a character and a blank, except the last, which needs no blank.
    if (count > (scan_.bytes_left() + 1) / 2) fail("the file ends inside its elements");
  }
  static std::size_t room(const PlyElement& element) { return element.properties.size(); }
  [[nodiscard]] TokenPlace place(const char* const start[3]) const {
    return place_of(scan_, start[0], start[1], start[2]);
  }
  [[noreturn]] void fail(const std::string& message) const { scan_.fail(message); }

 private:
  TextScan scan_;
};

// Reads values of fixed size in the byte order of the file.
class BinaryPayload {
 public:
  BinaryPayload(const Source& source, const PlyHeader& header)
      : source_(source),
        p_(source.bytes.data() + header.payload),
        end_(source.bytes.data() + source.bytes.size()),
        is_big_endian_(header.format == FileFormat::PlyBig) {}

  const char* start() const noexcept { return p_; }
  double coordinate(Scalar scalar) {
    const double value = take(scalar);
    if (std::isfinite(value)) return value;
    p_ -= size_of(scalar);
    fail("coordinate is not finite");
  }
  std::int64_t integer(Scalar scalar) { return static_cast<std::int64_t>(take(scalar)); }
  void skip(Scalar scalar) { skip_many(scalar, 1); }
  void skip_many(Scalar scalar, std::int64_t count) {
    expect_room(static_cast<std::uint64_t>(count), size_of(scalar));
    p_ += static_cast<std::uint64_t>(count) * size_of(scalar);
  }
  // Skips an element whose rows have one size. Returns false for others.
  bool skip_rows(const PlyElement& element) {
    if (element.has_lists()) return false;
    expect_room(element.rows, element.smallest_row());
    p_ += element.rows * element.smallest_row();
    return true;
  }
  void expect_room(std::uint64_t count, std::size_t size) {
    if (size != 0 && count > static_cast<std::uint64_t>(end_ - p_) / size) {
      fail("the file ends inside its elements");
    }
  }
  static std::size_t room(const PlyElement& element) { return element.smallest_row(); }
  [[nodiscard]] TokenPlace place(const char* const start[3]) const {
    const std::ptrdiff_t y = start[1] - start[0], z = start[2] - start[0];
    if (std::max(std::abs(y), std::abs(z)) > std::numeric_limits<std::int32_t>::max()) {
      fail("coordinates of one vertex lie more than 2 GiB apart");
    }
    return {static_cast<std::uint64_t>(start[0] - source_.bytes.data()),
            static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)};
  }
  [[nodiscard]] std::uint64_t offset() const {
    return static_cast<std::uint64_t>(p_ - source_.bytes.data());
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::Malformed, source_.path, at_byte(offset()), message);
  }

 private:
  double take(Scalar scalar) {
    expect_room(1, size_of(scalar));
    const double value = load(p_, scalar, is_big_endian_);
    p_ += size_of(scalar);
    return value;
  }

  const Source& source_;
  const char* p_;
  const char* end_;
  bool is_big_endian_;
};

template <typename Payload>
class PlyReader {
 public:
  PlyReader(const Source& source, const PlyHeader& header)
      : header_(header), payload_(source, header) {
    content_.format = header.format;
    content_.places.is_text = header.format == FileFormat::PlyAscii;
    content_.places.is_big_endian = header.format == FileFormat::PlyBig;
  }

  FileContent read() {
    find_vertex_element();
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;  // rows of zero bytes
      payload_.expect_room(element.rows, payload_.room(element));
      if (element.name == "vertex") {
        read_vertices(element);
      } else {
        read_rows(element);
      }
    }
    check_indices();
    return std::move(content_);
  }

 private:
  static constexpr bool kIsText = std::is_same_v<Payload, TextPayload>;
  enum class Use { None, Faces, Strips };

  void find_vertex_element() {
    const auto vertex = std::find_if(header_.elements.begin(), header_.elements.end(),
                                     [](const auto& e) { return e.name == "vertex"; });
    if (vertex == header_.elements.end()) payload_.fail("the header has no element vertex");
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      const auto& properties = vertex->properties;
      const auto found = std::find_if(properties.begin(), properties.end(),
                                      [&](const auto& p) { return p.name == name && !p.is_list; });
      if (found == properties.end()) payload_.fail("element vertex has no scalar " + name);
      axis_of_[axis] = static_cast<std::size_t>(found - properties.begin());
      content_.places.scalar[axis] = found->scalar;
    }
  }

  // Returns 0, 1, 2 for x, y, z and 3 for any other property.
  [[nodiscard]] int axis_at(std::size_t property) const {
    return static_cast<int>(std::find(axis_of_, axis_of_ + 3, property) - axis_of_);
  }

  void read_vertices(const PlyElement& element) {
    const bool has_equal_rows = !kIsText && !element.has_lists();
    if (has_equal_rows) set_row_places(element);
    content_.vertices.reserve(element.rows);
    if (!has_equal_rows) content_.places.tokens.reserve(element.rows);
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      const char* start[3] = {};
      Vec3 point;
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        const int axis = axis_at(i);
        if (axis < 3) {
          start[axis] = payload_.start();
          point[axis] = payload_.coordinate(property.scalar);
        } else {
          skip(property);
        }
      }
      content_.vertices.push_back(point);
      if (!has_equal_rows) content_.places.tokens.push_back(payload_.place(start));
    }
  }

  void set_row_places(const PlyElement& element) {
    RowPlaces& rows = content_.places.rows;
    if constexpr (!kIsText) rows.base = payload_.offset();
    rows.group_stride = element.smallest_row();
    std::uint64_t offset = 0;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (axis_at(i) < 3) rows.axis[axis_at(i)] = offset;
      offset += size_of(element.properties[i].scalar);
    }
  }

  void skip(const PlyProperty& property) {
    if (!property.is_list) return payload_.skip(property.scalar);
    payload_.skip_many(property.scalar, take_length(property));
  }

  std::int64_t take_length(const PlyProperty& property) {
    const std::int64_t length = payload_.integer(property.count);
    if (length < 0) payload_.fail("a list of " + std::to_string(length) + " values");
    payload_.expect_room(static_cast<std::uint64_t>(length),
                         kIsText ? 1 : size_of(property.scalar));
    return length;
  }

  [[nodiscard]] Use use_of(const PlyElement& element, const PlyProperty& property) const {
    if (!property.is_list) return Use::None;
    if (property.name != "vertex_indices" && property.name != "vertex_index") return Use::None;
    const Use use = element.name == "face"        ? Use::Faces
                    : element.name == "tristrips" ? Use::Strips
                                                  : Use::None;
    if (use != Use::None && !is_integer(property.scalar)) {
      payload_.fail("vertex indices must be integers");
    }
    return use;
  }

  void read_rows(const PlyElement& element) {
    if (payload_.skip_rows(element)) return;
    std::vector<Use> uses;
    for (const PlyProperty& property : element.properties)
      uses.push_back(use_of(element, property));
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      for (std::size_t i = 0; i < uses.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        switch (uses[i]) {
          case Use::None:
            skip(property);
            break;
          case Use::Faces:
            read_face(property);
            break;
          case Use::Strips:
            read_strip(property);
            break;
        }
      }
    }
  }

  // Accepts any index below the greatest vertex count, since the vertices may follow the faces.
  std::uint32_t as_index(std::int64_t index) {
    if (index < 0 || index >= static_cast<std::int64_t>(kMaxCount)) {
      payload_.fail("vertex index " + std::to_string(index) + " is out of range");
    }
    return static_cast<std::uint32_t>(index);
  }

  void read_face(const PlyProperty& property) {
    Faces& faces = content_.faces;
    const std::int64_t length = take_length(property);
    for (std::int64_t i = 0; i < length; ++i) {
      faces.corners.push_back(as_index(payload_.integer(property.scalar)));
    }
    faces.ends.push_back(static_cast<std::uint32_t>(faces.corners.size()));
  }

  // Reads triangle strips: every corner from the third on forms a triangle with the two before it,
  // with alternating orientation; -1 starts a new strip.
  void read_strip(const PlyProperty& property) {
    Faces& faces = content_.faces;
    const std::int64_t length = take_length(property);
    std::uint32_t before[2] = {};
    std::int64_t in_strip = 0;
    for (std::int64_t i = 0; i < length; ++i) {
      const std::int64_t value = payload_.integer(property.scalar);
      if (value == -1 || value == std::numeric_limits<std::uint32_t>::max()) {
        in_strip = 0;
        continue;
      }
      const std::uint32_t index = as_index(value);
      if (in_strip >= 2) {
        const bool is_odd = in_strip % 2 != 0;
        faces.corners.insert(faces.corners.end(),
                             {before[is_odd ? 1 : 0], before[is_odd ? 0 : 1], index});
        faces.ends.push_back(static_cast<std::uint32_t>(faces.corners.size()));
      }
      before[0] = before[1];
      before[1] = index;
      ++in_strip;
    }
  }

  void check_indices() {
    const auto& corners = content_.faces.corners;
    const auto largest = std::max_element(corners.begin(), corners.end());
    if (largest == corners.end() || *largest < content_.vertices.size()) return;
    const auto corner = static_cast<std::uint32_t>(
        std::find_if(corners.begin(), corners.end(),
                     [&](std::uint32_t c) { return c >= content_.vertices.size(); }) -
        corners.begin());
    const auto& ends = content_.faces.ends;
    const auto face = std::upper_bound(ends.begin(), ends.end(), corner) - ends.begin();
    payload_.fail("face " + std::to_string(face + 1) + " names vertex " +
                  std::to_string(corners[corner]) + " of " +
                  std::to_string(content_.vertices.size()));
  }

  const PlyHeader& header_;
  Payload payload_;
  std::size_t axis_of_[3] = {};
  FileContent content_;
};

}  // namespace

FileContent read_ply(const Source& source) {
  const PlyHeader header = read_ply_header(source);
  if (header.format == FileFormat::PlyAscii) return PlyReader<TextPayload>(source, header).read();
  return PlyReader<BinaryPayload>(source, header).read();
}

}  // namespace triglyph
