#include "manifests/file_runs.h"

#include <new>

#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/marking/refusal.h"
#include "manifests/share.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// Calls the work, and makes a failure of its exception.
template <typename Work>
void attempt(FileItem& item, const Work& work) {
  const auto fail = [&](FileStatus status, const std::string& error) {
    item.failure = {status, error};
  };
  try {
    work();
  } catch (const Error& error) {
    fail(file_status(error.code()), error.what());
  } catch (const Stopped&) {  // then there is no result
    return;
  } catch (const std::bad_alloc&) {
    fail(FileStatus::Failed, item.file.string() + ": " + too_little_memory(item.memory_estimate));
  } catch (const std::exception& error) {
    fail(FileStatus::Failed, item.file.string() + ": " + error.what());
  }
}

// Runs `work`, which a trace calls `stage`, for every item of the source, and calls `deliver` for
// those that were done. `Item` is derived from FileItem.
template <typename Item, typename Source, typename Work, typename Deliver>
void run_files(std::string_view stage, const Source& source, const Work& work,
               const Deliver& deliver, const RunContext& context, const std::atomic<bool>& stop) {
  const StopScope scope(stop);
  const Share share(context);
  std::size_t next = 0;
  Flow flow;
  flow.next = [&]() -> std::unique_ptr<FlowItem> {
    std::unique_ptr<Item> item = source();
    if (item == nullptr) return nullptr;
    item->index = next++;
    item->memory_estimate = memory_of(item->file, MeshWork::Usual);
    return item;
  };
  flow.work = [&](FlowItem& any) {
    auto& item = static_cast<Item&>(any);
    if (stop || share.leaves_out(item.index)) return;
    if (const Casualty* casualty = share.casualty(item.index)) {
      item.failure = {status_of(*casualty), item.file.string() + ": " + casualty->reason};
    } else {
      const BoardEntry entry(context.order, item.index, item.name());
      const TraceSpan span(context.flow.trace, stage, item.name());
      fail_if_asked(item.file);
      attempt(item, [&] { work(item); });
    }
    item.is_done = !stop;  // what was interrupted has no result
  };
  flow.deliver = [&](FlowItem& any) {
    auto& item = static_cast<Item&>(any);
    if (!share.delivers() || !item.is_done) return;
    deliver(item);
    share.count_delivered(item.index);
  };
  run_flow(flow, flow_options(context), stop);
}

struct ReadItem final : FileItem {
  std::optional<FileReading> reading;
};

struct TraceItem final : FileItem {
  TraceResult result;
};

struct AttackItem final : FileItem {
  AttackResult result;
};

AttackedFile attacked(const AttackJob& job, std::uint64_t seed) {
  if (!job.collusion) return attack_file(job.mesh, job.out, job.attack, seed);
  std::vector<fs::path> copies{job.mesh};
  copies.insert(copies.end(), job.more_copies.begin(), job.more_copies.end());
  return collude_files(copies, job.out, *job.collusion, job.attack, seed);
}

struct VerifyItem final : FileItem {
  Record record;
  Verification verification;
};

struct PairItem final : FileItem {
  PairResult result;
};

}  // namespace

void run_file_items(std::string_view stage,
                    const std::function<std::unique_ptr<FileItem>()>& source,
                    const std::function<void(FileItem&)>& work,
                    const std::function<void(FileItem&)>& deliver, const RunContext& context,
                    const std::atomic<bool>& stop) {
  run_files<FileItem>(stage, source, work, deliver, context, stop);
}

void read_files(std::span<const fs::path> files, std::span<const Encoding> encodings,
                std::span<const Key> keys, const RunContext& context,
                const std::function<void(const ReadResult&)>& on_result,
                const std::atomic<bool>& stop) {
  auto file = files.begin();
  const auto source = [&]() -> std::unique_ptr<ReadItem> {
    if (file == files.end()) return nullptr;
    auto item = std::make_unique<ReadItem>();
    item->file = *file++;
    return item;
  };
  run_files<ReadItem>(
      "read", source, [&](ReadItem& item) { item.reading = read_file(item.file, encodings, keys); },
      [&](ReadItem& item) {
        on_result({item.file, std::move(item.reading), std::move(item.failure)});
      },
      context, stop);
}

void trace_files(std::span<const fs::path> files, std::span<const Suspects> suspects,
                 const TraceOptions& options, std::span<const Encoding> encodings,
                 const RunContext& context,
                 const std::function<void(const TraceResult&)>& on_result,
                 const std::atomic<bool>& stop) {
  std::vector<Key> keys;
  for (const Suspects& each : suspects) keys.push_back(each.key());
  auto file = files.begin();
  const auto source = [&]() -> std::unique_ptr<TraceItem> {
    if (file == files.end()) return nullptr;
    auto item = std::make_unique<TraceItem>();
    item->file = *file++;
    item->result.path = item->file;
    return item;
  };
  run_files<TraceItem>(
      "trace", source,
      [&](TraceItem& item) {
        FileTrace trace = trace_file(item.file, suspects, options);
        const bool names_one = !trace.names.empty() && options.believes(trace.names[0]);
        if (!names_one && !encodings.empty()) {
          item.result.reading = read_file(item.file, encodings, keys);
        }
        item.result.trace = std::move(trace);
      },
      [&](TraceItem& item) {
        item.result.failure = std::move(item.failure);
        on_result(item.result);
      },
      context, stop);
}

void attack_files(std::span<const AttackJob> jobs, std::uint64_t seed, const RunContext& context,
                  const std::function<void(const AttackResult&)>& on_result,
                  const std::atomic<bool>& stop) {
  auto job = jobs.begin();
  const auto source = [&]() -> std::unique_ptr<AttackItem> {
    if (job == jobs.end()) return nullptr;
    auto item = std::make_unique<AttackItem>();
    item->result.job = *job++;
    item->file = item->result.job.mesh;
    return item;
  };
  run_files<AttackItem>(
      "attack", source,
      [&](AttackItem& item) { item.result.attacked = attacked(item.result.job, seed); },
      [&](AttackItem& item) {
        item.result.failure = std::move(item.failure);
        on_result(item.result);
      },
      context, stop);
}

void verify_files(const RecordSource& records, const Key& key, bool locate,
                  const RunContext& context,
                  const std::function<void(const Record&, const Verification&)>& on_verdict,
                  const std::atomic<bool>& stop) {
  const auto source = [&]() -> std::unique_ptr<VerifyItem> {
    std::optional<Record> record = records();
    if (!record) return nullptr;
    auto item = std::make_unique<VerifyItem>();
    item->record = std::move(*record);
    item->file = item->record.file.out;
    return item;
  };
  run_files<VerifyItem>(
      "verify", source,
      [&](VerifyItem& item) { item.verification = verify_file(item.record.file, key, locate); },
      [&](VerifyItem& item) {
        if (item.failure) {
          item.verification.verdict = FileVerdict::Damaged;
          item.verification.detail = item.failure->error;
        }
        on_verdict(item.record, item.verification);
      },
      context, stop);
}

void run_pairs(const PairSource& pairs, const std::function<void(PairResult&)>& work,
               const RunContext& context, const std::function<void(const PairResult&)>& on_result,
               const std::atomic<bool>& stop) {
  const auto source = [&]() -> std::unique_ptr<PairItem> {
    std::optional<MeshPair> pair = pairs();
    if (!pair) return nullptr;
    auto item = std::make_unique<PairItem>();
    item->file = pair->original;
    item->result.pair = std::move(*pair);
    return item;
  };
  run_files<PairItem>(
      "pair", source, [&](PairItem& item) { work(item.result); },
      [&](PairItem& item) {
        if (item.failure) item.result.failure = std::move(item.failure);
        on_result(item.result);
      },
      context, stop);
}

}  // namespace triglyph
