// Wavefront OBJ. Reads `v` and `f` lines; skips all others, which stay in the file.
#include <algorithm>
#include <cstring>
#include <limits>

#include "engine/base/error.h"
#include "engine/io/readers.h"
#include "engine/io/text_scan.h"

namespace triglyph {
namespace {

class ObjReader {
 public:
  ObjReader(const Source& source, std::uint64_t index_limit)
      : scan_(source), index_limit_(index_limit) {}

  FileContent read() {
    reserve();
    while (!scan_.at_end()) {
      skip_blanks();
      if (scan_.at_end()) break;
      const char keyword = scan_.here();
      if ((keyword == 'v' || keyword == 'f') && stands_alone(scan_.position() + 1)) {
        scan_.move_to(scan_.position() + 1);
        keyword == 'v' ? read_vertex() : read_face();
      }
      skip_line();
    }
    if (content_.vertices.empty()) scan_.fail("no vertex ('v x y z') in the whole file");
    return std::move(content_);
  }

  [[nodiscard]] std::uint64_t largest_index() const noexcept { return largest_index_; }

 private:
  // Reserves by the length of common lines; reserved memory that stays unused is never touched.
  void reserve() {
    const std::size_t bytes = scan_.bytes_left();
    content_.vertices.reserve(bytes / 64 + 1);
    content_.places.tokens.reserve(bytes / 64 + 1);
    content_.faces.corners.reserve(bytes / 12 + 1);
    content_.faces.ends.reserve(bytes / 36 + 1);
  }

  [[nodiscard]] bool stands_alone(const char* next) const noexcept {
    return next == scan_.end() || scan_.is_separator(*next);
  }

  // Returns the position behind a backslash that joins this line with the next, which counts as
  // blank.
  [[nodiscard]] const char* behind_continuation(const char* p) const noexcept {
    return *p == '\\' ? scan_.behind_line_end(p + 1) : nullptr;
  }

  void skip_blanks() noexcept {
    scan_.skip_blanks();
    while (!scan_.at_end() && scan_.here() == '\\') {
      const char* next = behind_continuation(scan_.position());
      if (next == nullptr) return;
      scan_.move_to(next);
      scan_.skip_blanks();
    }
  }

  void skip_line() noexcept {
    while (true) {
      const char* begin = scan_.position();
      scan_.skip_line();
      const char* last = scan_.position();
      while (last > begin && TextScan::is_line_end(last[-1])) --last;
      if (last == scan_.position() || last == begin || last[-1] != '\\') return;
      // Comments are not continued: some end with a Windows path.
      if (std::memchr(begin, '#', static_cast<std::size_t>(last - begin)) != nullptr) return;
    }
  }

  void read_vertex() {
    const char* start[3];
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      skip_blanks();
      start[axis] = scan_.position();
      point[axis] = scan_.take_number();
    }
    content_.vertices.push_back(point);
    content_.places.tokens.push_back(place_of(scan_, start[0], start[1], start[2]));
  }

  void read_face() {
    Faces& faces = content_.faces;
    const std::size_t first = faces.corners.size();
    const char* line = scan_.position();
    while (true) {
      skip_blanks();
      if (scan_.at_line_end() || scan_.here() == '#') break;
      faces.corners.push_back(take_corner());
    }
    const std::size_t corners = faces.corners.size() - first;
    if (corners == 0) {
      scan_.move_to(line);
      scan_.fail("a face without corners");
    }
    if (corners < 3)
      return faces.corners.resize(first);          // a point or a line, which other tools read
    if (faces.corners.size() > kMaxCount) return;  // refused at the end
    faces.ends.push_back(static_cast<std::uint32_t>(faces.corners.size()));
  }

  // Reads i, i/j, i//k or i/j/k, and ignores j and k. Returns the vertex, numbered from 0.
  std::uint32_t take_corner() {
    const char* p = scan_.position();
    const char* end = scan_.end();
    const bool is_relative = *p == '-';
    if (*p == '-' || *p == '+') ++p;
    const char* digits = p;
    std::uint64_t index = 0;
    for (; p != end && *p >= '0' && *p <= '9'; ++p) {
      index = std::min<std::uint64_t>(index * 10 + static_cast<unsigned>(*p - '0'), kMaxCount + 1);
    }
    if (p == digits) scan_.fail_at("expected the index of a face's corner");
    for (int part = 0; part < 2 && p != end && *p == '/'; ++part) {
      ++p;
      if (p != end && (*p == '-' || *p == '+')) ++p;
      while (p != end && *p >= '0' && *p <= '9') ++p;
    }
    if (p != end && !scan_.is_separator(*p)) scan_.fail_at("expected i, i/j, i//k or i/j/k");
    const std::uint64_t count = content_.vertices.size();
    if (index == 0) scan_.fail_at("vertex indices start at 1");
    if (is_relative) {
      if (index > count) fail_range(count);
      index = count - index + 1;
    }
    if (index > index_limit_) fail_range(index_limit_);
    largest_index_ = std::max(largest_index_, index);
    scan_.move_to(p);
    return static_cast<std::uint32_t>(index - 1);
  }

  [[noreturn]] void fail_range(std::uint64_t count) const {
    scan_.fail_at("index of a vertex that is not among the " + std::to_string(count) +
                  " of the file");
  }

  TextScan scan_;
  std::uint64_t index_limit_;
  std::uint64_t largest_index_ = 0;
  FileContent content_;
};

}  // namespace

FileContent read_obj(const Source& source) {
  ObjReader reader(source, kMaxCount);
  FileContent content = reader.read();
  if (reader.largest_index() > content.vertices.size()) {
    // A face may precede its vertices, so only a second pass can name the line.
    return ObjReader(source, content.vertices.size()).read();
  }
  return content;
}

}  // namespace triglyph
