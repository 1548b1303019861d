// Pairs of meshes to compare, as users name them.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace triglyph {

struct MeshPair {
  std::filesystem::path original;
  std::filesystem::path marked;
  std::filesystem::path name;  // of the pair: where it lies below the folders, or the file's name
};

// Returns the next pair, or nothing at the end.
using PairSource = std::function<std::optional<MeshPair>()>;

// Returns whether the words name more than one pair: two folders, or one file of records or ledger.
[[nodiscard]] bool name_many_pairs(std::span<const std::string> words);

// Returns the pairs that the words name: two meshes; two folders, in which meshes at the same place
// belong together (one without a counterpart makes a pair with a file that does not exist); or a
// file of records or a ledger, for every mesh that was marked. Throws Error Usage for other words,
// and Unreadable. The source throws as open_records() does.
[[nodiscard]] PairSource pairs_of(std::span<const std::string> words);

}  // namespace triglyph
