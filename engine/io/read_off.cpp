// Object File Format (OFF) of Geomview, text only. The coordinates of a vertex and the corners of a
// face may take several lines; what follows them on their last line is of a variant (colours,
// normals, texture coordinates) and stays as it is.
#include <algorithm>
#include <string>
#include <string_view>

#include "engine/base/error.h"
#include "engine/io/readers.h"
#include "engine/io/text_scan.h"

namespace triglyph {
namespace {

class OffReader {
 public:
  explicit OffReader(const Source& source) : source_(source), scan_(source) {}

  FileContent read() {
    content_.format = FileFormat::Off;
    read_keyword();
    constexpr std::int64_t kAny = std::int64_t{1} << 53;
    scan_.skip_space(true);
    const std::int64_t vertices = scan_.take_integer("the number of vertices", 0, kAny);
    scan_.skip_space(true);
    const std::int64_t faces = scan_.take_integer("the number of faces", 0, kAny);
    scan_.skip_blanks();
    if (!scan_.at_line_end() && scan_.here() != '#') {
      // The number of edges: often wrong, never needed.
      (void)scan_.take_integer("the number of edges", -kAny, kAny);
    }
    end_row();
    content_.vertices.reserve(bounded(vertices, 6));
    content_.places.tokens.reserve(bounded(vertices, 6));
    for (std::int64_t i = 0; i < vertices; ++i) read_vertex(i, vertices);
    content_.faces.ends.reserve(bounded(faces, 2));
    for (std::int64_t i = 0; i < faces; ++i) read_face(i, faces);
    return std::move(content_);
  }

 private:
  // Returns the count, limited to the rows that the remaining bytes can hold.
  [[nodiscard]] std::size_t bounded(std::int64_t count, std::size_t smallest_row) const {
    return std::min(static_cast<std::size_t>(count), scan_.bytes_left() / smallest_row + 1);
  }

  void read_keyword() {
    scan_.skip_space(true);
    const char* start = scan_.position();
    if (scan_.at_end()) scan_.fail("neither the keyword OFF nor counts");
    std::string_view keyword = scan_.take_token();
    const std::size_t off = find_off(keyword);
    if (off == std::string_view::npos) {
      scan_.move_to(start);
      // Without a keyword the file starts with its counts.
      if ((*start >= '0' && *start <= '9') || *start == '-' || *start == '+') return;
      scan_.fail_at("expected the keyword OFF");
    }
    std::string_view prefixes = keyword.substr(0, off);
    while (!prefixes.empty()) {
      const bool is_texture = prefixes.starts_with("ST") || prefixes.starts_with("st");
      const char c = prefixes[0];
      if (c == '4') refuse("homogeneous coordinates (4OFF)");
      // Lower case means another dimension only where the keyword itself is in capitals.
      if (c == 'n' && keyword[off] == 'O') refuse("points of any dimension (nOFF)");
      if (!is_texture && c != 'C' && c != 'N' && c != 'c' && c != 'n') {
        scan_.move_to(start);
        scan_.fail_at("expected the keyword OFF");
      }
      prefixes.remove_prefix(is_texture ? 2 : 1);
    }
    // Counts or a comment may follow without a blank.
    scan_.move_to(keyword.data() + off + 3);
    scan_.skip_blanks();
    const char* next = scan_.position();
    if (scan_.take_token() == "BINARY") refuse("OFF BINARY");
    scan_.move_to(next);
  }

  // Returns where the letters "OFF" or "off" stand in the keyword, behind its prefixes in any
  // order.
  static std::size_t find_off(std::string_view keyword) {
    const std::size_t at = std::min(keyword.find("OFF"), keyword.find("off"));
    if (at > 6) return std::string_view::npos;  // further than all prefixes take
    const std::string_view rest = keyword.substr(at + 3);
    const bool ends = rest.empty() || rest[0] == '#' || (rest[0] >= '0' && rest[0] <= '9');
    return ends ? at : std::string_view::npos;
  }

  [[noreturn]] void refuse(const std::string& variant) const {
    throw Error(ErrorCode::Unsupported, source_.path, at_line(1), variant + " is not handled");
  }

  void start_row(const char* what, std::int64_t row, std::int64_t rows) {
    scan_.skip_space(true);
    if (!scan_.at_end()) return;
    scan_.fail("the file ends at " + std::string(what) + " " + std::to_string(row + 1) + " of " +
               std::to_string(rows));
  }

  void end_row() { scan_.skip_line(); }

  void read_vertex(std::int64_t row, std::int64_t rows) {
    start_row("vertex", row, rows);
    const char* start[3];
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      scan_.skip_space(true);
      start[axis] = scan_.position();
      point[axis] = scan_.take_number();
    }
    content_.vertices.push_back(point);
    content_.places.tokens.push_back(place_of(scan_, start[0], start[1], start[2]));
    end_row();
  }

  void read_face(std::int64_t row, std::int64_t rows) {
    start_row("face", row, rows);
    Faces& faces = content_.faces;
    const auto vertices = static_cast<std::int64_t>(content_.vertices.size());
    const std::int64_t corners = scan_.take_integer("the number of corners", 0, kMaxCount);
    for (std::int64_t i = 0; i < corners; ++i) {
      scan_.skip_space(true);
      faces.corners.push_back(
          static_cast<std::uint32_t>(scan_.take_integer("a vertex index", 0, vertices - 1)));
    }
    faces.ends.push_back(static_cast<std::uint32_t>(faces.corners.size()));
    end_row();
  }

  const Source& source_;
  TextScan scan_;
  FileContent content_;
};

}  // namespace

FileContent read_off(const Source& source) {
  return OffReader(source).read();
}

}  // namespace triglyph
