// Stereolithography (STL), ASCII and binary. The variants are distinguished by structure, because
// many binary files begin with the word "solid".
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.h"
#include "engine/io/readers.h"
#include "engine/io/text_scan.h"

namespace triglyph {
namespace {

constexpr std::size_t kHeader = 84;  // 80 bytes of text and the number of facets
constexpr std::size_t kFacet = 50;   // normal, three corners, 16 bits of attributes

bool is_word(std::string_view token, std::string_view word) {
  return std::equal(token.begin(), token.end(), word.begin(), word.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; });
}

void number_corners(FileContent& content) {
  const std::size_t corners = content.vertices.size();
  content.faces.corners.resize(corners);
  content.faces.ends.resize(corners / 3);
  for (std::size_t i = 0; i < corners; ++i) {
    content.faces.corners[i] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t f = 0; f < corners / 3; ++f) {
    content.faces.ends[f] = static_cast<std::uint32_t>(3 * f + 3);
  }
}

class AsciiReader {
 public:
  explicit AsciiReader(const Source& source) : scan_(source) {}

  FileContent read() {
    content_.format = FileFormat::StlAscii;
    expect("solid");
    scan_.skip_line();
    // Several solids follow each other; some writers leave out 'endsolid', or write "solid" twice.
    while (true) {
      scan_.skip_space(false);
      if (scan_.at_end()) break;
      const char* start = scan_.position();
      const std::string_view token = scan_.take_token();
      if (is_word(token, "facet")) {
        read_facet();
      } else if (is_word(token, "endsolid") || is_word(token, "end") || is_word(token, "solid") ||
                 is_word(token, "color")) {
        scan_.skip_line();  // a name, or a colour
      } else {
        scan_.move_to(start);
        scan_.fail_at("expected 'facet' or 'endsolid'");
      }
    }
    if (content_.vertices.size() <= kMaxCount) number_corners(content_);
    return std::move(content_);
  }

 private:
  void expect(std::string_view word) {
    scan_.skip_space(false);
    const char* start = scan_.position();
    if (is_word(scan_.take_token(), word)) return;
    scan_.move_to(start);
    scan_.fail_at("expected '" + std::string(word) + "'");
  }

  void read_facet() {
    expect("normal");
    // Normals are not used, so a "nan" of a degenerate facet is accepted.
    for (int axis = 0; axis < 3; ++axis) {
      scan_.skip_space(false);
      (void)scan_.take_token();
    }
    expect("outer");
    expect("loop");
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      read_corner();
    }
    expect_end("loop");
    expect_end("facet");
  }

  // Takes "endloop" and also "end loop".
  void expect_end(std::string_view what) {
    scan_.skip_space(false);
    const char* start = scan_.position();
    const std::string_view token = scan_.take_token();
    if (is_word(token, "end")) return expect(what);
    if (is_word(token, "end" + std::string(what))) return;
    scan_.move_to(start);
    scan_.fail_at("expected 'end" + std::string(what) + "'");
  }

  void read_corner() {
    const char* start[3];
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
      scan_.skip_space(false);
      start[axis] = scan_.position();
      point[axis] = scan_.take_number();
    }
    content_.vertices.push_back(point);
    content_.places.tokens.push_back(place_of(scan_, start[0], start[1], start[2]));
  }

  TextScan scan_;
  FileContent content_;
};

FileContent read_binary(const Source& source, std::uint64_t facets) {
  FileContent content;
  content.format = FileFormat::StlBinary;
  content.places.is_text = false;
  content.places.scalar = {Scalar::Float32, Scalar::Float32, Scalar::Float32};
  content.places.rows = {kHeader + 12, 3, kFacet, 12, {0, 4, 8}};
  if (facets * 3 > kMaxCount) {
    throw Error(ErrorCode::Unsupported, source.path, at_byte(80),
                std::to_string(facets) + " facets are more than 32 bits can number");
  }
  content.vertices.resize(facets * 3);
  for (std::size_t v = 0; v < content.vertices.size(); ++v) {
    const std::uint64_t place = content.places.offset(v, 0);
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t at = place + 4 * static_cast<std::uint64_t>(axis);
      const double value = load(source.bytes.data() + at, Scalar::Float32, false);
      if (!std::isfinite(value)) {
        throw Error(ErrorCode::Malformed, source.path, at_byte(at), "coordinate is not finite");
      }
      content.vertices[v][axis] = value;
    }
  }
  number_corners(content);
  return content;
}

// Returns whether the bytes begin with "solid" and are text as far as the first facets reach, or
// the end of an empty solid. A binary file may begin with "solid", but holds bytes that text has
// not: the count of its facets alone has a zero byte, unless it is above 16 million.
bool looks_like_text(const Source& source) {
  constexpr std::size_t kLooked = 1024;
  const std::string_view start(source.bytes.data(), std::min(source.bytes.size(), kLooked));
  const auto is_control = [](char c) {
    return static_cast<unsigned char>(c) < 32 && (c < '\t' || c > '\r');
  };
  if (std::any_of(start.begin(), start.end(), is_control)) return false;
  TextScan scan(source);
  scan.skip_space(false);
  return is_word(scan.take_token(), "solid");
}

// Returns the number of facets behind the header. The count is wrong in some files: it may have
// been left at zero, set to the largest number by a writer that did not know it, or stem from a
// part of the facets. Facets that it leaves out are part of the surface, as other tools read them,
// as long as nothing but whole facets of finite coordinates is left.
std::uint64_t facets_of(const Source& source, std::uint64_t claimed) {
  const std::uint64_t room = (source.bytes.size() - kHeader) / kFacet;
  const bool is_whole = (source.bytes.size() - kHeader) % kFacet == 0;
  if (claimed == 0xffffffff && is_whole) return room;
  if (claimed >= room || !is_whole) return claimed;
  for (std::uint64_t facet = claimed; facet < room; ++facet) {
    const std::uint64_t corners = kHeader + facet * kFacet + 12;
    for (std::uint64_t i = 0; i < 9; ++i) {
      const char* number = source.bytes.data() + corners + 4 * i;
      if (!std::isfinite(load(number, Scalar::Float32, false))) return claimed;
    }
  }
  return room;
}

}  // namespace

FileContent read_stl(const Source& source) {
  const std::size_t size = source.bytes.size();
  if (looks_like_text(source)) return AsciiReader(source).read();
  if (size < kHeader) {
    throw Error(ErrorCode::Malformed, source.path, at_byte(size),
                "neither an ascii STL ('solid', then 'facet') nor the 84 bytes of a binary one");
  }
  const std::uint64_t facets = facets_of(
      source, static_cast<std::uint64_t>(load(source.bytes.data() + 80, Scalar::UInt32, false)));
  if (size < kHeader + kFacet * facets) {
    throw Error(ErrorCode::Malformed, source.path, at_byte(size),
                "the file ends inside the " + std::to_string(facets) + " facets it announces");
  }
  return read_binary(source, facets);
}

}  // namespace triglyph
