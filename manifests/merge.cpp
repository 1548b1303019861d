#include "manifests/merge.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "manifests/json_line.h"
#include "manifests/record.h"
#include "manifests/records_file.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// A line of one of the files.
struct ShardLine {
  std::uint64_t place = 0;
  std::uint64_t begin = 0;
  std::uint32_t size = 0;
  std::uint32_t file = 0;
  int worth = 0;
};

// Returns what a record is worth beside another of the same place: a shard that was ended, or whose
// machine failed, has less to say than one that came to its end.
int worth_of(const Record& record) {
  if (record.file.is_marked()) return 2;
  return record.file.status == FileStatus::Interrupted ? 0 : 1;
}

nlohmann::ordered_json without_run(const std::string& line) {
  nlohmann::ordered_json json = parse_json_line(line);
  json.erase("run");
  return json;
}

// The lines of all files, whose places are known.
class ShardLines {
 public:
  explicit ShardLines(std::span<const fs::path> files) : files_(files) {
    for (std::uint32_t file = 0; file < files.size(); ++file) add(file);
    std::stable_sort(lines_.begin(), lines_.end(), [](const ShardLine& a, const ShardLine& b) {
      return a.place != b.place ? a.place < b.place : a.worth > b.worth;
    });
  }

  [[nodiscard]] const std::vector<ShardLine>& sorted() const { return lines_; }
  [[nodiscard]] std::uint64_t jobs() const { return jobs_; }

  [[nodiscard]] std::string text(const ShardLine& line) {
    std::string text(line.size, '\0');
    std::ifstream& stream = *streams_[line.file];
    stream.clear();
    stream.seekg(static_cast<std::streamoff>(line.begin));
    if (!stream.read(text.data(), static_cast<std::streamsize>(text.size()))) {
      throw Error(ErrorCode::Unreadable, files_[line.file], "", "changed while it was read");
    }
    return text;
  }

  [[noreturn]] void fail_to_agree(const ShardLine& a, const ShardLine& b) const {
    std::string message = "the record of place ";
    message.append(std::to_string(b.place)).append(" is another than in ");
    message.append(files_[a.file].string());
    throw Error(ErrorCode::Malformed, files_[b.file], "", message);
  }

 private:
  void add(std::uint32_t file) {
    streams_.push_back(std::make_unique<std::ifstream>(files_[file], std::ios::binary));
    std::ifstream& stream = *streams_.back();
    if (fs::is_directory(files_[file]) || !stream) {
      throw Error(ErrorCode::Unreadable, files_[file], "", "the records cannot be read");
    }
    std::string line;
    std::uint64_t begin = 0;
    for (std::size_t number = 1;; ++number) {
      try {
        if (!read_line(stream, line)) return;
        const Record record = parse_record(line);
        lines_.push_back(
            {record.index, begin, static_cast<std::uint32_t>(line.size()), file, worth_of(record)});
        note_jobs(record.jobs, file);
      } catch (const Error& error) {
        throw Error(error.code(), files_[file], at_line(number), error.message());
      }
      begin += line.size() + 1;
    }
  }

  void note_jobs(std::uint64_t jobs, std::uint32_t file) {
    if (jobs == 0) return;
    if (jobs_ != 0 && jobs != jobs_) {
      throw Error(ErrorCode::Malformed, files_[file], "",
                  "is of a run of " + std::to_string(jobs) + " jobs, others are of one of " +
                      std::to_string(jobs_));
    }
    jobs_ = jobs;
  }

  std::span<const fs::path> files_;
  std::vector<std::unique_ptr<std::ifstream>> streams_;
  std::vector<ShardLine> lines_;
  std::uint64_t jobs_ = 0;
};

bool names_output(const LedgerItem& item) {
  return !item.output_hash.empty();
}

// Enters one ledger after another.
class LedgerMerge {
 public:
  explicit LedgerMerge(Ledger& out) : out_(out) {
    out.for_each_run([&](const LedgerRun& run) { runs_.emplace(identity_of(run), run.id); });
  }

  void add(const Ledger& from) {
    std::map<std::int64_t, std::int64_t> numbers;  // of runs, here by there
    from.for_each_run([&](const LedgerRun& run) { numbers[run.id] = number_of(run); });
    std::map<std::string, std::uint64_t> places;  // by output
    for_each_item(from, [&](LedgerItem item) {
      places[item.target] = item.place;
      item.run = numbers.at(item.run);
      add_item(item, from);
    });
    from.for_each_mark([&](const LedgerMark& mark) {
      const auto place = places.find(mark.out);
      marks_.emplace(place == places.end() ? 0 : place->second, mark);
    });
    from.for_each_result([&](LedgerResult result) {
      result.run = numbers.at(result.run);
      out_.note(result);
    });
    from.for_each_state([&](LedgerState state) {
      const std::optional<LedgerState> known = out_.state_of(state.target);
      state.run = numbers.at(state.run);
      if (!known || known->checked < state.checked) out_.put_state(state);
    });
    from.for_each_shape([&](const LedgerShape& shape) { out_.put_shape(shape); });
  }

  // Enters the marks of all, in the order of their places.
  void finish() {
    for (const auto& [place, mark] : marks_) out_.put_mark(mark);
  }

 private:
  static std::string identity_of(const LedgerRun& run) {
    return run.verb + '\0' + run.command + '\0' + run.directory + '\0' + run.version + '\0' +
           run.started;
  }

  std::int64_t number_of(const LedgerRun& run) {
    const auto known = runs_.find(identity_of(run));
    if (known != runs_.end()) return known->second;
    const std::int64_t number = out_.put_run(run);
    runs_.emplace(identity_of(run), number);
    return number;
  }

  template <typename Visit>
  static void for_each_item(const Ledger& ledger, const Visit& visit) {
    std::string last;
    while (std::optional<LedgerItem> item = ledger.find_after(last)) {
      last = item->target;
      visit(std::move(*item));
    }
  }

  void add_item(const LedgerItem& item, const Ledger& from) {
    const std::optional<LedgerItem> known = out_.find(item.target);
    if (!known) {
      out_.put(item, std::nullopt);
      return;
    }
    const bool same_work =
        known->input_hash == item.input_hash && known->task == item.task && known->key == item.key;
    if (same_work && names_output(*known) && names_output(item) &&
        known->output_hash != item.output_hash) {
      throw Error(ErrorCode::Malformed, from.path(), "",
                  "the ledger: " + item.target + " has other bytes than in " +
                      out_.path().string() + ", though mesh, options and key are the same");
    }
    const bool replaces = names_output(item) != names_output(*known)
                              ? names_output(item)
                              : item.finished > known->finished;
    if (replaces) out_.put(item, std::nullopt);
  }

  Ledger& out_;
  std::map<std::string, std::int64_t> runs_;        // by what they are
  std::multimap<std::uint64_t, LedgerMark> marks_;  // by place
};

}  // namespace

MergedRecords merge_records(std::span<const fs::path> files, const fs::path& out) {
  ShardLines lines(files);
  MergedRecords merged;
  merged.jobs = lines.jobs();
  std::error_code ignored;
  if (fs::exists(out, ignored)) check_holds_records(out);
  OutputFile file(out);
  const ShardLine* last = nullptr;
  const auto note_gap = [&](std::uint64_t first, std::uint64_t end) {
    if (first < end) merged.gaps.push_back({first, end - 1});
  };
  for (const ShardLine& line : lines.sorted()) {
    std::string text = lines.text(line);
    if (last != nullptr && last->place == line.place) {
      const bool are_both_marked = last->worth == 2 && line.worth == 2;
      if (are_both_marked && without_run(lines.text(*last)) != without_run(text)) {
        lines.fail_to_agree(*last, line);
      }
      continue;
    }
    note_gap(last == nullptr ? 0 : last->place + 1, line.place);
    text += '\n';
    file.write(text);
    ++merged.records;
    last = &line;
  }
  note_gap(last == nullptr ? 0 : last->place + 1, merged.jobs);
  file.commit();
  return merged;
}

void merge_ledgers(std::span<const fs::path> ledgers, Ledger& out) {
  out.in_one_step([&] {
    LedgerMerge merge(out);
    for (const fs::path& path : ledgers) merge.add(Ledger(path));
    merge.finish();
  });
}

}  // namespace triglyph
