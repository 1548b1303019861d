#include "manifests/inputs.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <unordered_set>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/io/mesh_file.h"
#include "manifests/folder_walk.h"
#include "manifests/manifest.h"
#include "manifests/resume.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> meshes_in_folder(const fs::path& folder) {
  const auto is_hidden = [](const fs::path& path) {
    return path.filename().string().front() == '.';
  };
  return files_below(
      folder,
      {.enters = [&](const fs::path& inner, int) { return !is_hidden(inner); },
       .wants = [&](const fs::path& file) { return !is_hidden(file) && is_mesh_name(file); }});
}

std::vector<std::string> names_in(std::istream& list) {
  const std::string text{std::istreambuf_iterator<char>(list), std::istreambuf_iterator<char>()};
  const char separator = text.find('\0') == text.npos ? '\n' : '\0';
  std::vector<std::string> names;
  for (std::size_t start = 0; start < text.size();) {
    std::size_t end = std::min(text.find(separator, start), text.size());
    const std::size_t next = end + 1;
    if (separator == '\n' && end > start && text[end - 1] == '\r') --end;
    if (end > start) names.push_back(text.substr(start, end - start));
    start = next;
  }
  return names;
}

std::vector<fs::path> meshes_of_manifest(const fs::path& manifest) {
  // only the meshes matter here, not the message and the outputs
  ManifestReader reader(manifest, {{"message", std::string("any")}}, ".");
  std::vector<fs::path> meshes;
  while (std::optional<Job> job = reader.next()) meshes.push_back(std::move(job->mesh));
  return meshes;
}

std::vector<NamedFile> with_root(std::vector<fs::path> paths, const fs::path& root) {
  std::vector<NamedFile> files;
  for (fs::path& path : paths) files.push_back({std::move(path), root});
  return files;
}

std::vector<NamedFile> files_named(const std::string& name, const fs::path& outputs) {
  check_name(name);
  const fs::path path(name);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  // what cannot be looked at may be a folder, unless its name is a mesh's, which costs one record
  if (status.type() == fs::file_type::none && !is_mesh_name(path)) {
    throw Error(ErrorCode::Unreadable, path, "", error.message());
  }
  if (fs::is_directory(status)) {
    std::vector<fs::path> found = meshes_in_folder(path);
    leave_out_outputs(found, path, outputs);
    return with_root(std::move(found), path);
  }
  if (path.extension() == ".jsonl") return with_root(meshes_of_manifest(path), path.parent_path());
  if (fs::exists(status) || name.find_first_of("*?[") == name.npos) {
    return {{path, path.parent_path()}};
  }
  std::vector<fs::path> found = expand_glob(path);
  if (found.empty()) throw Error(ErrorCode::Usage, path, "", "matches no file");
  leave_out_outputs(found, glob_root(path), outputs);
  return with_root(std::move(found), glob_root(path));
}

}  // namespace

bool is_mesh_name(const fs::path& path) {
  const auto endings = mesh_endings();
  return std::find(endings.begin(), endings.end(), lower_case_ending(path)) != endings.end();
}

void check_name(const std::string& name) {
  const bool has_control =
      std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == 127; });
  if (name.empty() || has_control) {
    throw Error(ErrorCode::Usage, {}, "", "a file name is empty or holds a control character");
  }
}

void leave_out_outputs(std::vector<fs::path>& files, const fs::path& root,
                       const fs::path& outputs) {
  if (outputs.empty()) return;
  const auto lies_below = [](const fs::path& path, const fs::path& folder) {
    const fs::path relative = path.lexically_relative(folder);
    return !relative.empty() && relative != "." && *relative.begin() != "..";
  };
  const fs::path folder = canonical_name(outputs / "");
  if (!lies_below(folder, canonical_name(root / ""))) return;
  std::erase_if(files,
                [&](const fs::path& file) { return lies_below(canonical_name(file), folder); });
}

std::vector<NamedFile> gather_named_files(std::span<const std::string> names, std::istream& list,
                                          const fs::path& outputs) {
  std::vector<NamedFile> files;
  std::unordered_set<std::string> known;
  const auto add = [&](const std::string& name) {
    for (NamedFile& file : files_named(name, outputs)) {
      if (known.insert(file.path.string()).second) files.push_back(std::move(file));
    }
  };
  for (const std::string& name : names) {
    if (name != "-") {
      add(name);
      continue;
    }
    for (const std::string& listed : names_in(list)) add(listed);
  }
  return files;
}

std::vector<fs::path> gather_files(std::span<const std::string> names, std::istream& list) {
  std::vector<fs::path> paths;
  for (NamedFile& file : gather_named_files(names, list)) paths.push_back(std::move(file.path));
  return paths;
}

}  // namespace triglyph
