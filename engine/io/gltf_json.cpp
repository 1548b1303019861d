#include "engine/io/gltf_json.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include "engine/base/error.h"
#include "engine/io/text_scan.h"

namespace triglyph {
namespace {

constexpr std::uint64_t kGlbHeader = 12;  // magic, version, length
constexpr std::uint64_t kChunkHeader = 8;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kDataChunk = 0x004e4942;

std::uint32_t word_at(const Source& source, std::uint64_t place) {
  return static_cast<std::uint32_t>(load(source.bytes.data() + place, Scalar::UInt32, false));
}

}  // namespace

std::optional<simdjson::dom::element> GltfObject::find(const char* key) const {
  simdjson::dom::element element;
  if (object_.at_key(key).get(element) != simdjson::SUCCESS) return std::nullopt;
  return element;
}

std::optional<std::uint64_t> GltfObject::number(const char* key) const {
  const auto element = find(key);
  if (!element) return std::nullopt;
  constexpr double kMost = 0x1p53;
  double value = -1;
  if (element->get_double().get(value) != simdjson::SUCCESS || value < 0 || value > kMost ||
      value != static_cast<double>(static_cast<std::uint64_t>(value))) {
    fail(std::string(key) + " is not a whole number from 0 on");
  }
  return static_cast<std::uint64_t>(value);
}

std::optional<std::string_view> GltfObject::text(const char* key) const {
  const auto element = find(key);
  if (!element) return std::nullopt;
  std::string_view value;
  if (element->get_string().get(value) != simdjson::SUCCESS) {
    fail(std::string(key) + " is not text");
  }
  return value;
}

std::optional<GltfObject> GltfObject::child(const char* key) const {
  const auto element = find(key);
  if (!element) return std::nullopt;
  simdjson::dom::object value;
  if (element->get_object().get(value) != simdjson::SUCCESS) {
    fail(std::string(key) + " is not an object");
  }
  return GltfObject(value, place_.empty() ? key : place_ + "." + key, *path_);
}

std::vector<GltfObject> GltfObject::items(const char* key) const {
  std::vector<GltfObject> found;
  const auto element = find(key);
  if (!element) return found;
  simdjson::dom::array array;
  if (element->get_array().get(array) != simdjson::SUCCESS) {
    fail(std::string(key) + " is not an array");
  }
  const std::string start = place_.empty() ? key : place_ + "." + key;
  for (const simdjson::dom::element item : array) {
    const std::string place = start + "[" + std::to_string(found.size()) + "]";
    simdjson::dom::object value;
    if (item.get_object().get(value) != simdjson::SUCCESS) fail(place + " is not an object");
    found.emplace_back(value, place, *path_);
  }
  return found;
}

std::uint64_t GltfObject::needed_number(const char* key) const {
  const auto value = number(key);
  if (!value) fail(std::string("has no ") + key);
  return *value;
}

GltfObject GltfObject::needed_child(const char* key) const {
  auto value = child(key);
  if (!value) fail(std::string("has no ") + key);
  return *std::move(value);
}

void GltfObject::fail(const std::string& message) const {
  throw Error(ErrorCode::Malformed, *path_, place_, message);
}

void GltfObject::refuse(const std::string& message) const {
  throw Error(ErrorCode::Unsupported, *path_, place_, message);
}

GltfChunks find_gltf_chunks(const Source& source) {
  const std::string_view text(source.bytes.data(), source.bytes.size());
  GltfChunks chunks;
  if (!text.starts_with("glTF")) {
    chunks.json = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    chunks.json_size = text.size() - chunks.json;
    return chunks;
  }
  const auto fail = [&](std::uint64_t place, const std::string& message) {
    throw Error(ErrorCode::Malformed, source.path, at_byte(place), message);
  };
  chunks.is_binary = true;
  if (text.size() < kGlbHeader + kChunkHeader) fail(text.size(), "the file ends inside its header");
  const std::uint32_t version = word_at(source, 4);
  if (version != 2) {
    throw Error(ErrorCode::Unsupported, source.path, at_byte(4),
                "glTF " + std::to_string(version) + " is not read, only 2.0");
  }
  const std::uint64_t end = word_at(source, 8);
  if (end > text.size()) {
    fail(text.size(), "the file ends before the " + std::to_string(end) + " bytes it announces");
  }
  for (std::uint64_t place = kGlbHeader; place + kChunkHeader <= end;) {
    const std::uint64_t size = word_at(source, place);
    const std::uint32_t kind = word_at(source, place + 4);
    if (size > end - place - kChunkHeader) fail(place, "a chunk reaches beyond the file");
    const bool is_first = place == kGlbHeader;
    if (is_first != (kind == kJsonChunk)) fail(place, "the first chunk, and it alone, is JSON");
    place += kChunkHeader;
    if (is_first) {
      chunks.json = place;
      chunks.json_size = size;
    } else if (kind == kDataChunk && !chunks.data) {
      chunks.data = place;
      chunks.data_size = size;
    }
    place += size;
  }
  return chunks;
}

GltfObject parse_gltf(simdjson::dom::parser& parser, const Source& source,
                      const GltfChunks& chunks) {
  simdjson::dom::element element;
  const auto error = parser.parse(source.bytes.data() + chunks.json, chunks.json_size).get(element);
  simdjson::dom::object root;
  if (error != simdjson::SUCCESS || element.get_object().get(root) != simdjson::SUCCESS) {
    throw Error(ErrorCode::Malformed, source.path, at_byte(chunks.json),
                error == simdjson::SUCCESS ? "not a JSON object"
                                           : std::string("not JSON: ") + error_message(error));
  }
  GltfObject gltf(root, "", source.path);
  const auto version = gltf.needed_child("asset").text("version");
  if (!version) gltf.fail("asset has no version");
  if (*version != "2" && !version->starts_with("2.")) {
    gltf.refuse("glTF " + std::string(*version) + " is not read, only 2.0");
  }
  return gltf;
}

std::uint64_t components_of(const GltfObject& accessor) {
  const auto type = accessor.text("type");
  constexpr std::pair<std::string_view, std::uint64_t> kTypes[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& [name, count] : kTypes) {
    if (type == name) return count;
  }
  accessor.fail("has no known type");
}

Scalar component_type_of(const GltfObject& accessor) {
  constexpr std::pair<std::uint64_t, Scalar> kTypes[] = {
      {5120, Scalar::Int8},   {5121, Scalar::UInt8},  {5122, Scalar::Int16},
      {5123, Scalar::UInt16}, {5125, Scalar::UInt32}, {5126, Scalar::Float32}};
  const std::uint64_t type = accessor.needed_number("componentType");
  for (const auto& [number, scalar] : kTypes) {
    if (type == number) return scalar;
  }
  accessor.fail("has no known componentType");
}

std::string percent_decoded(std::string_view uri) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
      decoded += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
      i += 2;
    } else {
      decoded += uri[i];
    }
  }
  return decoded;
}

std::optional<std::uint64_t> geometry_bytes_of_glb(const std::filesystem::path& path) try {
  constexpr std::uint32_t kMostJson = 1U << 28;  // of files that are worth looking into
  std::vector<char> bytes(kGlbHeader + kChunkHeader);
  std::ifstream file(path, std::ios::binary);
  const auto read = [&](std::size_t from) {
    return static_cast<bool>(
        file.read(bytes.data() + from, static_cast<std::streamsize>(bytes.size() - from)));
  };
  const bool is_glb = read(0) && std::string_view(bytes.data(), 4) == "glTF";
  const std::uint32_t size = is_glb ? word_at({bytes, path}, kGlbHeader) : 0;
  if (!is_glb || size > kMostJson) return std::nullopt;
  bytes.resize(bytes.size() + size);
  if (!read(kGlbHeader + kChunkHeader)) return std::nullopt;
  simdjson::dom::parser parser;
  const GltfChunks chunks{true, kGlbHeader + kChunkHeader, size, std::nullopt, 0};
  double total = 0;
  for (const GltfObject& accessor : parse_gltf(parser, {bytes, path}, chunks).items("accessors")) {
    total += static_cast<double>(accessor.needed_number("count")) *
             static_cast<double>(components_of(accessor) * size_of(component_type_of(accessor)));
  }
  constexpr double kMost = 0x1p50;  // a count that is wrong is found when the file is read
  return static_cast<std::uint64_t>(std::min(total, kMost));
} catch (const Error&) {
  return std::nullopt;
}

std::vector<std::string> images_of_gltf(std::span<const char> bytes,
                                        const std::filesystem::path& path) {
  const Source source{bytes, path};
  simdjson::dom::parser parser;
  std::vector<std::string> names;
  for (const GltfObject& image :
       parse_gltf(parser, source, find_gltf_chunks(source)).items("images")) {
    const auto uri = image.text("uri");
    if (uri && uri->find(':') == std::string_view::npos) names.push_back(percent_decoded(*uri));
  }
  return names;
}

}  // namespace triglyph
