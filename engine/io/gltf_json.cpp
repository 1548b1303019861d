#include "engine/io/gltf_json.h"

#include <cstring>
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
