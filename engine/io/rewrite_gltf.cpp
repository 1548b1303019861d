#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <simdjson.h>

#include "engine/base/error.h"
#include "engine/io/base64.h"
#include "engine/io/gltf.h"
#include "engine/io/readers.h"

namespace triglyph {
namespace {

// A stretch of the JSON and what takes its place.
struct JsonEdit {
  std::size_t begin = 0, end = 0;
  std::string text;
};

// Returns the number as it is, so that a reader of the JSON finds the float of the buffer.
std::string exact_text(double value) {
  char text[64];
  constexpr double kMostInteger = 1e15;
  if (value == std::nearbyint(value) && std::abs(value) < kMostInteger) {
    return std::to_string(static_cast<std::int64_t>(value));
  }
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// Returns what JSON text without line breaks and quotes means: a slash may be written as "\/", and
// any character by its number.
std::string without_escapes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      plain += text[i];
      continue;
    }
    unsigned number = 0;
    if (text[++i] == 'u' && i + 4 < text.size()) {
      std::from_chars(text.data() + i + 1, text.data() + i + 5, number, 16);
      plain += static_cast<char>(number);
      i += 4;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

// Walks over the JSON once and notes the places of what changes.
class JsonEdits {
 public:
  JsonEdits(const GltfFile& gltf, std::span<const char> image,
            std::span<const BoundsChange> changes)
      : gltf_(gltf), image_(image) {
    for (const BoundsChange& change : changes) changes_[change.accessor].push_back(change);
  }

  std::vector<JsonEdit> find() {
    const simdjson::padded_string json(image_.data() + gltf_.json, gltf_.json_size);
    start_ = json.data();
    simdjson::ondemand::parser parser;
    auto document = parser.iterate(json);
    bool has_accessors = false, has_buffers = false;  // the first of equal names counts
    for (auto field : document.get_object()) {
      const std::string_view key = field.unescaped_key();
      if (key == "accessors" && !std::exchange(has_accessors, true)) {
        std::size_t index = 0;
        for (auto accessor : field.value().get_array())
          edit_accessor(accessor.get_object(), index++);
      } else if (key == "buffers" && !std::exchange(has_buffers, true)) {
        std::size_t index = 0;
        for (auto buffer : field.value().get_array()) edit_buffer(buffer.get_object(), index++);
      }
    }
    std::sort(edits_.begin(), edits_.end(),
              [](const JsonEdit& a, const JsonEdit& b) { return a.begin < b.begin; });
    return std::move(edits_);
  }

 private:
  void add(std::string_view token, std::string text) {
    const std::size_t last = token.find_last_not_of(" \t\r\n");
    const auto begin = static_cast<std::size_t>(token.data() - start_);
    edits_.push_back({begin, begin + last + 1, std::move(text)});
  }

  void edit_accessor(simdjson::ondemand::object accessor, std::size_t index) {
    const auto changes = changes_.find(index);
    if (changes == changes_.end()) return;
    bool has_end[2] = {false, false};
    for (auto field : accessor) {
      const std::string_view key = field.unescaped_key();
      if (key != "min" && key != "max") continue;
      const bool is_max = key == "max";
      if (std::exchange(has_end[is_max ? 1 : 0], true)) continue;
      simdjson::ondemand::array numbers;
      if (field.value().get_array().get(numbers) != simdjson::SUCCESS) continue;  // no bounds
      int axis = 0;
      for (auto number : numbers) {
        const std::string_view token = number.raw_json_token();
        for (const BoundsChange& change : changes->second) {
          if (change.is_max == is_max && change.axis == axis) {
            add(token, exact_text(change.value));
          }
        }
        ++axis;
      }
    }
  }

  void edit_buffer(simdjson::ondemand::object buffer, std::size_t index) {
    const auto& uris = gltf_.data_uris;
    const auto uri = std::find_if(uris.begin(), uris.end(),
                                  [&](const auto& candidate) { return candidate.buffer == index; });
    if (uri == uris.end()) return;
    bool has_uri = false;
    for (auto field : buffer) {
      const std::string_view key = field.unescaped_key();
      if (key != "uri" || std::exchange(has_uri, true)) continue;
      const std::string_view token = field.value().raw_json_token();
      const std::size_t comma = token.find(','), quote = token.find_last_of('"');
      if (comma == std::string_view::npos || quote < comma) {
        throw Error(ErrorCode::Unsupported, {}, "buffers[" + std::to_string(index) + "]",
                    "a data URI whose comma is escaped");
      }
      const std::string_view old = token.substr(comma + 1, quote - comma - 1);
      std::string text = base64_of(image_.subspan(uri->place, uri->size));
      // As many signs of padding as the file has: some leave them out.
      if (!old.ends_with('=')) text.erase(text.find_last_not_of('=') + 1);
      if (without_escapes(old) != text) add(old, std::move(text));
    }
  }

  const GltfFile& gltf_;
  std::span<const char> image_;
  std::map<std::size_t, std::vector<BoundsChange>> changes_;  // by accessor
  const char* start_ = nullptr;
  std::vector<JsonEdit> edits_;
};

std::vector<JsonEdit> edits_of(const GltfFile& gltf, std::span<const char> image,
                               std::span<const BoundsChange> changes) try {
  if (changes.empty() && gltf.data_uris.empty()) return {};
  return JsonEdits(gltf, image, changes).find();
} catch (const simdjson::simdjson_error& error) {
  throw Error(ErrorCode::Malformed, {}, at_byte(gltf.json),
              std::string("not JSON: ") + error.what());
}

std::string edited(std::span<const char> json, std::span<const JsonEdit> edits) {
  std::string text;
  std::size_t copied = 0;
  for (const JsonEdit& edit : edits) {
    text.append(json.data() + copied, edit.begin - copied);
    text += edit.text;
    copied = edit.end;
  }
  return text.append(json.data() + copied, json.size() - copied);
}

// Makes the text of a GLB's JSON chunk as long as before, or a multiple of four bytes, with blanks.
void pad(std::string& text, std::size_t before) {
  while (text.size() > before && text.ends_with(' ')) text.pop_back();
  while (text.size() < before || text.size() % 4 != 0) text += ' ';
}

}  // namespace

RewrittenGltf rewritten_gltf(const GltfFile& gltf, std::span<const char> image,
                             std::size_t file_size, std::span<const BoundsChange> changes) {
  RewrittenGltf result;
  const std::span<const char> file = image.first(file_size);
  const std::vector<JsonEdit> edits = edits_of(gltf, image, changes);
  if (edits.empty()) {
    result.bytes.assign(file.begin(), file.end());
    return result;
  }
  std::string json = edited(file.subspan(gltf.json, gltf.json_size), edits);
  if (gltf.is_binary) pad(json, gltf.json_size);
  const std::span<const char> rest = file.subspan(gltf.json + gltf.json_size);
  result.shift =
      static_cast<std::ptrdiff_t>(json.size()) - static_cast<std::ptrdiff_t>(gltf.json_size);
  result.bytes.resize(gltf.json + json.size() + rest.size());
  char* out = std::copy(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(gltf.json),
                        result.bytes.data());
  out = std::copy(json.begin(), json.end(), out);
  std::copy(rest.begin(), rest.end(), out);
  if (gltf.is_binary) {
    constexpr std::size_t kLengthOfFile = 8, kLengthOfJson = 12;
    const double length = load(file.data() + kLengthOfFile, Scalar::UInt32, false);
    store(length + static_cast<double>(result.shift), Scalar::UInt32, false,
          result.bytes.data() + kLengthOfFile);
    store(static_cast<double>(json.size()), Scalar::UInt32, false,
          result.bytes.data() + kLengthOfJson);
  }
  return result;
}

}  // namespace triglyph
