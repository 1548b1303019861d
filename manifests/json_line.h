// Strict parsing of single lines of JSON, as manifests and records hold them, and conversion to
// values of options.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "engine/base/options.h"

namespace triglyph {

// Parses one JSON object. Refuses repeated keys, and nesting deeper than any line that triglyph
// writes, before that takes memory or stack. Throws Error Malformed without a path. O(bytes).
[[nodiscard]] nlohmann::ordered_json parse_json_line(const std::string& line);

// Returns a JSON value as an option's value. Throws Error Usage naming the key for an array, an
// object, null, or a whole number beyond 2^63.
[[nodiscard]] OptionValue option_value(const std::string& key, const nlohmann::ordered_json& json);

[[nodiscard]] nlohmann::ordered_json to_json(const OptionValue& value);

// Returns one line of JSON with its newline. Bytes that are not UTF-8, as in file names, are
// replaced.
[[nodiscard]] std::string to_line(const nlohmann::ordered_json& json);

}  // namespace triglyph
