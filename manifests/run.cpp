#include "manifests/run.h"

#include <new>

#include <sys/resource.h>

#include "engine/base/error.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

std::uint64_t memory_of(const fs::path& path, bool fill) {
  std::error_code error;
  const auto bytes = fs::file_size(path, error);
  return estimate_memory(error ? 0 : bytes, path, fill);
}

std::uint64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

struct MarkItem final : FlowItem {
  explicit MarkItem(Job&& job)
      : marking(std::move(job.mesh), std::move(job.out), std::move(job.request)) {
    index = job.index;
    const MarkedFile& file = marking.result();
    memory_estimate = memory_of(file.mesh, file.request.is_fill());
  }
  FileMarking marking;
};

struct ReadItem final : FlowItem {
  ReadResult result;
};

struct VerifyItem final : FlowItem {
  Record record;
  Verification verification;
};

void read(ReadItem& item, std::span<const Encoding> encodings, std::span<const Key> keys) {
  ReadResult& result = item.result;
  const auto fail = [&](FileStatus status, const std::string& error) {
    result.status = status;
    result.error = error;
  };
  try {
    result.reading = read_file(result.path, encodings, keys);
  } catch (const Error& error) {
    fail(file_status(name_of(error.code())).value_or(FileStatus::Failed), error.what());
  } catch (const Stopped&) {  // then there is no result
    return;
  } catch (const std::bad_alloc&) {
    fail(FileStatus::Failed, result.path.string() + ": not enough memory");
  } catch (const std::exception& error) {
    fail(FileStatus::Failed, result.path.string() + ": " + error.what());
  }
}

void verify(VerifyItem& item, const Key& key, bool locate) {
  try {
    item.verification = verify_file(item.record.file, key, locate);
  } catch (const std::exception& error) {
    item.verification.verdict = FileVerdict::Damaged;
    item.verification.detail = item.record.file.out.string() + ": " + error.what();
  }
}

}  // namespace

void run_jobs(JobSource& jobs, const Key& key, const FlowOptions& options,
              const std::function<void(const Record&)>& on_record, const std::atomic<bool>& stop) {
  const StopScope scope(stop);
  using Stage = std::function<void(FileMarking&)>;
  const auto unless_stopped = [&stop](const Stage& stage) {
    return [stage, &stop](FlowItem& item) {
      FileMarking& marking = static_cast<MarkItem&>(item).marking;
      if (stop) marking.interrupt();
      stage(marking);
    };
  };
  const auto always = [](const Stage& stage) {
    return [stage](FlowItem& item) { stage(static_cast<MarkItem&>(item).marking); };
  };
  Flow flow;
  flow.next = [&jobs]() -> std::unique_ptr<FlowItem> {
    std::optional<Job> job = jobs.next();
    return job ? std::make_unique<MarkItem>(std::move(*job)) : nullptr;
  };
  flow.stages = {unless_stopped([](FileMarking& marking) { marking.load(); }),
                 unless_stopped([&key](FileMarking& marking) { marking.mark(key); }),
                 unless_stopped([](FileMarking& marking) { marking.write(); }),
                 always([&key](FileMarking& marking) { marking.read_back(key); }),
                 always([](FileMarking& marking) { marking.measure(); }),
                 always([](FileMarking& marking) { marking.publish(); })};
  flow.deliver = [&on_record](FlowItem& item) {
    const MarkItem& done = static_cast<MarkItem&>(item);
    on_record({done.marking.result(), done.index, done.memory_estimate, peak_bytes()});
  };
  run_flow(flow, options, stop);
}

void read_files(std::span<const fs::path> files, std::span<const Encoding> encodings,
                std::span<const Key> keys, const FlowOptions& options,
                const std::function<void(const ReadResult&)>& on_result,
                const std::atomic<bool>& stop) {
  const StopScope scope(stop);
  Flow flow;
  std::size_t next = 0;
  flow.next = [&]() -> std::unique_ptr<FlowItem> {
    if (next == files.size()) return nullptr;
    auto item = std::make_unique<ReadItem>();
    item->index = next;
    item->result.path = files[next++];
    item->memory_estimate = memory_of(item->result.path, false);
    return item;
  };
  flow.stages = {[&](FlowItem& item) {
    if (!stop) read(static_cast<ReadItem&>(item), encodings, keys);
  }};
  flow.deliver = [&](FlowItem& item) {
    const ReadResult& result = static_cast<ReadItem&>(item).result;
    if (result.reading || result.status) on_result(result);
  };
  run_flow(flow, options, stop);
}

void verify_files(const RecordSource& records, const Key& key, bool locate,
                  const FlowOptions& options,
                  const std::function<void(const Record&, const Verification&)>& on_verdict,
                  const std::atomic<bool>& stop) {
  const StopScope scope(stop);
  Flow flow;
  std::size_t next = 0;
  flow.next = [&]() -> std::unique_ptr<FlowItem> {
    std::optional<Record> record = records();
    if (!record) return nullptr;
    auto item = std::make_unique<VerifyItem>();
    item->index = next++;
    item->record = std::move(*record);
    item->memory_estimate = memory_of(item->record.file.out, false);
    return item;
  };
  flow.stages = {[&](FlowItem& item) {
    if (!stop) verify(static_cast<VerifyItem&>(item), key, locate);
  }};
  flow.deliver = [&](FlowItem& item) {
    const auto& done = static_cast<VerifyItem&>(item);
    if (!stop) on_verdict(done.record, done.verification);
  };
  run_flow(flow, options, stop);
}

}  // namespace triglyph
