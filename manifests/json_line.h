// Strict parsing of single lines of JSON, as manifests and records hold them, and conversion to
// values of options.
#pragma once

#include <cstddef>
#include <filesystem>
#include <istream>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/base/options.h"

namespace triglyph {

// A line of a manifest or of records may have 64 MiB: a record that lists a million units has 20.
inline constexpr std::size_t kLongestLine = std::size_t{64} << 20;

// Reads the next line without its newline, as std::getline() does, and returns whether there was
// one. Throws Error Malformed without a path for a line longer than kLongestLine, of which it reads
// no more, and Unreadable if the stream fails.
bool read_line(std::istream& stream, std::string& line);

// Parses one JSON object. Refuses repeated keys, and nesting deeper than any line that triglyph
// writes, before that takes memory or stack. Throws Error Malformed without a path. O(bytes).
[[nodiscard]] nlohmann::ordered_json parse_json_line(const std::string& line);

// Returns a JSON value as an option's value. Throws Error Usage naming the key for an array, an
// object, null, or a whole number beyond 2^63.
[[nodiscard]] OptionValue option_value(const std::string& key, const nlohmann::ordered_json& json);

[[nodiscard]] nlohmann::ordered_json to_json(const OptionValue& value);

// Adds a path under the key, and if it is not UTF-8 its bytes in hexadecimal under "<key>_bytes".
void put_path(nlohmann::ordered_json& json, const std::string& key,
              const std::filesystem::path& path);

// Returns the path that put_path() added, or an empty one. Throws Error Malformed without a path.
[[nodiscard]] std::filesystem::path path_in(const nlohmann::ordered_json& json,
                                            const std::string& key);

// Returns one line of JSON with its newline. Bytes that are not UTF-8, as in file names, are
// replaced.
[[nodiscard]] std::string to_line(const nlohmann::ordered_json& json);

}  // namespace triglyph
