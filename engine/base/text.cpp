#include "engine/base/text.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace triglyph {
namespace {

// Returns the number of bytes of the UTF-8 character at the start of the text, or 0 if there is no
// valid one (RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF) or it is a control
// character.
std::size_t printable_prefix(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < size) return 0;
  unsigned code = first & (0xffU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return 0;
    code = code << 6U | (byte(i) & 0x3fU);
  }
  const bool is_overlong = code < (size == 4 ? 0x10000U : size == 3 ? 0x800U : 0x80U);
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  const bool is_control = code < 0xa0;
  // marks that change the direction of what follows can make a name look like another
  const bool turns = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return is_overlong || is_surrogate || is_control || turns || code > 0x10ffff ? 0 : size;
}

// Returns the least number of letters to insert, delete, replace or swap with a neighbour that turn
// one word into the other (Damerau-Levenshtein, each place edited once). O(|a| |b|).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> rows(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        rows[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = rows[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      rows[i][j] = std::min({rows[i - 1][j] + 1, rows[i][j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
    }
  }
  return rows[a.size()][b.size()];
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string result;
  while (!text.empty()) {
    std::size_t size = printable_prefix(text);
    if (size > 0) {
      result += text.substr(0, size);
    } else {
      size = 1;
      const auto byte = static_cast<unsigned char>(text[0]);
      result += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 0xfU]};
    }
    text.remove_prefix(size);
  }
  return result;
}

bool is_printable(std::string_view text) {
  return !text.empty() && printable(text) == text;
}

std::string lower_case_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::optional<std::string> closest_word(std::string_view word, std::span<const std::string> known) {
  const std::string* closest = nullptr;
  std::size_t least = word.size() / 3 + 1;  // a third of the letters may be wrong
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(candidate, word);
    if (distance >= least) continue;
    closest = &candidate;
    least = distance;
  }
  return closest == nullptr ? std::nullopt : std::optional(*closest);
}

}  // namespace triglyph
