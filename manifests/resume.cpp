#include "manifests/resume.h"

#include <algorithm>
#include <array>

#include "engine/base/error.h"
#include "engine/io/file_bytes.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// Returns the hash of the file's content, or nothing if it cannot be read.
std::optional<std::string> hash_of_file(const fs::path& path) {
  try {
    return content_hash(FileBytes::open(path).bytes());
  } catch (const Error&) {
    return std::nullopt;
  }
}

// Returns whether the same input, request and key always end so, without an output.
bool is_final_refusal(FileStatus status) {
  constexpr std::array kFinal = {
      FileStatus::TooSmall,      FileStatus::TooCoarse,   FileStatus::TooVisible,
      FileStatus::AlreadyMarked, FileStatus::NotVerified, FileStatus::Malformed,
      FileStatus::Unsupported,   FileStatus::Crashed,     FileStatus::TooSlow};
  return std::find(kFinal.begin(), kFinal.end(), status) != kFinal.end();
}

std::string options_text(const MarkOptions& options) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [key, value] : values_of(options)) json[key] = to_json(value);
  return json.dump();
}

}  // namespace

std::string canonical_name(const fs::path& path) {
  // the names of a run mostly lie in one folder after another, and looking a folder up takes a
  // system call for each part of its name
  thread_local std::pair<fs::path, fs::path> last;
  fs::path parent = path.parent_path();
  if (last.second.empty() || last.first != parent) {
    std::error_code error;
    const fs::path absolute = fs::absolute(parent.empty() ? "." : parent, error);
    if (error) throw Error(ErrorCode::Unreadable, path, "", error.message());
    fs::path directory = fs::weakly_canonical(absolute, error);
    if (error) directory = absolute;  // as below a file, or where it is forbidden to look
    last = {std::move(parent), std::move(directory)};
  }
  return (last.second / path.filename()).lexically_normal().string();
}

std::string task_hash(const MarkRequest& request) {
  const std::string payload = request.is_fill() ? "fill" : to_hex(request.message());
  const std::string text = payload + " " + options_text(request.options);
  return content_hash(text);
}

void enter_record(Ledger& ledger, std::int64_t run, const Record& record) {
  const MarkedFile& file = record.file;
  LedgerItem item;
  item.target = canonical_name(file.out);
  item.source = canonical_name(file.mesh);
  item.input_hash = file.input_hash;
  item.task = record.task;
  item.key = file.key_fingerprint;
  item.status = name_of(file.status);
  item.output_hash = file.output_hash;
  item.record = line_of(record);
  item.record.pop_back();
  item.run = run;
  item.place = record.index;
  std::optional<LedgerMark> mark;
  if (file.is_marked()) {
    mark.emplace();
    if (!file.request.is_fill()) mark->message_hex = to_hex(file.request.message());
    if (file.request.options.carry == Carry::Fingerprint) {
      mark->recipient.assign(file.request.message().begin(), file.request.message().end());
    }
    mark->mesh = item.source;
    mark->out = item.target;
    mark->scheme =
        file.needs_original ? std::string(kPointsScheme) : file.request.options.scheme_name();
    mark->options = options_text(file.request.options);
    mark->key = file.key_fingerprint;
    mark->input_hash = file.input_hash;
    mark->output_hash = file.output_hash;
  }
  ledger.put(item, mark);
}

Resume::Resume(Ledger& ledger, std::int64_t run, const Key& key, const ResumeOptions& options,
               const Ledger* base)
    : ledger_(ledger), base_(base), run_(run), key_(key.fingerprint()), options_(options) {}

Decision Resume::decide(const Job& job) const {
  std::optional<LedgerItem> known = ledger_.find(canonical_name(job.out));
  const bool is_of_this_run = known && known->run == run_;
  if (!known && base_ != nullptr) known = base_->find(canonical_name(job.out));
  if (options_.force && !is_of_this_run) return Decision::mark("--force");
  std::error_code ignored;
  if (!known) {
    if (!options_.no_clobber || !fs::exists(job.out, ignored)) return Decision::mark();
    return Decision::refuse(FileStatus::Exists, job.out.string() +
                                                    " exists, and the ledger does not know it; "
                                                    "without --no-clobber it is replaced");
  }
  const bool has_output = known->status == name_of(FileStatus::Marked) ||
                          known->status == name_of(FileStatus::Traceable);
  if (known->source != canonical_name(job.mesh)) {
    if (!has_output || !fs::exists(job.out, ignored)) return Decision::mark("another mesh");
    return Decision::refuse(FileStatus::Exists, job.out.string() + " was made from " +
                                                    known->source + "; --force replaces it");
  }
  if (known->task != task_hash(job.request)) return Decision::mark("other options");
  if (known->key != key_) return Decision::mark("another key");
  const std::optional<FileStatus> status = file_status(known->status);
  if (!status || !(has_output || is_final_refusal(*status))) {
    return Decision::mark("it ended as " + known->status);
  }
  // a mesh that crashed may have no hash
  if (!known->input_hash.empty() && hash_of_file(job.mesh) != known->input_hash) {
    return Decision::mark("the mesh changed");
  }
  if (has_output && hash_of_file(job.out) != known->output_hash) {
    return Decision::mark("the output is gone or changed");
  }
  Decision decision;
  try {
    decision.record = parse_record(known->record);
  } catch (const Error&) {
    return Decision::mark("its record cannot be read");
  }
  decision.kind = Decision::Kind::Keep;
  decision.is_of_this_run = is_of_this_run;
  decision.record->index = job.place;
  decision.record->file.mesh = job.mesh;
  decision.record->file.out = job.out;
  decision.record->is_kept = !is_of_this_run;
  return decision;
}

std::optional<std::string> Resume::issued_before(const std::string& input_hash) const {
  std::optional<LedgerMark> mark = ledger_.mark_of(input_hash);
  if (!mark && base_ != nullptr) mark = base_->mark_of(input_hash);
  if (!mark || mark->key != key_) return std::nullopt;
  return "was issued as " + mark->out + " with " +
         (mark->message_hex.empty() ? "a filled mark" : shown(from_hex(mark->message_hex))) +
         " in scheme " + mark->scheme + "; --remark marks it again";
}

void Resume::enter(const Record& record) const {
  enter_record(ledger_, run_, record);
}

void Resume::keep_shape(const FileMarking& marking) const {
  const std::string& hash = marking.result().input_hash;
  if (ledger_.has_shape(hash) || (base_ != nullptr && base_->has_shape(hash))) return;
  const std::vector<char> bytes = marking.kept_shape();
  if (!bytes.empty()) ledger_.put_shape({hash, {bytes.begin(), bytes.end()}});
}

void Resume::keep(const Job& job) const {
  const std::string target = canonical_name(job.out);
  if (base_ != nullptr && !ledger_.find(target)) {
    if (std::optional<LedgerItem> item = base_->find(target)) {
      item->run = run_;
      item->place = job.place;
      ledger_.put(*item, std::nullopt);
    }
    return;
  }
  ledger_.keep(target, run_, job.place);
}

}  // namespace triglyph
