#include "manifests/manifest.h"

#include <algorithm>
#include <functional>
#include <unordered_map>

#include <fnmatch.h>

#include "engine/base/error.h"
#include "manifests/folder_walk.h"
#include "manifests/json_line.h"
#include "manifests/resume.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool has_wildcard(const std::string& text) {
  return text.find_first_of("*?[") != std::string::npos;
}

// Matches component by component; ** matches any number of components, including none.
bool matches(fs::path::iterator pattern, fs::path::iterator pattern_end, fs::path::iterator name,
             fs::path::iterator name_end) {
  if (pattern == pattern_end) return name == name_end;
  const auto rest = std::next(pattern);
  if (*pattern == "**") {
    return matches(rest, pattern_end, name, name_end) ||
           (name != name_end && matches(pattern, pattern_end, std::next(name), name_end));
  }
  return name != name_end && fnmatch(pattern->c_str(), name->c_str(), FNM_PERIOD) == 0 &&
         matches(rest, pattern_end, std::next(name), name_end);
}

// Returns the output path of a mesh whose line does not name a file: below `directory`, at the path
// of the mesh relative to `root`.
fs::path place_below(const fs::path& directory, const fs::path& mesh, const fs::path& root) {
  const fs::path relative = mesh.lexically_relative(root);
  const bool inside = !relative.empty() && *relative.begin() != "..";
  return directory / (inside ? relative : mesh.filename());
}

// The names that a run uses, by hash, and for what.
class NameUses {
 public:
  // Adds a file of the run itself. Throws Error Usage if another has this name.
  void add_own(const OwnFile& own) {
    for (const std::string& name : names_of(own.path)) {
      const unsigned excluded = own.is_written ? kInput | kOutput : kOutput;
      use(name, own.is_written ? kOutput : kInput, excluded, own.path,
          "two files of the run have this name");
      own_.emplace(hash(name), own.what);
    }
  }

  // Adds a job. Throws Error Usage if its output would overwrite what was added, or the other way
  // round.
  void add_job(const Job& job) {
    for (const std::string& name : names_of(job.mesh)) {
      use(name, kInput, kOutput, job.mesh, "an output of the run would overwrite this mesh");
    }
    const std::string out =
        canonical_name(job.out);  // a link of this name is replaced, not followed
    use(out, 0, kInput, job.out, "the output would overwrite a mesh of the run");
    use(out, kOutput, kOutput, job.out, "two meshes of the run have this output");
  }

 private:
  static constexpr unsigned kInput = 1;
  static constexpr unsigned kOutput = 2;

  static std::size_t hash(const std::string& name) { return std::hash<std::string>{}(name); }

  // Returns the name of a file, and that of its target if it is a symbolic link.
  static std::vector<std::string> names_of(const fs::path& path) {
    std::vector<std::string> names = {canonical_name(path)};
    std::error_code error;
    if (!fs::is_symlink(path, error)) return names;
    const fs::path target = fs::canonical(path, error);
    if (!error && target != names[0]) names.push_back(target.string());
    return names;
  }

  void use(const std::string& name, unsigned as, unsigned excluded, const fs::path& path,
           const std::string& clash) {
    unsigned& known = uses_[hash(name)];
    if ((known & excluded) != 0) {
      const auto own = own_.find(hash(name));
      throw Error(ErrorCode::Usage, path, "",
                  own == own_.end() ? clash : "is " + own->second + " of the run as well");
    }
    known |= as;
  }

  std::unordered_map<std::size_t, unsigned> uses_;
  std::unordered_map<std::size_t, std::string> own_;  // what the run's own files are
};

}  // namespace

fs::path glob_root(const fs::path& pattern) {
  fs::path root;
  for (const fs::path& part : pattern.parent_path()) {
    if (has_wildcard(part.string())) break;
    root /= part;
  }
  return root;
}

std::vector<fs::path> expand_glob(const fs::path& pattern) {
  if (!has_wildcard(pattern.string())) return {pattern};
  const fs::path root = glob_root(pattern);
  const fs::path start = root.empty() ? "." : root;
  std::error_code ignored;
  if (!fs::exists(start, ignored) && !ignored) return {};
  const fs::path below = root.empty() ? pattern : pattern.lexically_relative(root);
  const auto depth = static_cast<int>(std::distance(below.begin(), below.end()));
  const bool any_depth = std::find(below.begin(), below.end(), "**") != below.end();
  const FolderWalk walk = {
      .enters = [&](const fs::path&, int at) { return any_depth || at + 1 < depth; },
      .wants =
          [&](const fs::path& file) {
            const fs::path name = file.lexically_relative(start);
            return matches(below.begin(), below.end(), name.begin(), name.end());
          }};
  std::vector<fs::path> found = files_below(start, walk);
  for (fs::path& file : found) file = root / file.lexically_relative(start);
  return found;
}

struct ManifestReader::Line {
  bool is_heading = false;
  std::optional<std::string> mesh;
  std::optional<std::string> out;
  std::shared_ptr<const Recipients> recipients;
  OptionValues values;
};

ManifestReader::ManifestReader(const fs::path& manifest, const OptionValues& values,
                               const fs::path& out_directory)
    : manifest_(manifest), out_directory_(out_directory), defaults_(values), stream_(manifest) {
  if (fs::is_directory(manifest) || !stream_) {
    throw Error(ErrorCode::Unreadable, manifest, "", "the manifest cannot be read");
  }
  note_names();
}

bool ManifestReader::next_line(std::string& line) try {
  ++line_;
  return triglyph::read_line(stream_, line);
} catch (const Error& error) {
  fail(error.message());
}

// Only globs need to know, and only lines that a glob may have matched matter; errors are left to
// the reading proper.
void ManifestReader::note_names() {
  bool has_glob = false;
  std::string line;
  while (next_line(line)) {
    try {
      const Json object = parse_json_line(line);
      if (!object.contains("mesh") || !object["mesh"].is_string()) continue;
      const auto name = object["mesh"].get<std::string>();
      if (has_wildcard(name)) {
        has_glob = true;
      } else {
        named_.insert(std::hash<std::string>{}(canonical_name(manifest_.parent_path() / name)));
      }
    } catch (const Error&) {
      break;
    }
  }
  if (!has_glob) named_.clear();
  stream_.clear();
  stream_.seekg(0);
  line_ = 0;
}

void ManifestReader::fail(const std::string& message) const {
  throw Error(ErrorCode::Malformed, manifest_, at_line(line_), message);
}

std::optional<Job> ManifestReader::next() {
  std::string line;
  while (ready_.empty() && next_line(line)) {
    if (line.find_first_not_of(" \t\r") != line.npos) read_line(line);
  }
  if (ready_.empty()) return std::nullopt;
  Job job = std::move(ready_.front());
  ready_.pop_front();
  job.place = job.index = jobs_++;
  return job;
}

ManifestReader::Line ManifestReader::parse(const std::string& text) const {
  const Json object = parse_json_line(text);
  Line line;
  line.is_heading = object.contains("triglyph");
  if (line.is_heading && (object["triglyph"] != 1 || line_ != 1)) {
    fail("\"triglyph\" stands in the first line and is 1");
  }
  const Json no_keys = Json::object();
  if (line.is_heading) {
    for (const auto& [key, value] : object.items()) {
      if (key != "triglyph" && key != "defaults") fail("unknown key \"" + key + "\"");
    }
    if (object.contains("defaults") && !object["defaults"].is_object()) {
      fail("\"defaults\" is an object");
    }
  }
  const Json& keys = !line.is_heading              ? object
                     : object.contains("defaults") ? object["defaults"]
                                                   : no_keys;
  for (const auto& [key, value] : keys.items()) {
    if (key == "out" || (key == "mesh" && !line.is_heading)) {
      if (!value.is_string()) fail("\"" + key + "\" is a path");
      check_name(value.get_ref<const std::string&>());
      (key == "out" ? line.out : line.mesh) = value.get<std::string>();
      continue;
    }
    if (key == "recipients") {
      if (!value.is_string()) fail("\"recipients\" is the path of a list");
      line.recipients = read_recipients(manifest_.parent_path() / value.get<std::string>());
      continue;
    }
    const OptionSpec* spec = find_mark_option(key);
    if (spec == nullptr) fail("unknown key \"" + key + "\"");
    line.values.emplace(key, spec->checked(option_value(key, value)));
  }
  return line;
}

void ManifestReader::add_jobs(const Line& line) {
  if (!line.mesh) fail("\"mesh\" is missing");
  OptionValues values = layered(defaults_, line.values);
  check_contradictions(line.values, scheme_of(values));
  const auto recipients = line.recipients ? line.recipients : default_recipients_;
  if (recipients) values = layered(values, for_recipient(*recipients));
  const MarkRequest request = resolve(values);
  const std::string out = line.out.value_or(default_out_);
  const fs::path base = manifest_.parent_path();
  const fs::path pattern = base / *line.mesh;
  std::vector<fs::path> meshes = expand_glob(pattern);
  if (meshes.empty()) fail("\"mesh\" matches no file: " + pattern.string());
  const bool is_glob = has_wildcard(pattern.string());
  if (is_glob) leave_out_outputs(meshes, glob_root(pattern), out_directory_);
  if (is_glob && !named_.empty()) {
    std::erase_if(meshes, [&](const fs::path& mesh) {
      return named_.contains(std::hash<std::string>{}(canonical_name(mesh)));
    });
  }
  const bool names_file = !out.empty() && out.back() != '/';
  if (names_file && is_glob) fail("\"out\" of a glob must end in \"/\"");
  if (out.empty() && out_directory_.empty()) fail("\"out\" is missing and no --out was given");
  const fs::path root = is_glob ? glob_root(pattern) : base;
  for (const fs::path& mesh : meshes) {
    const fs::path target =
        names_file ? base / out
                   : place_below(out.empty() ? out_directory_ : base / out, mesh, root);
    if (recipients && names_file) fail("\"out\" of several copies must end in \"/\"");
    ready_.push_back({0, mesh, target, request, recipients});
  }
}

void ManifestReader::read_line(const std::string& text) try {
  const Line line = parse(text);
  if (!line.is_heading) {
    add_jobs(line);
    return;
  }
  check_contradictions(line.values, "");
  defaults_ = layered(defaults_, line.values);
  default_out_ = line.out.value_or(default_out_);
  if (line.recipients) default_recipients_ = line.recipients;
} catch (const Error& error) {
  if (error.path().empty()) fail(error.message());
  throw;
}

OptionValues for_recipient(const Recipients& recipients) {
  return {{"recipient", recipients.front().name}};
}

CopiesSource::CopiesSource(std::unique_ptr<JobSource> meshes,
                           std::shared_ptr<const Recipients> recipients,
                           const fs::path& out_directory)
    : meshes_(std::move(meshes)),
      recipients_(std::move(recipients)),
      out_directory_(out_directory) {}

std::optional<Job> CopiesSource::next() {
  if (!mesh_) {
    mesh_ = meshes_->next();
    if (!mesh_) return std::nullopt;
    recipient_ = 0;
    const bool is_copy = mesh_->request.options.carry == Carry::Fingerprint;
    if (!mesh_->recipients && is_copy) mesh_->recipients = recipients_;
    if (mesh_->recipients) mesh_->copies = std::make_shared<MeshOfCopies>();
  }
  Job job = *mesh_;
  job.place = job.index = jobs_++;
  if (!job.recipients) {
    mesh_.reset();
    return job;
  }
  const Recipient& recipient = (*job.recipients)[recipient_];
  job.request.payload = Message(recipient.name.begin(), recipient.name.end());
  job.out = place_below(job.out.parent_path() / recipient.folder, job.out, job.out.parent_path());
  const fs::path below = mesh_->out.lexically_relative(out_directory_);
  if (!out_directory_.empty() && !below.empty() && *below.begin() != "..") {
    job.out = out_directory_ / recipient.folder / below;
  }
  if (++recipient_ == job.recipients->size()) mesh_.reset();
  return job;
}

MeshList::MeshList(std::vector<NamedFile> meshes, const OptionValues& values,
                   const fs::path& out_directory)
    : meshes_(std::move(meshes)), request_(resolve(values)), out_directory_(out_directory) {}

std::optional<Job> MeshList::next() {
  if (next_ == meshes_.size()) return std::nullopt;
  const NamedFile& mesh = meshes_[next_];
  Job job{next_++, mesh.path, place_below(out_directory_, mesh.path, mesh.root), request_};
  job.place = job.index;
  return job;
}

std::size_t check_plan(JobSource& jobs, std::span<const OwnFile> own_files) {
  NameUses names;
  for (const OwnFile& own : own_files) names.add_own(own);
  std::size_t count = 0;
  while (const std::optional<Job> job = jobs.next()) {
    names.add_job(*job);
    ++count;
  }
  return count;
}

}  // namespace triglyph
