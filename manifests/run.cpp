#include "manifests/run.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <new>
#include <string_view>
#include <thread>

#include <sys/resource.h>

#include "engine/base/error.h"

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

// Tells the supervisor which item this thread processes.
class BoardEntry {
 public:
  BoardEntry(const WorkOrder* order, std::size_t index)
      : board_(order == nullptr ? nullptr : order->board), index_(index) {
    if (board_ != nullptr) board_->begin(index);
  }
  ~BoardEntry() {
    if (board_ != nullptr) board_->end(index_);
  }
  BoardEntry(const BoardEntry&) = delete;
  BoardEntry& operator=(const BoardEntry&) = delete;

 private:
  RunBoard* board_;
  std::size_t index_;
};

// The part of a run that a worker is to do.
class Share {
 public:
  explicit Share(const RunContext& context) : order_(context.order) {}

  // An earlier worker delivered the item, or a suspect is to be tried alone and this is another.
  [[nodiscard]] bool leaves_out(std::size_t index) const {
    if (order_ == nullptr) return false;
    return order_->only ? *order_->only != index : index < order_->board->delivered;
  }
  [[nodiscard]] bool delivers() const { return order_ == nullptr || !order_->only; }
  void count_delivered(std::size_t index) const {
    if (order_ != nullptr && delivers()) order_->board->delivered = index + 1;
  }
  // What became of an item that an earlier worker died of, or null.
  [[nodiscard]] const Casualty* casualty(std::size_t index) const {
    return order_ == nullptr ? nullptr : order_->casualty(index);
  }

 private:
  const WorkOrder* order_;
};

FileStatus status_of(const Casualty& casualty) {
  return casualty.is_slow ? FileStatus::TooSlow : FileStatus::Crashed;
}

FlowOptions flow_options(const RunContext& context) {
  FlowOptions options = context.flow;
  if (context.order != nullptr && context.order->one_at_a_time) options.memory_bytes = 0;
  return options;
}

// For tests of the supervision: TRIGLYPH_FAULT="crash NAME" or "hang NAME" lets the process die or
// hang when it processes the file of that name.
void fail_if_asked(const fs::path& path) {
  const char* fault = std::getenv("TRIGLYPH_FAULT");
  if (fault == nullptr) return;
  const std::string_view text(fault);
  const std::string name = path.filename().string();
  if (text == "crash " + name) std::raise(SIGSEGV);
  while (text == "hang " + name) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

struct MarkItem final : FlowItem {
  explicit MarkItem(Job&& the_job) : job(std::move(the_job)) {
    index = job.index;
    memory_estimate = memory_of(job.mesh, job.request.is_fill());
  }
  Job job;
  Record record;
  bool is_left_out = false;
};

// Marks one mesh of a run.
class MarkWork {
 public:
  MarkWork(const Key& key, const RunContext& context, const std::atomic<bool>& stop)
      : key_(key), context_(context), share_(context), stop_(stop) {
    std::error_code ignored;
    directory_ = fs::current_path(ignored).string();
  }

  void operator()(MarkItem& item) const {
    item.is_left_out = share_.leaves_out(item.index);
    if (item.is_left_out) return;
    const BoardEntry entry(context_.order, item.index);
    FileMarking marking(item.job.mesh, item.job.out, item.job.request);
    try {
      if (!stop_ && decide(item, marking)) return;
      mark(item, marking);
    } catch (const std::exception& error) {  // of the ledger: then there must be no output
      marking.refuse(FileStatus::Unwritable, error.what());
    }
    describe(item, marking);
  }

 private:
  // Returns whether the job is done already. Otherwise it may have been refused.
  bool decide(MarkItem& item, FileMarking& marking) const {
    const Resume* resume = context_.resume;
    if (resume != nullptr) {
      Decision decision = resume->decide(item.job);
      if (decision.kind == Decision::Kind::Keep) {
        if (!decision.is_of_this_run) resume->keep(item.job);
        item.record = std::move(*decision.record);
        return true;
      }
      if (decision.kind == Decision::Kind::Refuse) {
        marking.refuse(decision.status, decision.reason);
        return false;
      }
    }
    if (const Casualty* casualty = share_.casualty(item.index)) {
      marking.note_input_hash();
      marking.refuse(status_of(*casualty), casualty->reason);
    } else {
      fail_if_asked(item.job.mesh);
    }
    return false;
  }

  void mark(MarkItem& item, FileMarking& marking) const {
    const auto unless_stopped = [&] {
      if (stop_) marking.interrupt();
    };
    unless_stopped();
    marking.load();
    unless_stopped();
    marking.mark(key_);
    unless_stopped();
    marking.write();
    unless_stopped();
    marking.read_back(key_);
    // a mesh that was read back is nearly done, so it is finished
    marking.measure();
    describe(item, marking);
    const bool is_worth_a_line = item.record.file.status != FileStatus::Interrupted &&
                                 item.record.file.status != FileStatus::Exists;
    if (context_.resume != nullptr && is_worth_a_line) context_.resume->enter(item.record);
    if (!item.record.file.is_marked()) return;
    marking.publish();
    if (marking.result().is_marked() || context_.resume == nullptr) return;
    describe(item, marking);
    context_.resume->enter(item.record);
  }

  void describe(MarkItem& item, const FileMarking& marking) const {
    Record& record = item.record;
    record.file = marking.result();
    record.index = item.index;
    record.memory_estimate = item.memory_estimate;
    record.peak_bytes = peak_bytes();
    record.directory = directory_;
    record.task = task_hash(item.job.request);
  }

  const Key& key_;
  const RunContext& context_;
  Share share_;
  const std::atomic<bool>& stop_;
  std::string directory_;
};

struct ReadItem final : FlowItem {
  ReadResult result;
};

struct VerifyItem final : FlowItem {
  Record record;
  Verification verification;
  bool is_done = false;
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

void run_jobs(JobSource& jobs, const Key& key, const RunContext& context, const RunEvents& events,
              const std::atomic<bool>& stop) {
  const MarkWork work(key, context, stop);
  const Share share(context);
  Flow flow;
  flow.next = [&jobs]() -> std::unique_ptr<FlowItem> {
    std::optional<Job> job = jobs.next();
    return job ? std::make_unique<MarkItem>(std::move(*job)) : nullptr;
  };
  flow.work = [&](FlowItem& item) { work(static_cast<MarkItem&>(item)); };
  flow.completed = [&](FlowItem& item) {
    const auto& done = static_cast<MarkItem&>(item);
    if (events.completed && !done.is_left_out) events.completed(done.record);
  };
  flow.deliver = [&](FlowItem& item) {
    const auto& done = static_cast<MarkItem&>(item);
    if (done.is_left_out || !share.delivers()) return;
    if (events.delivered) events.delivered(done.record);
    share.count_delivered(item.index);
  };
  run_flow(flow, flow_options(context), stop);
}

void plan_jobs(JobSource& jobs, const Resume& resume,
               const std::function<void(const Job&, const Decision&)>& on_decision,
               const std::atomic<bool>& stop) {
  struct PlanItem final : FlowItem {
    Job job;
    Decision decision;
  };
  Flow flow;
  flow.next = [&jobs]() -> std::unique_ptr<FlowItem> {
    std::optional<Job> job = jobs.next();
    if (!job) return nullptr;
    auto item = std::make_unique<PlanItem>();
    item->index = job->index;
    item->job = std::move(*job);
    return item;
  };
  flow.work = [&](FlowItem& item) {
    auto& plan = static_cast<PlanItem&>(item);
    try {
      plan.decision = resume.decide(plan.job);
    } catch (const std::exception& error) {
      plan.decision = Decision::refuse(FileStatus::Unwritable, error.what());
    }
  };
  flow.deliver = [&](FlowItem& item) {
    const auto& plan = static_cast<PlanItem&>(item);
    on_decision(plan.job, plan.decision);
  };
  run_flow(flow, {}, stop);
}

void read_files(std::span<const fs::path> files, std::span<const Encoding> encodings,
                std::span<const Key> keys, const RunContext& context,
                const std::function<void(const ReadResult&)>& on_result,
                const std::atomic<bool>& stop) {
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
  const Share share(context);
  flow.work = [&](FlowItem& item) {
    if (stop || share.leaves_out(item.index)) return;
    ReadResult& result = static_cast<ReadItem&>(item).result;
    if (const Casualty* casualty = share.casualty(item.index)) {
      result.status = status_of(*casualty);
      result.error = result.path.string() + ": " + casualty->reason;
      return;
    }
    const BoardEntry entry(context.order, item.index);
    fail_if_asked(result.path);
    read(static_cast<ReadItem&>(item), encodings, keys);
  };
  flow.deliver = [&](FlowItem& item) {
    const ReadResult& result = static_cast<ReadItem&>(item).result;
    if (!share.delivers() || !(result.reading || result.status)) return;
    on_result(result);
    share.count_delivered(item.index);
  };
  run_flow(flow, flow_options(context), stop);
}

void verify_files(const RecordSource& records, const Key& key, bool locate,
                  const RunContext& context,
                  const std::function<void(const Record&, const Verification&)>& on_verdict,
                  const std::atomic<bool>& stop) {
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
  const Share share(context);
  flow.work = [&](FlowItem& item) {
    if (stop || share.leaves_out(item.index)) return;
    auto& verified = static_cast<VerifyItem&>(item);
    verified.is_done = true;
    if (const Casualty* casualty = share.casualty(item.index)) {
      verified.verification.verdict = FileVerdict::Damaged;
      verified.verification.detail = casualty->reason;
      return;
    }
    const BoardEntry entry(context.order, item.index);
    fail_if_asked(verified.record.file.out);
    verify(verified, key, locate);
  };
  flow.deliver = [&](FlowItem& item) {
    const auto& done = static_cast<VerifyItem&>(item);
    if (!share.delivers() || !done.is_done) return;
    on_verdict(done.record, done.verification);
    share.count_delivered(item.index);
  };
  run_flow(flow, flow_options(context), stop);
}

}  // namespace triglyph
