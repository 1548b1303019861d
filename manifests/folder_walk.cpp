#include "manifests/folder_walk.h"

#include <algorithm>

#include "engine/base/error.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::error_code& error) {
  throw Error(ErrorCode::Unreadable, path, "", error.message());
}

bool is_file(const fs::directory_entry& entry) {
  std::error_code error;
  const bool is_regular = entry.is_regular_file(error);
  const bool is_gone = error == std::errc::no_such_file_or_directory ||
                       error == std::errc::too_many_symbolic_link_levels;
  if (error && !is_gone) refuse(entry.path(), error);
  return is_regular;
}

}  // namespace

std::vector<fs::path> files_below(const fs::path& folder, const FolderWalk& walk) {
  std::vector<fs::path> found;
  std::error_code error;
  fs::recursive_directory_iterator it(folder, error);
  if (error) refuse(folder, error);
  while (it != fs::recursive_directory_iterator()) {
    const fs::path path = it->path();
    std::error_code ignored;
    const bool is_folder = it->is_directory(ignored);
    if (is_folder && !walk.enters(path, it.depth())) it.disable_recursion_pending();
    if (!is_folder && walk.wants(path) && is_file(*it)) found.push_back(path);
    it.increment(error);  // enters the folder
    if (error) refuse(is_folder ? path : path.parent_path(), error);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace triglyph
