#include "engine/io/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/base/error.h"
#include "engine/io/number_text.h"

namespace triglyph {
namespace {

std::optional<Scalar> scalar_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Scalar>, 16> kNames = {{
      {"char", Scalar::Int8},
      {"int8", Scalar::Int8},
      {"uchar", Scalar::UInt8},
      {"uint8", Scalar::UInt8},
      {"short", Scalar::Int16},
      {"int16", Scalar::Int16},
      {"ushort", Scalar::UInt16},
      {"uint16", Scalar::UInt16},
      {"int", Scalar::Int32},
      {"int32", Scalar::Int32},
      {"uint", Scalar::UInt32},
      {"uint32", Scalar::UInt32},
      {"float", Scalar::Float32},
      {"float32", Scalar::Float32},
      {"double", Scalar::Float64},
      {"float64", Scalar::Float64},
  }};
  for (const auto& [known, scalar] : kNames) {
    if (known == name) return scalar;
  }
  return std::nullopt;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlanks = " \t\r\v\f";
  std::size_t begin = line.find_first_not_of(kBlanks);
  while (begin != std::string_view::npos && words.size() < 8) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::string quoted(std::string_view text) {
  return show_token(text.data(), text.data() + text.size());
}

class HeaderReader {
 public:
  explicit HeaderReader(const Source& source) : source_(source) {}

  PlyHeader read() {
    const auto magic = next_line();
    if (magic.size() != 1 || magic[0] != "ply") fail("does not start with 'ply'");
    while (true) {
      const auto words = next_line();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        read_format(words);
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      }
      // Other lines are skipped: some exporters omit the word "comment".
    }
    if (!has_format_) fail("the header names no format");
    header_.payload = at_;
    return std::move(header_);
  }

 private:
  std::vector<std::string_view> next_line() {
    ++line_;
    const std::string_view text(source_.bytes.data(), source_.bytes.size());
    if (line_ == 1) learn_line_end(text);
    const std::size_t end = text.find(line_end_, at_);
    const std::string_view line = text.substr(at_, end - at_);
    auto words = split(line);
    if (end == std::string_view::npos) {
      const bool is_last = !words.empty() && words[0] == "end_header";
      if (!is_last) fail("the header has no end_header");
    }
    at_ = std::min(end, text.size() - 1) + 1;
    return words;
  }

  // Takes a carriage return as the line end where no line feed follows the first one. Whether
  // binary data begin behind one or two bytes is then certain, whatever value its first byte has.
  void learn_line_end(std::string_view text) {
    const std::size_t first = text.find_first_of("\r\n");
    if (first == std::string_view::npos || text[first] == '\n') return;
    if (first + 1 < text.size() && text[first + 1] != '\n') line_end_ = '\r';
  }

  void read_format(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("expected 'format KIND VERSION'");
    if (words[1] == "ascii") {
      header_.format = FileFormat::PlyAscii;
    } else if (words[1] == "binary_little_endian") {
      header_.format = FileFormat::PlyLittle;
    } else if (words[1] == "binary_big_endian") {
      header_.format = FileFormat::PlyBig;
    } else {
      fail("unknown format " + quoted(words[1]));
    }
    if (words[2] != "1.0") {
      throw Error(ErrorCode::Unsupported, source_.path, at_line(line_),
                  "PLY version " + quoted(words[2]));
    }
    has_format_ = true;
  }

  void read_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("expected 'element NAME COUNT'");
    PlyElement element;
    element.name = words[1];
    const char* end = words[2].data() + words[2].size();
    const auto result = std::from_chars(words[2].data(), end, element.rows);
    if (result.ec != std::errc{} || result.ptr != end) {
      fail("expected the number of rows, found " + quoted(words[2]));
    }
    const bool is_known = std::any_of(header_.elements.begin(), header_.elements.end(),
                                      [&](const auto& e) { return e.name == element.name; });
    if (is_known) fail("a second element " + quoted(words[1]));
    header_.elements.push_back(std::move(element));
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("property before the first element");
    PlyProperty property;
    property.is_list = words.size() == 5 && words[1] == "list";
    if (!property.is_list && words.size() != 3) {
      fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    }
    if (property.is_list) {
      property.count = type(words[2]);
      if (!is_integer(property.count)) fail("the length of a list must be an integer");
    }
    property.scalar = type(words[words.size() - 2]);
    property.name = words.back();
    auto& properties = header_.elements.back().properties;
    const bool is_known = std::any_of(properties.begin(), properties.end(),
                                      [&](const auto& p) { return p.name == property.name; });
    if (is_known) fail("a second property " + quoted(words.back()));
    properties.push_back(std::move(property));
  }

  [[nodiscard]] Scalar type(std::string_view name) const {
    const auto scalar = scalar_named(name);
    if (!scalar) fail("unknown type " + quoted(name));
    return *scalar;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::Malformed, source_.path, at_line(line_), message);
  }

  const Source& source_;
  PlyHeader header_;
  std::size_t at_ = 0;
  std::size_t line_ = 0;
  char line_end_ = '\n';
  bool has_format_ = false;
};

}  // namespace

std::size_t PlyElement::smallest_row() const noexcept {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += size_of(p.is_list ? p.count : p.scalar);
  return bytes;
}

bool PlyElement::has_lists() const noexcept {
  return std::any_of(properties.begin(), properties.end(), [](const auto& p) { return p.is_list; });
}

PlyHeader read_ply_header(const Source& source) {
  return HeaderReader(source).read();
}

}  // namespace triglyph
