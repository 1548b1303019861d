// Input files as users name them: by name, folder, glob, manifest, or list.
#pragma once

#include <filesystem>
#include <istream>
#include <span>
#include <string>
#include <vector>

namespace triglyph {

// Returns whether the extension, in any case, is that of a format that MeshFile reads.
[[nodiscard]] bool is_mesh_name(const std::filesystem::path& path);

// Returns the files in the order named, without duplicates. A folder stands for all meshes in it at
// any depth, sorted by name; a pattern, unless a file has that name, for its matches; a .jsonl file
// for the meshes of that manifest; "-" for the names in `list`, one per line, or separated by NUL
// bytes if it has any. Other names stand for themselves, whether or not such a file exists. Throws
// Error Unreadable for a folder that cannot be read, Malformed for an invalid manifest, and Usage
// for a pattern without matches or a name with a control character.
[[nodiscard]] std::vector<std::filesystem::path> gather_files(std::span<const std::string> names,
                                                              std::istream& list);

}  // namespace triglyph
