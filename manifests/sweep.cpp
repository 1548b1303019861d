#include "manifests/sweep.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <mutex>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/io/file_bytes.h"
#include "engine/marking/verify_file.h"
#include "manifests/file_runs.h"
#include "manifests/folder_walk.h"
#include "manifests/inputs.h"
#include "manifests/json_line.h"
#include "manifests/resume.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> kStateNames{"intact",    "altered",   "mark damaged",
                                                      "mark lost", "damaged",   "moved",
                                                      "missing",   "wrong key", "unreadable"};

// What a look at a file found.
struct Finding {
  FileState state = FileState::Intact;
  std::string hash;  // empty: it could not be read
  std::string detail;
  fs::path moved_to;
  std::optional<Verification> verification;  // if the mark was read
};

struct SweepItem final : FileItem {
  LedgerItem output;
  std::optional<LedgerState> known;  // from an earlier look, at the same output
  bool is_of_this_run = false;       // `known` is
  Finding finding;
};

bool lies_below(std::string_view name, std::string_view folder) {
  return name.starts_with(folder) &&
         (name.size() == folder.size() || folder.ends_with('/') || name[folder.size()] == '/');
}

// Returns the folders in which a file that is missing may be: the one that all outputs share, if it
// is not a whole file system or nearly so, else those in which outputs are.
std::vector<fs::path> folders_of(const Ledger& ledger) {
  std::string last;
  fs::path common;
  std::vector<fs::path> folders;
  while (const std::optional<LedgerItem> item = ledger.find_after(last)) {
    last = item->target;
    const fs::path folder = fs::path(item->target).parent_path();
    if (folders.empty()) common = folder;
    if (folders.empty() || folders.back() != folder) folders.push_back(folder);
    const auto [end, ignored] =
        std::mismatch(common.begin(), common.end(), folder.begin(), folder.end());
    fs::path shared;
    for (auto part = common.begin(); part != end; ++part) shared /= *part;
    common = shared;
  }
  // "/", "/home": who keeps outputs all over the disk does not want all of it read
  constexpr auto kFewestParts = 3;
  if (std::distance(common.begin(), common.end()) >= kFewestParts) return {common};
  std::sort(folders.begin(), folders.end());
  std::vector<fs::path> outermost;
  for (const fs::path& folder : folders) {
    if (outermost.empty() || !lies_below(folder.string(), outermost.back().string())) {
      outermost.push_back(folder);
    }
  }
  return outermost;
}

// Files that are no outputs of the ledger, by the hash of their bytes. They are hashed when the
// first output is missing.
class Strays {
 public:
  Strays(const Ledger& ledger, const SweepOptions& options) : ledger_(ledger), options_(options) {}

  // Returns the first file with this hash, by name, or nothing.
  [[nodiscard]] std::optional<fs::path> find(const std::string& hash) {
    std::call_once(once_, [this] { gather(); });
    const auto found = by_hash_.find(hash);
    if (found == by_hash_.end()) return std::nullopt;
    return found->second;
  }

 private:
  void gather() {
    std::vector<fs::path> folders = folders_of(ledger_);
    folders.insert(folders.end(), options_.search.begin(), options_.search.end());
    for (const fs::path& folder : folders) {
      std::error_code ignored;
      if (!fs::is_directory(folder, ignored)) continue;
      const FolderWalk walk{.enters = [](const fs::path&, int) { return true; },
                            .wants = [](const fs::path& file) { return is_mesh_name(file); }};
      for (const fs::path& file : files_below(folder, walk)) add(file);
    }
  }

  void add(const fs::path& file) {
    const std::string name = canonical_name(file);
    if (ledger_.find(name)) return;
    try {
      by_hash_.try_emplace(content_hash(FileBytes::open(file).bytes()), name);
    } catch (const Error&) {
      return;  // it is not what is sought
    }
  }

  const Ledger& ledger_;
  const SweepOptions& options_;
  std::once_flag once_;
  std::map<std::string, fs::path> by_hash_;
};

// Returns a number in [0, 1) that depends on the name and the seed alone.
double share_of(std::string_view name, std::uint64_t seed) {
  const std::string hash = content_hash(std::to_string(seed) + " " + std::string(name));
  constexpr int kDigits = 12;  // 48 bits, which a double holds
  return static_cast<double>(std::stoull(hash.substr(0, kDigits), nullptr, 16)) /
         static_cast<double>(std::uint64_t{1} << (4 * kDigits));
}

bool has_output(const LedgerItem& item) {
  return item.status == name_of(FileStatus::Marked) ||
         item.status == name_of(FileStatus::Traceable);
}

// The outputs that a sweep looks at, by name.
class SweepSource {
 public:
  SweepSource(const Ledger& ledger, const SweepOptions& options, std::int64_t run)
      : ledger_(ledger), options_(options), run_(run), met_(options.selection.below.size(), 0) {}

  std::unique_ptr<SweepItem> next() {
    while (!is_out_of_time_) {
      if (options_.deadline && std::chrono::steady_clock::now() >= *options_.deadline) {
        is_out_of_time_ = true;
        return nullptr;
      }
      std::optional<LedgerItem> output = ledger_.find_after(last_);
      if (!output) {
        expect_all_met();
        return nullptr;
      }
      last_ = output->target;
      if (!has_output(*output) || !is_selected(*output)) continue;
      return item_of(std::move(*output));
    }
    return nullptr;
  }

  [[nodiscard]] bool is_out_of_time() const { return is_out_of_time_; }
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  bool is_selected(const LedgerItem& output) {
    const SweepSelection& selection = options_.selection;
    bool is_below = selection.below.empty();
    for (std::size_t i = 0; i < selection.below.size(); ++i) {
      if (!lies_below(output.target, selection.below[i])) continue;
      is_below = true;
      met_[i] = 1;
    }
    if (!is_below || output.finished < selection.marked_since) return false;
    // seed 0 is that of the parts; runs count from 1
    const auto part =
        static_cast<std::uint32_t>(share_of(output.target, 0) * selection.part.count) + 1;
    return part == selection.part.number &&
           (selection.sample >= 1 ||
            share_of(output.target, static_cast<std::uint64_t>(run_)) < selection.sample);
  }

  void expect_all_met() const {
    for (std::size_t i = 0; i < met_.size(); ++i) {
      if (met_[i] != 0) continue;
      throw Error(ErrorCode::Usage, options_.selection.below[i], "",
                  "the ledger knows no output of this name or below it");
    }
  }

  std::unique_ptr<SweepItem> item_of(LedgerItem&& output) {
    ++count_;
    auto item = std::make_unique<SweepItem>();
    item->file = output.target;
    item->known = ledger_.state_of(output.target);
    // what was said of an output that was made anew since says nothing of this one
    if (item->known && item->known->expected != output.output_hash) item->known.reset();
    item->is_of_this_run = item->known && item->known->run == run_;
    item->output = std::move(output);
    return item;
  }

  const Ledger& ledger_;
  const SweepOptions& options_;
  std::int64_t run_;
  std::string last_;
  std::vector<char> met_;  // of the selection's names: an output lies there
  std::uint64_t count_ = 0;
  bool is_out_of_time_ = false;
};

// Looks at one file after another; its members may be called from any thread.
class Sweeper {
 public:
  Sweeper(const Ledger& ledger, std::span<const Key> keys, const SweepOptions& options)
      : ledger_(ledger), keys_(keys), options_(options), strays_(ledger, options) {}

  void look_at(SweepItem& item) {
    std::error_code error;
    const fs::file_status status = fs::status(item.file, error);
    if (status.type() == fs::file_type::not_found) {
      item.finding = absent(item.output);
      return;
    }
    try {
      const FileBytes file = FileBytes::open(item.file);
      item.finding.hash = content_hash(file.bytes());
    } catch (const Error& cause) {
      item.finding.state = FileState::Unreadable;
      item.finding.detail = cause.what();
      return;
    }
    read_mark(item);
  }

 private:
  [[nodiscard]] Finding absent(const LedgerItem& output) {
    const std::optional<fs::path> elsewhere = strays_.find(output.output_hash);
    if (!elsewhere) return {FileState::Missing, {}, output.target + ": no such file", {}, {}};
    return {FileState::Moved, output.output_hash, "is now " + elsewhere->string(), *elsewhere, {}};
  }

  [[nodiscard]] const Key* key_of(const LedgerItem& output) const {
    const auto key = std::find_if(keys_.begin(), keys_.end(),
                                  [&](const Key& one) { return one.fingerprint() == output.key; });
    return key == keys_.end() ? nullptr : &*key;
  }

  void read_mark(SweepItem& item) {
    Finding& finding = item.finding;
    const Key* key = key_of(item.output);
    if (key == nullptr) {
      finding.state = FileState::WrongKey;
      finding.detail = "was marked under another key, " + item.output.key;
      if (finding.hash == item.output.output_hash) finding.detail += "; its bytes are unchanged";
      return;
    }
    if (!options_.reads_all && is_known(item)) return;
    MarkedFile marked = parse_record(item.output.record).file;
    marked.mesh = item.output.source;
    marked.out = item.file;
    std::error_code ignored;
    if (marked.needs_original && !fs::exists(marked.mesh, ignored)) {
      judge_without_original(item);
      return;
    }
    finding.verification = verify_file(marked, *key, true);
    judge(item, marked);
  }

  // Bytes that were read before carry what they carried then.
  [[nodiscard]] static bool is_known(SweepItem& item) {
    if (!item.known || item.known->hash != item.finding.hash) return false;
    const std::optional<FileState> state = file_state(item.known->state);
    if (!state || *state > FileState::Damaged) return false;
    item.finding.state = *state;
    return true;
  }

  static void judge_without_original(SweepItem& item) {
    if (item.finding.hash == item.output.output_hash) return;  // intact
    item.finding.state = FileState::Unreadable;
    item.finding.detail = "the bytes differ from those written, and " + item.output.source +
                          ", with which its mark is read, is not there";
  }

  void judge(SweepItem& item, const MarkedFile& marked) const {
    Finding& finding = item.finding;
    const Verification& found = *finding.verification;
    finding.detail = found.detail;
    const bool is_whole = found.damage ? found.damage->units_damaged == 0
                                       : found.units_found >= marked.units_embedded;
    switch (found.verdict) {
      case FileVerdict::Intact:
        finding.state = FileState::Intact;
        finding.detail.clear();
        return;
      case FileVerdict::Altered:
        finding.state = is_whole && found.detail.find(';') == std::string::npos
                            ? FileState::Altered
                            : FileState::MarkDamaged;
        break;
      case FileVerdict::Lost:
        finding.state = FileState::MarkLost;
        break;
      case FileVerdict::Missing:  // it went while it was looked at
        finding.state = FileState::Missing;
        return;
      case FileVerdict::Damaged:
      case FileVerdict::NotMarked:
        finding.state = FileState::Damaged;
        break;
    }
    if (const std::optional<LedgerMark> other = ledger_.mark_of(finding.hash)) {
      finding.detail += "; the bytes are those of " + other->out;
    }
  }

  const Ledger& ledger_;
  std::span<const Key> keys_;
  const SweepOptions& options_;
  Strays strays_;
};

nlohmann::ordered_json json_of(const SweptFile& file, const SweepItem& item) {
  const Finding& finding = item.finding;
  nlohmann::ordered_json json;
  put_path(json, "out", file.target);
  json["change"] = file.change();
  json["state"] = name_of(file.state);
  json["before"] = name_of(file.before);
  if (file.is_accepted) json["accepted"] = true;
  if (!finding.detail.empty()) json["detail"] = finding.detail;
  if (!finding.moved_to.empty()) put_path(json, "moved_to", finding.moved_to);
  if (!finding.verification || file.state == FileState::Intact) return json;
  const Verification& found = *finding.verification;
  json["units_recorded"] = parse_record(item.output.record).file.units_embedded;
  json["units_found"] = found.units_found;
  if (found.damage) {
    json["damage"] = {{"units_expected", found.damage->units_expected},
                      {"units_damaged", found.damage->units_damaged},
                      {"vertices", found.damage->vertices}};
  }
  return json;
}

// Returns what is said of a file that nobody had to look at again.
nlohmann::ordered_json json_again(const SweptFile& file, const LedgerState& known) {
  nlohmann::ordered_json json = parse_json_line(known.line);
  json["change"] = file.change();
  json["before"] = name_of(file.before);
  json.erase("accepted");
  if (file.is_accepted) json["accepted"] = true;
  return json;
}

// Returns the file as an earlier process of this run found it.
SweptFile swept_before(const SweepItem& item) {
  const LedgerState& known = *item.known;
  const nlohmann::ordered_json json = parse_json_line(known.line);
  SweptFile file;
  file.target = item.output.target;
  file.state = file_state(known.state).value_or(FileState::Unreadable);
  file.before = file_state(json.value("before", "")).value_or(FileState::Intact);
  file.is_new = known.change != "unchanged";
  file.is_accepted = known.is_accepted;
  file.is_kept = true;
  file.line = known.line;
  return file;
}

// Compares what was found with what was known.
SweptFile swept_now(const SweepItem& item, bool accepts) {
  SweptFile file;
  file.target = item.output.target;
  file.state = item.finding.state;
  if (item.known) file.before = file_state(item.known->state).value_or(FileState::Intact);
  // a sweep without the key learned nothing of the mark
  if (file.state != file.before && file.before == FileState::WrongKey) {
    file.before = FileState::Intact;
  }
  const bool is_same_content =
      file.state == FileState::Intact || !item.known || item.known->hash == item.finding.hash;
  file.is_new = file.state != file.before || !is_same_content;
  file.is_accepted = accepts || (!file.is_new && item.known && item.known->is_accepted);
  const bool is_known =
      item.known && !item.finding.verification && !file.is_new && file.state <= FileState::Damaged;
  nlohmann::ordered_json json = is_known ? json_again(file, *item.known) : json_of(file, item);
  file.line = to_line(json);
  file.line.pop_back();  // the newline
  return file;
}

}  // namespace

std::string_view name_of(FileState state) {
  return kStateNames[static_cast<std::size_t>(state)];
}

std::optional<FileState> file_state(std::string_view name) {
  const auto found = std::find(kStateNames.begin(), kStateNames.end(), name);
  if (found == kStateNames.end()) return std::nullopt;
  return static_cast<FileState>(found - kStateNames.begin());
}

std::vector<std::string_view> file_state_names() {
  return {kStateNames.begin(), kStateNames.end()};
}

std::string_view SweptFile::change() const {
  if (!is_new) return "unchanged";
  return state == FileState::Intact ? "restored" : name_of(state);
}

bool SweptFile::is_news() const {
  return !is_accepted && (is_new || state != FileState::Intact);
}

SweepEnd sweep(Ledger& ledger, std::int64_t run, std::span<const Key> keys,
               const SweepOptions& options, const RunContext& context,
               const std::function<void(const SweptFile&)>& on_file,
               const std::atomic<bool>& stop) {
  SweepSource source(ledger, options, run);
  Sweeper sweeper(ledger, keys, options);
  run_file_items(
      "sweep", [&] { return source.next(); },
      [&](FileItem& any) {
        auto& item = static_cast<SweepItem&>(any);
        if (!item.is_of_this_run) sweeper.look_at(item);
      },
      [&](FileItem& any) {
        auto& item = static_cast<SweepItem&>(any);
        if (item.is_of_this_run) {
          on_file(swept_before(item));
          return;
        }
        if (item.failure) {
          item.finding = {FileState::Unreadable, {}, item.failure->error, {}, {}};
        }
        const SweptFile file = swept_now(item, options.accepts);
        ledger.put_state({.target = file.target,
                          .state = std::string(name_of(file.state)),
                          .change = std::string(file.change()),
                          .expected = item.output.output_hash,
                          .hash = item.finding.hash,
                          .is_accepted = file.is_accepted,
                          .line = file.line,
                          .run = run});
        on_file(file);
      },
      context, stop);
  return {source.count(), source.is_out_of_time()};
}

std::optional<std::int64_t> unfinished_sweep(const Ledger& ledger, const std::string& command,
                                             const std::string& directory) {
  std::optional<std::int64_t> last;
  ledger.for_each_run([&](const LedgerRun& run) {
    if (run.verb != "sweep") return;
    const bool came_to_its_end =
        !run.ended.empty() && run.outcome != "interrupted" && run.outcome != kOutOfTime;
    const bool is_this = run.command == command && run.directory == directory;
    last = is_this && !came_to_its_end ? std::optional(run.id) : std::nullopt;
  });
  return last;
}

}  // namespace triglyph
