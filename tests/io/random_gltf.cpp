#include "tests/io/random_gltf.h"

#include <algorithm>
#include <cstring>
#include <random>
#include <stdexcept>

namespace triglyph::test {
namespace {

using Json = nlohmann::ordered_json;

const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string in_base64(const std::string& data) {
  std::string text;
  for (std::size_t i = 0; i < data.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (i + k < data.size() ? static_cast<unsigned char>(data[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > data.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

std::string from_base64(const std::string& text) {
  std::string data;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    if ((bits += 6) >= 8) data += static_cast<char>(word >> (bits -= 8) & 255);
  }
  return data;
}

class GltfWriter {
 public:
  GltfWriter(std::uint64_t seed, bool is_binary) : random_(seed) {
    file_.is_binary = is_binary;
    file_.component = one_in(4) ? 2 : one_in(6) ? 1 : 4;
    for (std::size_t i = 3 + below(12); i > 0; --i) pool_.push_back(point());
    file_.json["asset"] = {{"version", "2.0"}, {"generator", "a \"quoted\" \xC3\xBC writer"}};
    for (const char* list : {"buffers", "bufferViews", "accessors"}) {
      file_.json[list] = Json::array();  // their order in the file varies no reader
    }
    Json meshes = Json::array();
    for (std::size_t m = 1 + below(2); m > 0; --m) {
      Json primitives = Json::array();
      for (std::size_t p = 1 + below(3); p > 0; --p) primitives.push_back(primitive());
      meshes.push_back({{"name", "min"}, {"primitives", primitives}});
    }
    file_.json["meshes"] = meshes;
    file_.json["nodes"] = {{{"mesh", 0}, {"scale", {2.0, 2.0, 2.5}}}};
    finish();
  }

  RandomGltf take() { return std::move(file_); }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }
  bool one_in(std::size_t n) { return below(n) == 0; }

  std::array<float, 3> point() {
    std::array<float, 3> p{};
    for (float& c : p) {
      const double unit = static_cast<double>(random_() >> 11) * 0x1p-53 - 0.5;
      c = static_cast<float>(file_.component == 4   ? unit * 3
                             : file_.component == 2 ? static_cast<int>(unit * 60000)
                                                    : static_cast<int>(unit * 200));
    }
    return p;
  }

  template <typename T>
  void put(T value) {
    file_.data.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  void put_coordinate(float value) {
    if (file_.component == 4) put(value);
    if (file_.component == 2) put(static_cast<std::int16_t>(value));
    if (file_.component == 1) put(static_cast<std::int8_t>(value));
  }

  void align() {
    while (file_.data.size() % 4 != 0) file_.data += '\x55';
  }

  std::size_t add_view(std::size_t begin, std::size_t stride) {
    Json view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", file_.data.size() - begin}};
    if (stride > 0) view["byteStride"] = stride;
    file_.json["bufferViews"].push_back(view);
    return file_.json["bufferViews"].size() - 1;
  }

  // Writes an accessor of positions, alone or interleaved with other values, perhaps with a sparse
  // part; returns its index.
  std::size_t positions(std::size_t count) {
    align();
    const std::size_t begin = file_.data.size(), first = file_.places.size();
    const std::size_t size = 3 * file_.component;
    const std::size_t before = 4 * below(3);
    const std::size_t stride = (before + size + 3) / 4 * 4 + 4 * below(2);
    std::vector<std::array<float, 3>> values;
    for (std::size_t i = 0; i < count; ++i) {
      values.push_back(pool_[below(pool_.size())]);
      const std::size_t row = file_.data.size();
      file_.data.append(before, '\x11');
      file_.places.push_back(file_.data.size());
      for (const float c : values.back()) put_coordinate(c);
      file_.data.resize(row + stride, '\x22');
    }
    const int type = file_.component == 4 ? 5126 : file_.component == 2 ? 5122 : 5120;
    Json accessor = {{"bufferView", add_view(begin, stride)},
                     {"byteOffset", before},
                     {"componentType", type},
                     {"count", count},
                     {"type", "VEC3"}};
    if (one_in(4)) accessor["sparse"] = sparse(values, first, type);
    std::array<double, 3> least{}, most{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = most[axis] = static_cast<double>(values[0][axis]);
      for (const auto& v : values) {
        least[axis] = std::min(least[axis], static_cast<double>(v[axis]));
        most[axis] = std::max(most[axis], static_cast<double>(v[axis]));
      }
    }
    accessor["min"] = least;
    accessor["max"] = most;
    file_.json["accessors"].push_back(accessor);
    const std::size_t index = file_.json["accessors"].size() - 1;
    file_.accessor.resize(file_.places.size(), index);
    return index;
  }

  Json sparse(std::vector<std::array<float, 3>>& values, std::size_t first, int) {
    std::vector<std::uint16_t> which;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (one_in(3)) which.push_back(static_cast<std::uint16_t>(i));
    }
    if (which.empty()) which.push_back(0);
    align();
    const std::size_t index_begin = file_.data.size();
    for (const std::uint16_t i : which) put(i);
    const std::size_t index_view = add_view(index_begin, 0);
    align();
    const std::size_t value_begin = file_.data.size();
    for (const std::uint16_t i : which) {
      values[i] = pool_[below(pool_.size())];
      file_.places[first + i] = file_.data.size();
      for (const float c : values[i]) put_coordinate(c);
    }
    return {{"count", which.size()},
            {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
            {"values", {{"bufferView", add_view(value_begin, 0)}}}};
  }

  Json primitive() {
    const std::size_t count = 3 + below(12), first = file_.places.size();
    Json result = {{"attributes", {{"NORMAL", 0}, {"POSITION", positions(count)}}}};
    result["attributes"].erase("NORMAL");
    const std::size_t mode = one_in(2) ? 4 : 3 + below(4);
    if (mode != 4 || one_in(2)) result["mode"] = mode;
    std::vector<std::uint32_t> corners;
    if (one_in(4)) {
      for (std::size_t i = 0; i < count; ++i) corners.push_back(static_cast<std::uint32_t>(i));
    } else {
      for (std::size_t i = 3 * (1 + below(6)); i > 0; --i) {
        corners.push_back(static_cast<std::uint32_t>(below(count)));
      }
      align();
      const std::size_t begin = file_.data.size(), size = std::size_t{1} << below(3);
      for (const std::uint32_t c : corners)
        file_.data.append(reinterpret_cast<const char*>(&c), size);
      const int type = size == 1 ? 5121 : size == 2 ? 5123 : 5125;
      const Json accessor = {{"bufferView", add_view(begin, 0)},
                             {"componentType", type},
                             {"count", corners.size()},
                             {"type", "SCALAR"}};
      file_.json["accessors"].push_back(accessor);
      result["indices"] = file_.json["accessors"].size() - 1;
    }
    for (std::uint32_t& c : corners) c += static_cast<std::uint32_t>(first);
    for (std::size_t i = 0; mode >= 4 && i + 2 < corners.size(); i += mode == 4 ? 3 : 1) {
      if (mode == 6) {
        file_.faces.push_back({corners[0], corners[i + 1], corners[i + 2]});
      } else if (mode == 5 && i % 2 != 0) {
        file_.faces.push_back({corners[i + 1], corners[i], corners[i + 2]});
      } else {
        file_.faces.push_back({corners[i], corners[i + 1], corners[i + 2]});
      }
    }
    return result;
  }

  void finish() {
    align();
    Json buffer = {{"byteLength", file_.data.size()}};
    if (!file_.is_binary) {
      buffer["uri"] = "data:application/octet-stream;base64," + in_base64(file_.data);
    }
    file_.json["buffers"].push_back(buffer);
    std::string text = one_in(2) ? file_.json.dump() : file_.json.dump(static_cast<int>(below(5)));
    if (!file_.is_binary) {
      file_.bytes = one_in(4) ? "\xEF\xBB\xBF" + text : text;
      return;
    }
    text += std::string(below(9), ' ');
    file_.bytes = glb_of(text, file_.data);
  }

  std::mt19937_64 random_;
  std::vector<std::array<float, 3>> pool_;
  RandomGltf file_;
};

std::uint32_t word_of(const std::string& bytes, std::size_t place) {
  std::uint32_t word = 0;
  if (place + 4 > bytes.size()) throw std::runtime_error("the file ends in a number");
  std::memcpy(&word, bytes.data() + place, 4);
  return word;
}

}  // namespace

RandomGltf random_gltf(std::uint64_t seed, bool is_binary) {
  return GltfWriter(seed, is_binary).take();
}

GltfParts parts_of_gltf(const std::string& bytes, bool is_binary) {
  GltfParts parts;
  if (!is_binary) {
    parts.json = Json::parse(bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes);
    const std::string uri = parts.json["buffers"][0]["uri"];
    parts.data = from_base64(uri.substr(uri.find(',') + 1));
    return parts;
  }
  if (word_of(bytes, 8) != bytes.size()) throw std::runtime_error("the length is wrong");
  for (std::size_t at = 12; at < bytes.size();) {
    const std::size_t size = word_of(bytes, at), kind = word_of(bytes, at + 4);
    if (size % 4 != 0 || at + 8 + size > bytes.size()) throw std::runtime_error("a chunk is wrong");
    const std::string chunk = bytes.substr(at + 8, size);
    if (kind == 0x4e4f534a) {
      parts.json = Json::parse(chunk);
    } else if (kind == 0x004e4942) {
      parts.data = chunk;
    } else {
      parts.rest += chunk;
    }
    at += 8 + size;
  }
  return parts;
}

std::string glb_of(const std::string& json, const std::string& data) {
  std::string text = json, bytes = "glTF";
  while (text.size() % 4 != 0) text += ' ';
  const auto put = [&](std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&word), 4);
  };
  const std::string other = "any";  // a chunk of another kind, which readers pass over
  put(2);
  put(12 + 8 + text.size() + 8 + data.size() + 8 + 4);
  put(text.size());
  put(0x4e4f534a);
  bytes += text;
  put(data.size());
  put(0x004e4942);
  bytes += data;
  put(4);
  put(0x31313131);
  return bytes + other + "!";
}

double stored_in(const std::string& data, std::size_t place, std::size_t axis,
                 std::size_t component) {
  const char* at = data.data() + place + axis * component;
  if (component == 1) return static_cast<signed char>(*at);
  if (component == 2) {
    std::int16_t value = 0;
    std::memcpy(&value, at, 2);
    return value;
  }
  float value = 0;
  std::memcpy(&value, at, 4);
  return static_cast<double>(value);
}

}  // namespace triglyph::test
