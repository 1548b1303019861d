// Lists of meshes. A manifest is JSON Lines: an optional first object {"triglyph": 1, "defaults":
// {...}}, then one object a mesh; "mesh" may be a glob (*, ?, [..], ** for any depth). Paths are
// relative to the manifest. It is read as a stream, so a million lines cost no memory.
#pragma once

#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "manifests/job.h"

namespace triglyph {

// Hands out jobs in order; numbered from 0.
class JobSource {
 public:
  virtual ~JobSource() = default;
  [[nodiscard]] virtual std::optional<Job> next() = 0;
};

// Keys of one line: mesh, out, and every option of marking (mark_option_specs); "defaults" takes
// all but mesh. A line's "out" is a file, or a directory if it ends in "/"; without it the output
// goes to `out_directory`, under the path below the manifest (or below the fixed part of the glob).
class ManifestReader final : public JobSource {
 public:
  // Values that the manifest does not name are taken from `values`. Throws Error Unreadable.
  ManifestReader(const std::filesystem::path& manifest, const OptionValues& values,
                 const std::filesystem::path& out_directory);

  // Throws Error Malformed naming the manifest's line: bad JSON, keys that are unknown, come twice,
  // contradict each other or have values out of range, a glob that matches nothing, no place for
  // the output.
  [[nodiscard]] std::optional<Job> next() override;

 private:
  struct Line;  // what a line says

  void read_line(const std::string& line);
  [[nodiscard]] Line parse(const std::string& line) const;
  void add_jobs(const Line& line);
  [[noreturn]] void fail(const std::string& message) const;

  std::filesystem::path manifest_;
  std::filesystem::path out_directory_;
  OptionValues defaults_;
  std::string default_out_;
  std::ifstream stream_;
  std::size_t line_ = 0;
  std::size_t jobs_ = 0;
  std::deque<Job> ready_;
};

// Meshes named one by one; each output is `out_directory` / file name.
class MeshList final : public JobSource {
 public:
  // Throws Error Usage for values that make no request: see resolve().
  MeshList(std::vector<std::filesystem::path> meshes, const OptionValues& values,
           const std::filesystem::path& out_directory);
  [[nodiscard]] std::optional<Job> next() override;

 private:
  std::vector<std::filesystem::path> meshes_;
  MarkRequest request_;
  std::filesystem::path out_directory_;
  std::size_t next_ = 0;
};

// Files that match a pattern with *, ?, [..] or **, sorted; a pattern without wildcards is itself.
[[nodiscard]] std::vector<std::filesystem::path> expand_glob(const std::filesystem::path& pattern);

// The longest leading part of a pattern without wildcards, a directory.
[[nodiscard]] std::filesystem::path glob_root(const std::filesystem::path& pattern);

// Looks at a whole run before it starts. Throws Error Usage if an output would overwrite an input
// or another output. Returns the number of jobs. 16 bytes of memory a job.
std::size_t check_plan(JobSource& jobs);

}  // namespace triglyph
