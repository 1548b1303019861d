#include "engine/io/base64.h"

#include <algorithm>

#include <sodium.h>

namespace triglyph {
namespace {

constexpr int kVariant = sodium_base64_VARIANT_ORIGINAL;

// libsodium 1.0.18 takes bytes above 127 for others.
bool is_of_alphabet(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' ||
         c == '/' || c == '=';
}

}  // namespace

std::string base64_of(std::span<const char> bytes) {
  std::string text(sodium_base64_ENCODED_LEN(bytes.size(), kVariant), '\0');
  sodium_bin2base64(text.data(), text.size(), reinterpret_cast<const unsigned char*>(bytes.data()),
                    bytes.size(), kVariant);
  text.pop_back();  // the terminating zero
  return text;
}

bool append_from_base64(std::string_view text, std::vector<char>& out) {
  if (!std::all_of(text.begin(), text.end(), is_of_alphabet)) return false;
  const std::size_t first = out.size();
  out.resize(first + text.size() / 4 * 3 + 3);
  const bool is_padded = text.ends_with('=') || text.size() % 4 == 0;
  const int variant =
      is_padded ? sodium_base64_VARIANT_ORIGINAL : sodium_base64_VARIANT_ORIGINAL_NO_PADDING;
  std::size_t size = 0;
  const char* end = nullptr;
  const bool is_valid =
      sodium_base642bin(reinterpret_cast<unsigned char*>(out.data()) + first, out.size() - first,
                        text.data(), text.size(), nullptr, &size, &end, variant) == 0 &&
      end == text.data() + text.size();
  out.resize(first + (is_valid ? size : 0));
  return is_valid;
}

}  // namespace triglyph
