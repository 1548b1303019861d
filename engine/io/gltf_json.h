// The JSON of glTF: access that names the place of what is missing or of another kind. Internal to
// engine/io.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <simdjson.h>

#include "engine/io/gltf.h"
#include "engine/io/readers.h"

namespace triglyph {

class GltfObject {
 public:
  GltfObject(simdjson::dom::object object, std::string place, const std::filesystem::path& path)
      : object_(object), place_(std::move(place)), path_(&path) {}

  // Return a member, or nothing if it is not there. Throw Error Malformed if it is of another kind:
  // an integer from 0 to 2^53, text, an object.
  [[nodiscard]] std::optional<std::uint64_t> number(const char* key) const;
  [[nodiscard]] std::optional<std::string_view> text(const char* key) const;
  [[nodiscard]] std::optional<GltfObject> child(const char* key) const;
  // Returns the members of an array of objects; none if it is not there.
  [[nodiscard]] std::vector<GltfObject> items(const char* key) const;

  [[nodiscard]] std::uint64_t needed_number(const char* key) const;
  [[nodiscard]] GltfObject needed_child(const char* key) const;

  [[nodiscard]] const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void refuse(const std::string& message) const;  // Error Unsupported

 private:
  [[nodiscard]] std::optional<simdjson::dom::element> find(const char* key) const;

  simdjson::dom::object object_;
  std::string place_;
  const std::filesystem::path* path_;
};

// Where the JSON lies, and the binary chunk of a GLB that has one.
struct GltfChunks {
  bool is_binary = false;
  std::uint64_t json = 0, json_size = 0;
  std::optional<std::uint64_t> data;
  std::uint64_t data_size = 0;
};

// Finds the chunks by the content, not by the name. Throws Error Malformed, and Unsupported for
// glTF 1.0. O(1).
[[nodiscard]] GltfChunks find_gltf_chunks(const Source& source);

// Parses the JSON with `parser`, which owns what is returned. Throws Error Malformed, and
// Unsupported for another version than 2. O(bytes).
[[nodiscard]] GltfObject parse_gltf(simdjson::dom::parser& parser, const Source& source,
                                    const GltfChunks& chunks);

// Return the type of an accessor, and the number of its components: 3 for VEC3. Throw Error
// Malformed.
[[nodiscard]] Scalar component_type_of(const GltfObject& accessor);
[[nodiscard]] std::uint64_t components_of(const GltfObject& accessor);

// Returns the text of a URI with "%20" as a blank and so on.
[[nodiscard]] std::string percent_decoded(std::string_view uri);

}  // namespace triglyph
