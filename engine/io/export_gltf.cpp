#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <string>

#include "engine/base/error.h"
#include "engine/io/base64.h"
#include "engine/io/gltf.h"
#include "engine/io/readers.h"

namespace triglyph {
namespace {

std::string array_text(const std::array<double, 3>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    char number[64];
    text += i == 0 ? "" : ",";
    text.append(number, std::to_chars(number, number + sizeof number, values[i]).ptr);
  }
  return text + "]";
}

std::string json_of(const Mesh& mesh, std::size_t bytes, const std::string& uri) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> least{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> most{-kInfinity, -kInfinity, -kInfinity};
  for (const Vec3& p : mesh.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = round_to(Scalar::Float32, p[axis]);
      least[axis] = std::min(least[axis], value);
      most[axis] = std::max(most[axis], value);
    }
  }
  const std::string points = std::to_string(mesh.positions.size());
  const std::string corners = std::to_string(3 * mesh.triangles.size());
  const std::string split = std::to_string(12 * mesh.positions.size());
  const std::string rest = std::to_string(12 * mesh.triangles.size());
  return R"({"asset":{"version":"2.0","generator":"triglyph"},"scene":0,"scenes":[{"nodes":[0]}],)"
         R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
         points + R"(,"min":)" + array_text(least) + R"(,"max":)" + array_text(most) +
         R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" + corners +
         R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + split +
         R"(,"target":34962},{"buffer":0,"byteOffset":)" + split + R"(,"byteLength":)" + rest +
         R"(,"target":34963}],"buffers":[{"byteLength":)" + std::to_string(bytes) + uri + "}]}";
}

std::vector<char> data_of(const Mesh& mesh) {
  std::vector<char> data(12 * (mesh.positions.size() + mesh.triangles.size()));
  char* out = data.data();
  for (const Vec3& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis, out += 4) store(p[axis], Scalar::Float32, false, out);
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      store(corner, Scalar::UInt32, false, out);
      out += 4;
    }
  }
  return data;
}

}  // namespace

std::vector<char> export_gltf(const Mesh& mesh, bool is_binary) {
  if (mesh.positions.empty() || mesh.triangles.empty()) {
    throw Error(ErrorCode::Unsupported, {}, "", "glTF holds no mesh without triangles");
  }
  const std::vector<char> data = data_of(mesh);
  if (!is_binary) {
    const std::string json =
        json_of(mesh, data.size(),
                R"(,"uri":"data:application/octet-stream;base64,)" + base64_of(data) + "\"");
    return {json.begin(), json.end()};
  }
  std::string json = json_of(mesh, data.size(), "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + json.size() + 8 + data.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::Unsupported, {}, "", "a GLB holds no more than 4 GiB");
  }
  std::vector<char> out(total);
  char* p = out.data();
  const auto put_word = [&](std::size_t word) {
    store(static_cast<double>(word), Scalar::UInt32, false, p);
    p += 4;
  };
  put_word(0x46546c67);  // "glTF"
  put_word(2);
  put_word(total);
  put_word(json.size());
  put_word(0x4e4f534a);  // "JSON"
  p = std::copy(json.begin(), json.end(), p);
  put_word(data.size());
  put_word(0x004e4942);  // "BIN"
  std::copy(data.begin(), data.end(), p);
  return out;
}

}  // namespace triglyph
