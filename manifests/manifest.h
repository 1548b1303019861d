// Lists of meshes to mark. A manifest is JSON Lines: an optional first object {"triglyph": 1,
// "defaults": {...}}, then one object per mesh. "mesh" may be a glob (*, ?, [..], ** for any
// depth). Paths are relative to the manifest. It is read as a stream, so its length takes no
// memory.
#pragma once

#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "manifests/inputs.h"
#include "manifests/job.h"

namespace triglyph {

// Supplies jobs in order, numbered from 0.
class JobSource {
 public:
  virtual ~JobSource() = default;
  // Returns the next job, or nothing at the end.
  [[nodiscard]] virtual std::optional<Job> next() = 0;
};

// The keys of a line are "mesh", "out", "recipients", a list as read_recipients() takes it, and the
// options of marking (mark_option_specs()); "defaults" takes all of these but "mesh". A mesh that
// one line names is not among the matches of another line's glob, so that a line may override a
// glob. "out" names a file, or a directory if it ends in
// "/". Without it the output goes to `out_directory`, at the path of the mesh relative to the
// manifest, or to the fixed part of the glob.
class ManifestReader final : public JobSource {
 public:
  // `values` applies where the manifest gives no value. Reads the manifest once to find the meshes
  // that are named for themselves. Throws Error Unreadable.
  ManifestReader(const std::filesystem::path& manifest, const OptionValues& values,
                 const std::filesystem::path& out_directory);

  // Throws Error Malformed, naming the line, for invalid JSON, for keys that are unknown, repeated,
  // contradictory or out of range, for a glob without matches, and if there is no output path.
  [[nodiscard]] std::optional<Job> next() override;

 private:
  struct Line;  // a parsed line

  void note_names();
  bool next_line(std::string& line);
  void read_line(const std::string& line);
  [[nodiscard]] Line parse(const std::string& line) const;
  void add_jobs(const Line& line);
  [[noreturn]] void fail(const std::string& message) const;

  std::filesystem::path manifest_;
  std::filesystem::path out_directory_;
  OptionValues defaults_;
  std::string default_out_;
  std::shared_ptr<const Recipients> default_recipients_;
  std::ifstream stream_;
  std::size_t line_ = 0;
  std::size_t jobs_ = 0;
  std::deque<Job> ready_;
  std::unordered_set<std::size_t> named_;  // hashes of the meshes that lines name for themselves
};

// Returns the values that ask for copies for these recipients: of all, those of the first.
[[nodiscard]] OptionValues for_recipient(const Recipients& recipients);

// Jobs for meshes that are named on the command line; the output lies below `out_directory` as the
// mesh does below its root.
class MeshList final : public JobSource {
 public:
  // Throws Error Usage as resolve() does.
  MeshList(std::vector<NamedFile> meshes, const OptionValues& values,
           const std::filesystem::path& out_directory);
  [[nodiscard]] std::optional<Job> next() override;

 private:
  std::vector<NamedFile> meshes_;
  MarkRequest request_;
  std::filesystem::path out_directory_;
  std::size_t next_ = 0;
};

// Makes the jobs of another source one for each recipient, who gets a copy of the mesh in a folder
// of its own below the folder of the outputs; jobs without recipients stay as they are. Copies of a
// mesh follow each other and share it.
class CopiesSource final : public JobSource {
 public:
  // `out_directory` is that of the source. Recipients apply to jobs that have none of their own;
  // null: there are none.
  CopiesSource(std::unique_ptr<JobSource> meshes, std::shared_ptr<const Recipients> recipients,
               const std::filesystem::path& out_directory);
  [[nodiscard]] std::optional<Job> next() override;

 private:
  std::unique_ptr<JobSource> meshes_;
  std::shared_ptr<const Recipients> recipients_;
  std::filesystem::path out_directory_;
  std::optional<Job> mesh_;    // of which copies are left
  std::size_t recipient_ = 0;  // the next
  std::size_t jobs_ = 0;
};

// Returns the files that match a pattern with *, ?, [..] or **, sorted. A pattern without wildcards
// matches itself. Throws Error Unreadable for a folder in which there may be matches and that
// cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> expand_glob(const std::filesystem::path& pattern);

// Returns the longest leading directory of a pattern that has no wildcards.
[[nodiscard]] std::filesystem::path glob_root(const std::filesystem::path& pattern);

// A file of the run itself.
struct OwnFile {
  std::filesystem::path path;
  std::string what;         // "the records"
  bool is_written = false;  // otherwise the run reads it
};

// Checks a run before it starts, and returns the number of jobs. Throws Error Usage if an output or
// a file of the run would overwrite an input, an output or another file of the run. Takes 16 bytes
// of memory per job.
std::size_t check_plan(JobSource& jobs, std::span<const OwnFile> own_files = {});

}  // namespace triglyph
