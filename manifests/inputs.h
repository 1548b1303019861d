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

// A file, and the folder in which its place matters: the folder named, the fixed part of the
// pattern, or that of a file named for itself.
struct NamedFile {
  std::filesystem::path path;
  std::filesystem::path root;
};

// Returns the files in the order named, without duplicates. A folder stands for all meshes in it at
// any depth, sorted by name; a pattern, unless a file has that name, for its matches; a .jsonl file
// for the meshes of that manifest; "-" for the names in `list`, one per line, or separated by NUL
// bytes if it has any. Other names stand for themselves, whether or not such a file exists. Throws
// Error Unreadable for a folder that cannot be read, Malformed for an invalid manifest, and Usage
// for a pattern without matches or a name with a control character. What a folder or a pattern
// finds below `outputs` is left out, if that is a folder below its root: it is what a run before
// wrote.
[[nodiscard]] std::vector<NamedFile> gather_named_files(std::span<const std::string> names,
                                                        std::istream& list,
                                                        const std::filesystem::path& outputs = {});
[[nodiscard]] std::vector<std::filesystem::path> gather_files(std::span<const std::string> names,
                                                              std::istream& list);

// Removes the files below `outputs`, if that is a folder below `root`.
void leave_out_outputs(std::vector<std::filesystem::path>& files, const std::filesystem::path& root,
                       const std::filesystem::path& outputs);

// Throws Error Usage for a name that is empty or holds a control character, which no mesh needs and
// which would mislead those who read it on a terminal; also NUL, at which the system cuts it off.
void check_name(const std::string& name);

}  // namespace triglyph
