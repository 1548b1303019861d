#include "manifests/companions.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/io/file_bytes.h"
#include "engine/io/gltf.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

std::string_view next_line_of(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) {
    line.remove_suffix(1);
  }
  while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) line.remove_prefix(1);
  return line;
}

// Returns what follows the keyword, or nothing if the line begins otherwise.
std::optional<std::string_view> after(std::string_view line, std::string_view keyword) {
  if (line.size() <= keyword.size() || line.substr(0, keyword.size()) != keyword) {
    return std::nullopt;
  }
  line.remove_prefix(keyword.size());
  if (line.front() != ' ' && line.front() != '\t') return std::nullopt;
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return line;
}

bool is_inside(const fs::path& name) {
  const fs::path normal = name.lexically_normal();
  return !normal.empty() && normal.is_relative() && *normal.begin() != "..";
}

// Adds the file that a statement names. Names may hold blanks, and options may come before them, so
// the longest ending of the text that is a file counts.
void add_file(std::string_view text, const fs::path& folder, std::vector<fs::path>& found) {
  while (!text.empty()) {
    std::string name(text);
    std::replace(name.begin(), name.end(), '\\', '/');
    std::error_code ignored;
    if (is_inside(name) && fs::is_regular_file(folder / name, ignored)) {
      fs::path normal = fs::path(name).lexically_normal();
      if (std::find(found.begin(), found.end(), normal) == found.end()) {
        found.push_back(std::move(normal));
      }
      return;
    }
    text.remove_prefix(std::min(text.find_first_of(" \t"), text.size()));
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  }
}

void add_textures(const fs::path& library, const fs::path& folder, std::vector<fs::path>& found) {
  std::error_code error;
  if (fs::file_size(folder / library, error) == 0 || error) return;
  const FileBytes file = FileBytes::open(folder / library);
  std::string_view text(file.bytes().data(), file.bytes().size());
  const fs::path below = library.parent_path();
  while (!text.empty()) {
    const std::string_view line = next_line_of(text);
    const std::string_view keyword = line.substr(0, line.find_first_of(" \t"));
    constexpr std::string_view kOthers[] = {"bump", "disp", "decal", "refl", "norm"};
    const bool is_map =
        keyword.substr(0, 4) == "map_" ||
        std::find(std::begin(kOthers), std::end(kOthers), keyword) != std::end(kOthers);
    if (!is_map) continue;
    std::vector<fs::path> named;
    add_file(line.substr(std::min(keyword.size() + 1, line.size())), folder / below, named);
    for (const fs::path& name : named) {
      fs::path whole = (below / name).lexically_normal();
      if (std::find(found.begin(), found.end(), whole) == found.end()) {
        found.push_back(std::move(whole));
      }
    }
  }
}

bool have_same_content(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const auto size = fs::file_size(a, error);
  if (error || fs::file_size(b, error) != size || error) return false;
  if (size == 0) return true;
  const FileBytes first = FileBytes::open(a);
  const FileBytes second = FileBytes::open(b);
  return std::equal(first.bytes().begin(), first.bytes().end(), second.bytes().begin(),
                    second.bytes().end());
}

}  // namespace

std::vector<fs::path> companions_of(const fs::path& mesh) {
  const std::string ending = lower_case_ending(mesh);
  const bool is_obj = ending == ".obj";
  if (ending == ".gltf" || ending == ".glb") {
    std::vector<fs::path> images;
    const FileBytes gltf = FileBytes::open(mesh);
    for (const std::string& name : images_of_gltf(gltf.bytes(), mesh)) {
      add_file(name, mesh.parent_path(), images);
    }
    return images;
  }
  if (!is_obj && ending != ".ply") return {};
  const FileBytes file = FileBytes::open(mesh);
  std::string_view text(file.bytes().data(), file.bytes().size());
  const fs::path folder = mesh.parent_path();
  std::vector<fs::path> found;
  while (!text.empty()) {
    const std::string_view line = next_line_of(text);
    if (!is_obj && line == "end_header") break;
    const auto name = after(line, is_obj ? "mtllib" : "comment TextureFile");
    if (name) add_file(*name, folder, found);
  }
  if (!is_obj) return found;
  const std::vector<fs::path> libraries = found;
  for (const fs::path& library : libraries) add_textures(library, folder, found);
  return found;
}

void copy_companions(const fs::path& mesh, const fs::path& out) {
  for (const fs::path& name : companions_of(mesh)) {
    const fs::path source = mesh.parent_path() / name;
    const fs::path target = out.parent_path() / name;
    std::error_code ignored;
    if (fs::exists(target, ignored)) {
      if (have_same_content(source, target)) continue;
      throw Error(ErrorCode::Usage, target, "",
                  "is there with another content than " + source.string());
    }
    OutputFile copy(target);
    if (fs::file_size(source, ignored) > 0) copy.write(FileBytes::open(source).bytes());
    copy.commit();
  }
}

}  // namespace triglyph
