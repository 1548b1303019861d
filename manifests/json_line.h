// One line of JSON as manifests and records hold it: read strictly, and as values of options.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "engine/base/options.h"

namespace triglyph {

// Parses one JSON object. Unlike a plain parser it refuses a key that comes twice in an object, and
// anything nested deeper than lines of ours ever are, before it takes memory or stack. Throws Error
// Malformed without a path. O(bytes).
[[nodiscard]] nlohmann::ordered_json parse_json_line(const std::string& line);

// Returns a JSON value as an option's value. Throws Error Usage naming the key for an array, an
// object, null, or a whole number beyond 2^63.
[[nodiscard]] OptionValue option_value(const std::string& key, const nlohmann::ordered_json& json);

[[nodiscard]] nlohmann::ordered_json to_json(const OptionValue& value);

// One line of JSON, ended by a newline; bytes that are no UTF-8 (in file names) are replaced.
[[nodiscard]] std::string to_line(const nlohmann::ordered_json& json);

}  // namespace triglyph
