// Concatenation of byte blocks that several threads produced. Internal to engine/io.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace triglyph {

// Returns the concatenated parts. Each part is released as soon as it is copied.
[[nodiscard]] inline std::vector<char> join(std::vector<std::vector<char>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  std::size_t total = 0;
  for (const auto& part : parts) total += part.size();
  std::vector<char> all;
  all.reserve(total);
  for (auto& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    std::vector<char>().swap(part);
  }
  return all;
}

}  // namespace triglyph
