// The files that a user names: one by one, by folder, by glob, by manifest, or in a list.
#pragma once

#include <filesystem>
#include <istream>
#include <span>
#include <string>
#include <vector>

namespace triglyph {

// Is this the name of a file format that MeshFile reads, by its ending in any case?
[[nodiscard]] bool is_mesh_name(const std::filesystem::path& path);

// Returns the files in the order named, each once. A folder stands for all meshes in it at any
// depth, sorted by name; a name with wildcards that is no file for what it matches; a .jsonl file
// for the meshes of that manifest; "-" for the names in `list`, one a line, or ended by NUL bytes
// if there are any. Other names stand for themselves, whether or not there is such a file. Throws
// Error Unreadable for a folder that cannot be read, Malformed for a manifest, Usage for a wildcard
// that matches nothing or a name with a control character.
[[nodiscard]] std::vector<std::filesystem::path> gather_files(std::span<const std::string> names,
                                                              std::istream& list);

}  // namespace triglyph
