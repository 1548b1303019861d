// Base64 (RFC 4648), the encoding of data URIs. Internal to engine/io.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace triglyph {

// Returns the bytes in base64, padded with '='. O(bytes).
[[nodiscard]] std::string base64_of(std::span<const char> bytes);

// Appends the decoded bytes to `out`. The text may be padded or not. Returns false, with `out` as
// it was, for any other character. O(characters).
[[nodiscard]] bool append_from_base64(std::string_view text, std::vector<char>& out);

}  // namespace triglyph
