#include "engine/io/export_mesh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/io/byte_parts.h"
#include "engine/io/gltf.h"
#include "engine/io/readers.h"

namespace triglyph {
namespace {

constexpr std::size_t kRowBlock = 1 << 14;  // rows written by one thread

using Bytes = std::vector<char>;

// note: vector::insert of a range makes g++ 12 warn of an overflow that cannot happen.
void put(Bytes& out, std::string_view text) {
  const std::size_t size = out.size();
  out.resize(size + text.size());
  std::copy(text.begin(), text.end(), out.data() + size);
}

void put_range(Bytes& out, const char* begin, const char* end) {
  put(out, std::string_view(begin, static_cast<std::size_t>(end - begin)));
}

void put(Bytes& out, std::uint64_t number) {
  char text[24];
  put_range(out, text, std::to_chars(text, text + sizeof text, number).ptr);
}

void put(Bytes& out, double number, const ExportFormat& format) {
  char text[32];
  char* const end = text + sizeof text;
  const bool is_float = format.format == FileFormat::PlyAscii && !format.has_doubles;
  if (number == 0) number = 0;  // -0 -> 0
  const std::to_chars_result result =
      format.significant_digits > 0
          ? std::to_chars(text, end, number, std::chars_format::general, format.significant_digits)
      : is_float ? std::to_chars(text, end, static_cast<float>(round_to(Scalar::Float32, number)))
                 : std::to_chars(text, end, number);
  put_range(out, text, result.ptr);
}

void put_point(Bytes& out, std::string_view lead, const Vec3& p, const ExportFormat& format) {
  put(out, lead);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) out.push_back(' ');
    put(out, p[axis], format);
  }
  out.push_back('\n');
}

void put_binary(Bytes& out, double number, Scalar scalar, bool is_big_endian) {
  char raw[8];
  store(number, scalar, is_big_endian, raw);
  put_range(out, raw, raw + size_of(scalar));
}

// Appends the output of row(i, out) for i in [0, n), in order.
template <typename Row>
void append_rows(std::vector<Bytes>& parts, std::size_t n, const Row& row) {
  const std::size_t first = parts.size();
  parts.resize(first + (n + kRowBlock - 1) / kRowBlock);
  parallel_blocks(
      n,
      [&](std::size_t begin, std::size_t end) {
        Bytes& part = parts[first + begin / kRowBlock];
        for (std::size_t i = begin; i < end; ++i) {
          row(i, part);
          // Rows are about equally long, so the first predicts the size of all.
          if (i == begin) part.reserve((part.size() + part.size() / 4) * (end - begin));
        }
      },
      kRowBlock);
}

void put_indices(Bytes& out, std::string_view lead, const Triangle& t, std::uint64_t base) {
  put(out, lead);
  for (int corner = 0; corner < 3; ++corner) {
    if (corner > 0) out.push_back(' ');
    put(out, t[corner] + base);
  }
  out.push_back('\n');
}

void append_text_rows(std::vector<Bytes>& parts, const Mesh& mesh, const ExportFormat& format) {
  const bool is_obj = format.format == FileFormat::Obj;
  append_rows(parts, mesh.positions.size(), [&](std::size_t i, Bytes& out) {
    put_point(out, is_obj ? "v " : "", mesh.positions[i], format);
  });
  append_rows(parts, mesh.triangles.size(), [&](std::size_t i, Bytes& out) {
    put_indices(out, is_obj ? "f " : "3 ", mesh.triangles[i], is_obj ? 1 : 0);
  });
}

Bytes off_header(const Mesh& mesh) {
  Bytes out;
  put(out, "OFF\n");
  put(out, std::uint64_t{mesh.positions.size()});
  put(out, " ");
  put(out, std::uint64_t{mesh.triangles.size()});
  put(out, " 0\n");
  return out;
}

Bytes ply_header(const Mesh& mesh, const ExportFormat& format) {
  const std::string type = format.has_doubles ? "double" : "float";
  Bytes out;
  put(out, "ply\nformat ");
  put(out, name_of(format.format).substr(4));
  put(out, " 1.0\nelement vertex ");
  put(out, std::uint64_t{mesh.positions.size()});
  for (const char axis : {'x', 'y', 'z'}) put(out, "\nproperty " + type + " " + axis);
  put(out, "\nelement face ");
  put(out, std::uint64_t{mesh.triangles.size()});
  // Signed, because some readers know no other index type.
  put(out, "\nproperty list uchar int vertex_indices\nend_header\n");
  return out;
}

void append_ply_rows(std::vector<Bytes>& parts, const Mesh& mesh, const ExportFormat& format) {
  const bool is_big = format.format == FileFormat::PlyBig;
  const Scalar scalar = format.has_doubles ? Scalar::Float64 : Scalar::Float32;
  append_rows(parts, mesh.positions.size(), [&](std::size_t i, Bytes& out) {
    for (int axis = 0; axis < 3; ++axis) put_binary(out, mesh.positions[i][axis], scalar, is_big);
  });
  append_rows(parts, mesh.triangles.size(), [&](std::size_t i, Bytes& out) {
    out.push_back(3);
    for (const std::uint32_t p : mesh.triangles[i]) put_binary(out, p, Scalar::UInt32, is_big);
  });
}

Vec3 normal_of(const Mesh& mesh, const Triangle& t) {
  const Vec3 n = area_normal(mesh.positions, t);
  const double length = n.norm();
  return length > 0 && std::isfinite(length) ? n / length : Vec3(0, 0, 0);
}

void append_stl_text(std::vector<Bytes>& parts, const Mesh& mesh, const ExportFormat& format) {
  put(parts.emplace_back(), "solid triglyph\n");
  append_rows(parts, mesh.triangles.size(), [&](std::size_t i, Bytes& out) {
    const Triangle& t = mesh.triangles[i];
    ExportFormat short_numbers = format;
    short_numbers.significant_digits = 6;
    put_point(out, "facet normal ", normal_of(mesh, t), short_numbers);
    put(out, "outer loop\n");
    for (const std::uint32_t p : t) put_point(out, "vertex ", mesh.positions[p], format);
    put(out, "endloop\nendfacet\n");
  });
  put(parts.emplace_back(), "endsolid triglyph\n");
}

void append_stl_binary(std::vector<Bytes>& parts, const Mesh& mesh) {
  Bytes header(84, ' ');
  store(static_cast<double>(mesh.triangles.size()), Scalar::UInt32, false, header.data() + 80);
  parts.push_back(std::move(header));
  append_rows(parts, mesh.triangles.size(), [&](std::size_t i, Bytes& out) {
    const Triangle& t = mesh.triangles[i];
    const auto put_vector = [&](const Vec3& v) {
      for (int axis = 0; axis < 3; ++axis) put_binary(out, v[axis], Scalar::Float32, false);
    };
    put_vector(normal_of(mesh, t));
    for (const std::uint32_t p : t) put_vector(mesh.positions[p]);
    put_binary(out, 0, Scalar::UInt16, false);
  });
}

}  // namespace

std::vector<char> export_mesh(const Mesh& mesh, const ExportFormat& format) {
  if (mesh.triangles.size() > std::numeric_limits<std::int32_t>::max() ||
      mesh.positions.size() > std::numeric_limits<std::int32_t>::max()) {
    throw Error(ErrorCode::Unsupported, {}, "", "more than 2^31 - 1 points or triangles");
  }
  std::vector<Bytes> parts;
  switch (format.format) {
    case FileFormat::Off:
      parts.push_back(off_header(mesh));
      [[fallthrough]];
    case FileFormat::Obj:
      append_text_rows(parts, mesh, format);
      break;
    case FileFormat::PlyAscii:
      parts.push_back(ply_header(mesh, format));
      append_text_rows(parts, mesh, format);
      break;
    case FileFormat::PlyLittle:
    case FileFormat::PlyBig:
      parts.push_back(ply_header(mesh, format));
      append_ply_rows(parts, mesh, format);
      break;
    case FileFormat::StlAscii:
      append_stl_text(parts, mesh, format);
      break;
    case FileFormat::StlBinary:
      append_stl_binary(parts, mesh);
      break;
    case FileFormat::Gltf:
    case FileFormat::Glb:
      return export_gltf(mesh, format.format == FileFormat::Glb);
  }
  return join(std::move(parts));
}

}  // namespace triglyph
