// The files in a folder at any depth, without leaving any out in silence.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace triglyph {

struct FolderWalk {
  // Says whether to enter a folder; depth 0 is directly in the first one. Links are not entered.
  std::function<bool(const std::filesystem::path& folder, int depth)> enters;
  // Says whether a file belongs to the result.
  std::function<bool(const std::filesystem::path& file)> wants;
};

// Returns the regular files, or links to such, sorted. Throws Error Unreadable naming the folder or
// file that cannot be looked at; a link to nothing is no file. O(entries log entries).
[[nodiscard]] std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder,
                                                             const FolderWalk& walk);

}  // namespace triglyph
