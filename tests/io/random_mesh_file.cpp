#include "tests/io/random_mesh_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace triglyph::test {
namespace {

constexpr const char* kTypeNames[5][2] = {
    {"", ""}, {"short", "int16"}, {"int", "int32"}, {"float", "float32"}, {"double", "float64"}};
constexpr std::size_t kTypeSizes[5] = {0, 2, 4, 4, 8};

class Writer {
 public:
  Writer(Kind kind, std::uint64_t seed) : random_(seed * 8 + static_cast<unsigned>(kind)) {
    file_.is_text = kind != Kind::PlyLittle && kind != Kind::PlyBig && kind != Kind::StlBinary;
    file_.is_big_endian = kind == Kind::PlyBig;
    number_style_ = below(6);
    const std::size_t distinct = 3 + below(20);
    for (std::size_t i = 0; i < distinct; ++i) pool_.push_back({number(), number(), number()});
    switch (kind) {
      case Kind::Obj:
        write_obj();
        break;
      case Kind::Off:
        write_off();
        break;
      case Kind::StlAscii:
        write_stl_ascii();
        break;
      case Kind::StlBinary:
        write_stl_binary();
        break;
      default:
        write_ply(kind);
    }
    for (const auto& span : file_.spans) {
      std::array<double, 3> value{};
      for (std::size_t a = 0; a < 3; ++a) {
        const NumberKind decoded_as = file_.is_text ? NumberKind::Text : file_.kind[a];
        value[a] = decode(file_.bytes, span[a], decoded_as, file_.is_big_endian);
      }
      file_.values.push_back(value);
    }
  }

  RandomMeshFile take() { return std::move(file_); }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }
  bool one_in(std::size_t n) { return below(n) == 0; }
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double number() {
    if (one_in(12)) return one_in(2) ? 0.0 : -0.0;
    const double scale = std::pow(10.0, static_cast<double>(below(4)) - 1);
    return (unit() - 0.5) * scale;
  }
  template <typename T>
  const T& pick(const std::vector<T>& from) {
    return from[below(from.size())];
  }

  std::string number_text(double v) {
    char text[64];
    const char* format = "%.6f";
    switch (number_style_) {
      case 0:
        break;
      case 1:
        format = "%g";
        break;
      case 2:
        format = "%.3f";
        break;
      case 3:
        format = "%.17g";
        break;
      case 4:
        format = one_in(2) ? "%.4e" : "%.4E";
        break;
      default: {
        const char* const mixed[] = {"%+.2f", "%.0f", "%.5g", "%.2e", "%#.0f", "%.12f"};
        format = mixed[below(6)];
      }
    }
    std::snprintf(text, sizeof text, format, v);
    std::string token = text;
    if (number_style_ == 5 && token.size() > 2 && token.starts_with("0.")) token.erase(0, 1);
    return token;
  }

  void put(const std::string& text) { file_.bytes += text; }
  std::string blanks() {
    if (!one_in(5)) return " ";
    return one_in(2) ? "\t" : "   ";
  }
  std::string line_end() const { return eol_; }

  // Three number tokens; `between` separates them. Extra bytes must not touch the numbers.
  void put_coordinates(const std::array<double, 3>& point, bool continued) {
    std::array<ByteSpan, 3> spans;
    for (std::size_t a = 0; a < 3; ++a) {
      if (a > 0) put(continued && one_in(10) ? " \\" + eol_ + " " : blanks());
      const std::string token = number_text(point[a]);
      spans[a] = {file_.bytes.size(), token.size()};
      put(token);
    }
    file_.spans.push_back(spans);
  }

  std::vector<std::uint32_t> random_face(std::size_t vertices) {
    const std::size_t corners = one_in(3) ? 4 + below(4) : 3;
    std::vector<std::uint32_t> face;
    for (std::size_t i = 0; i < corners; ++i) {
      face.push_back(static_cast<std::uint32_t>(below(vertices)));
    }
    return face;
  }

  void put_obj_noise() {
    switch (below(9)) {
      case 0:
        put("# v 9 9 9 and a path C:\\" + eol_);
        break;
      case 1:
        put("vt 0.25 0.75" + eol_);
        break;
      case 2:
        put("vn 0 0 1" + eol_);
        break;
      case 3:
        put("g some group" + eol_);
        break;
      case 4:
        put("usemtl Stone v 1 2 3" + eol_);
        break;
      case 5:
        put("mtllib ../../no/such.mtl" + eol_);
        break;
      case 6:
        put(eol_);
        break;
      case 7:
        put("l 1 2 \\" + eol_ + " 3" + eol_);
        break;
      default:
        put("vp 0.5 0.5" + eol_);
    }
  }

  void put_obj_face(std::size_t total) {
    const std::size_t written = file_.spans.size();
    auto face = random_face(total);
    if (one_in(4)) put("  ");
    put("f");
    const std::size_t style = below(4);
    for (const std::uint32_t corner : face) {
      put(one_in(12) ? " \\" + eol_ + "\t" : blanks());
      const bool is_relative = one_in(3) && corner < written;
      put(is_relative ? "-" + std::to_string(written - corner) : std::to_string(corner + 1));
      put(style == 0 ? "" : style == 1 ? "/1" : style == 2 ? "//2" : "/-1/3");
    }
    if (one_in(6)) put(" # 7 8");
    put(one_in(8) ? " " + eol_ : eol_);
    file_.faces.push_back(std::move(face));
  }

  void write_obj() {
    file_.name = one_in(3) ? "random.OBJ" : "random.obj";
    eol_ = one_in(3) ? "\r\n" : one_in(9) ? "\r" : "\n";
    if (one_in(9)) put("\xEF\xBB\xBF");
    const std::size_t vertices = 3 + below(40), faces = below(60);
    while (file_.spans.size() < vertices || file_.faces.size() < faces) {
      const std::size_t what = below(8);
      if (what == 0) {
        put_obj_noise();
      } else if (file_.spans.size() < vertices && (what < 5 || file_.faces.size() >= faces)) {
        if (one_in(6)) put(" \t");
        put("v" + blanks());
        put_coordinates(pick(pool_), true);
        if (one_in(4)) put(" 1.0");
        if (one_in(4)) put(" 0.1 0.2 0.3");
        if (one_in(9)) put("# note");
        put(eol_);
      } else if (file_.faces.size() < faces) {
        put_obj_face(vertices);
      }
    }
    if (one_in(4)) file_.bytes.erase(file_.bytes.size() - eol_.size());
  }

  void write_off() {
    file_.name = "random.off";
    eol_ = one_in(3) ? "\r\n" : "\n";
    const std::size_t vertices = 1 + below(40), faces = below(40);
    const char* const keywords[] = {"", "OFF", "COFF", "NOFF", "STOFF", "CNOFF", "STCNOFF"};
    const std::string keyword = keywords[below(7)];
    const std::string extra = keyword.size() > 3 ? " 0.5 0.25 1 0" : "";
    if (one_in(4)) put("# a comment 3 4 5" + eol_);
    put(keyword);
    if (!keyword.empty()) put(one_in(3) ? " " : one_in(3) ? " # c" + eol_ + eol_ : eol_);
    put(std::to_string(vertices) + " " + std::to_string(faces) + (one_in(5) ? "" : " 0") + eol_);
    for (std::size_t i = 0; i < vertices; ++i) {
      if (one_in(8)) put(one_in(2) ? eol_ : " # 1 2 3" + eol_);
      if (one_in(8)) put("  ");
      put_coordinates(pick(pool_), false);
      put(extra + (one_in(8) ? " #x" : "") + eol_);
    }
    for (std::size_t i = 0; i < faces; ++i) {
      auto face = random_face(vertices);
      put(std::to_string(face.size()));
      for (const std::uint32_t corner : face) put(blanks() + std::to_string(corner));
      if (one_in(3)) put(" 255 0 0");
      put(eol_);
      file_.faces.push_back(std::move(face));
    }
  }

  void put_integer(std::int64_t value, std::size_t size) {
    if (file_.is_text) return put(std::to_string(value) + blanks());
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t shift = 8 * (file_.is_big_endian ? size - 1 - i : i);
      file_.bytes += static_cast<char>((static_cast<std::uint64_t>(value) >> shift) & 0xff);
    }
  }

  ByteSpan put_coordinate(double value, NumberKind kind) {
    const std::size_t begin = file_.bytes.size();
    if (kind == NumberKind::Int16 || kind == NumberKind::Int32) {
      const auto whole = static_cast<std::int64_t>(value * 100);
      if (!file_.is_text) {
        put_integer(whole, kTypeSizes[static_cast<int>(kind)]);
      } else {
        put(std::to_string(whole));
      }
    } else if (file_.is_text) {
      put(number_text(value));
    } else {
      std::uint64_t bits = 0;
      const auto single = static_cast<float>(value);
      kind == NumberKind::Float32 ? std::memcpy(&bits, &single, 4) : std::memcpy(&bits, &value, 8);
      put_integer(static_cast<std::int64_t>(bits), kTypeSizes[static_cast<int>(kind)]);
    }
    const ByteSpan span{begin, file_.bytes.size() - begin};
    if (file_.is_text) put(blanks());
    return span;
  }

  void write_ply_vertices(const std::string& order, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto& point = pick(pool_);
      std::array<ByteSpan, 3> spans;
      for (const char property : order) {
        if (property == 'c') put_integer(static_cast<std::int64_t>(below(256)), 1);
        if (property == 'l') {
          const std::size_t length = below(4);
          put_integer(static_cast<std::int64_t>(length), 1);
          for (std::size_t k = 0; k < length; ++k) put_integer(7, 2);
        }
        if (property >= 'x') {
          const auto axis = static_cast<std::size_t>(property - 'x');
          spans[axis] = put_coordinate(point[axis], file_.kind[axis]);
        }
      }
      file_.spans.push_back(spans);
      if (file_.is_text) put(eol_);
    }
  }

  void write_ply_faces(std::size_t count, std::size_t vertices, std::size_t length_size,
                       std::size_t index_size, bool has_flags) {
    for (std::size_t i = 0; i < count; ++i) {
      auto face = random_face(vertices);
      if (has_flags) put_integer(1, 1);
      put_integer(static_cast<std::int64_t>(face.size()), length_size);
      for (const std::uint32_t corner : face) put_integer(corner, index_size);
      if (file_.is_text) put(eol_);
      file_.faces.push_back(std::move(face));
    }
  }

  void write_ply(Kind kind) {
    file_.name = "random.ply";
    eol_ = one_in(3) ? "\r\n" : "\n";
    const std::size_t vertices = 1 + below(40), faces = below(40), others = below(4);
    const std::size_t same_kind = 1 + below(4);
    for (auto& k : file_.kind) k = static_cast<NumberKind>(one_in(6) ? 1 + below(4) : same_kind);
    const auto types = file_.kind;
    std::string order = one_in(3) ? "zcxly" : one_in(2) ? "xyzcc" : "xyz";
    if (one_in(3)) std::shuffle(order.begin(), order.end(), random_);
    const bool has_flags = one_in(3), has_wide = one_in(2);
    std::string sections = "vfo";
    std::shuffle(sections.begin(), sections.end(), random_);
    put("ply" + eol_ + "format ");
    put(kind == Kind::PlyAscii    ? "ascii"
        : kind == Kind::PlyLittle ? "binary_little_endian"
                                  : "binary_big_endian");
    put(" 1.0" + eol_ + "comment element vertex 9" + eol_);
    if (one_in(3)) put("obj_info property float x" + eol_);
    for (const char section : sections) {
      if (section == 'v') {
        put("element vertex " + std::to_string(vertices) + eol_);
        int extra = 0;
        for (const char property : order) {
          const std::string id = std::to_string(extra++);
          if (property == 'c') put("property uchar c" + id + eol_);
          if (property == 'l') put("property list uint8 ushort l" + id + eol_);
          if (property < 'x') continue;
          const int type = static_cast<int>(types[static_cast<std::size_t>(property - 'x')]);
          put(std::string("property ") + kTypeNames[type][below(2)] + " " + property + eol_);
        }
      } else if (section == 'f') {
        put("element face " + std::to_string(faces) + eol_);
        if (has_flags) put("property uchar flags" + eol_);
        put(has_wide ? "property list uint int " : "property list uchar ushort ");
        put((one_in(2) ? "vertex_indices" : "vertex_index") + eol_);
      } else {
        put("element other " + std::to_string(others) + eol_ + "property list char short x" + eol_);
      }
    }
    put("end_header" + eol_);
    for (const char section : sections) {
      if (section == 'v') write_ply_vertices(order, vertices);
      if (section == 'f')
        write_ply_faces(faces, vertices, has_wide ? 4 : 1, has_wide ? 4 : 2, has_flags);
      if (section == 'o') {
        for (std::size_t i = 0; i < others; ++i) {
          put_integer(2, 1);
          put_integer(-3, 2);
          put_integer(4, 2);
        }
      }
    }
    if (one_in(4)) put("trailing bytes");
  }

  void write_stl_ascii() {
    file_.name = one_in(2) ? "random.stl" : "random.STL";
    eol_ = one_in(3) ? "\r\n" : "\n";
    const bool is_upper = one_in(4);
    const auto word = [&](std::string text) {
      if (is_upper) {
        for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
      }
      return text;
    };
    for (std::size_t solid = 0, solids = 1 + below(3); solid < solids; ++solid) {
      put(word("solid") + " part facet 1 2" + eol_);
      for (std::size_t f = below(15); f > 0; --f) {
        put(blanks() + word("facet normal") + (one_in(5) ? " nan nan nan" : " 0 0 1") + eol_);
        put("  " + word("outer") + blanks() + word("loop") + eol_);
        std::vector<std::uint32_t> face;
        for (int corner = 0; corner < 3; ++corner) {
          put("    " + word("vertex") + blanks());
          face.push_back(static_cast<std::uint32_t>(file_.spans.size()));
          put_coordinates(pick(pool_), false);
          put(one_in(9) ? " " + eol_ + eol_ : eol_);
        }
        put("  " + word("endloop") + eol_ + word("endfacet") + eol_);
        file_.faces.push_back(std::move(face));
      }
      put(word("endsolid") + (one_in(2) ? " part" : "") + eol_);
    }
  }

  void write_stl_binary() {
    file_.name = "random.stl";
    file_.kind = {NumberKind::Float32, NumberKind::Float32, NumberKind::Float32};
    std::string header = one_in(2) ? "solid of binary" : "made at random";
    header.resize(80, one_in(2) ? ' ' : '\0');
    put(header);
    const std::size_t facets = below(40);
    put_integer(static_cast<std::int64_t>(facets), 4);
    for (std::size_t f = 0; f < facets; ++f) {
      std::vector<std::uint32_t> face;
      for (int i = 0; i < 3; ++i) put_integer(0x3f800000, 4);
      for (int corner = 0; corner < 3; ++corner) {
        face.push_back(static_cast<std::uint32_t>(file_.spans.size()));
        const auto& point = pick(pool_);
        std::array<ByteSpan, 3> spans;
        for (std::size_t a = 0; a < 3; ++a)
          spans[a] = put_coordinate(point[a], NumberKind::Float32);
        file_.spans.push_back(spans);
      }
      put_integer(static_cast<std::int64_t>(below(65536)), 2);
      file_.faces.push_back(std::move(face));
    }
    if (one_in(4)) put("trailer");
  }

  std::mt19937_64 random_;
  std::size_t number_style_ = 0;
  std::string eol_ = "\n";
  std::vector<std::array<double, 3>> pool_;
  RandomMeshFile file_;
};

}  // namespace

RandomMeshFile random_mesh_file(Kind kind, std::uint64_t seed) {
  return Writer(kind, seed).take();
}

double decode(const std::string& bytes, ByteSpan span, NumberKind kind, bool is_big_endian) {
  if (kind == NumberKind::Text) {
    return std::strtod(bytes.substr(span.begin, span.size).c_str(), nullptr);
  }
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < span.size; ++i) {
    const std::size_t at = span.begin + (is_big_endian ? i : span.size - 1 - i);
    bits = bits << 8 | static_cast<unsigned char>(bytes[at]);
  }
  switch (kind) {
    case NumberKind::Int16:
      return static_cast<std::int16_t>(bits);
    case NumberKind::Int32:
      return static_cast<std::int32_t>(bits);
    case NumberKind::Float32: {
      float value = 0;
      const auto low = static_cast<std::uint32_t>(bits);
      std::memcpy(&value, &low, 4);
      return static_cast<double>(value);
    }
    default:
      break;
  }
  double value = 0;
  std::memcpy(&value, &bits, 8);
  return value;
}

}  // namespace triglyph::test
