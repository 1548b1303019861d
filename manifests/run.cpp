#include "manifests/run.h"

#include <new>

#include <sys/resource.h>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/stop.h"
#include "engine/marking/refusal.h"
#include "manifests/companions.h"
#include "manifests/share.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

std::uint64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

struct MarkItem final : FlowItem {
  explicit MarkItem(Job&& the_job) : job(std::move(the_job)) {
    index = job.index;
    memory_estimate = memory_of(job.mesh, work_of(job.request));
  }
  [[nodiscard]] std::string_view name() const override { return job.mesh.native(); }
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
    const BoardEntry entry(context_.order, item.index, item.name());
    FileMarking marking(item.job.mesh, item.job.out, item.job.request, item.job.copies);
    if (trace() != nullptr) trace_stages(marking);
    try {
      if (stop_ || !decide(item, marking)) mark(item, marking);
      return;
    } catch (const Error& error) {  // of the ledger or a companion: then there must be no output
      marking.refuse(file_status(error.code()), error.what());
    } catch (const Stopped&) {
      marking.interrupt();
    } catch (const std::bad_alloc&) {
      marking.refuse(FileStatus::Failed, too_little_memory(item.memory_estimate));
    } catch (const std::exception& error) {
      marking.refuse(FileStatus::Failed, error.what());
    }
    describe(item, marking);
  }

 private:
  [[nodiscard]] const RunTrace* trace() const { return context_.flow.trace; }

  void trace_stages(FileMarking& marking) const {
    marking.listen([this, &marking](std::string_view stage, TraceTime start, TraceTime end) {
      const MarkedFile& file = marking.result();
      if (stage != "mark") return trace()->span(stage, file.mesh.native(), start, end);
      trace()->span(stage, file.mesh.native(), start, end,
                    {{"layout_seconds", file.times.layout},
                     {"assign_seconds", file.times.assign},
                     {"faces", static_cast<double>(file.faces)}});
    });
  }

  // Enters the result into the ledger.
  void enter(const Record& record) const {
    const TraceSpan span(trace(), "ledger", record.file.mesh.native());
    context_.resume->enter(record);
  }

  // Returns whether the job is done already. Otherwise it may have been refused.
  bool decide(MarkItem& item, FileMarking& marking) const {
    const Resume* resume = context_.resume;
    if (resume != nullptr) {
      const TraceSpan span(trace(), "plan", item.name());
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
      remove_leftovers(item.job.out.parent_path());
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
    refuse_what_was_issued(item.job.request, marking);
    marking.mark(key_);
    unless_stopped();
    marking.write();
    unless_stopped();
    marking.read_back(key_);
    // a mesh that was read back is nearly done, so it is finished
    marking.measure();
    if (context_.copies_companions && marking.result().is_marked()) {
      const TraceSpan span(trace(), "companions", item.name());
      copy_companions(item.job.mesh, item.job.out);
    }
    describe(item, marking);
    const bool is_worth_a_line = item.record.file.status != FileStatus::Interrupted &&
                                 item.record.file.status != FileStatus::Exists;
    if (context_.resume != nullptr && is_worth_a_line) {
      item.record.line = line_of(item.record);  // once for the ledger, the records and the output
      enter(item.record);
    }
    if (!item.record.file.is_marked()) return;
    if (context_.resume != nullptr && context_.keeps_shapes) context_.resume->keep_shape(marking);
    marking.publish(context_.keeps_times);
    if (marking.result().is_marked() || context_.resume == nullptr) return;
    describe(item, marking);
    enter(item.record);
  }

  // A mark in the same scheme is found by reading; the ledger knows those of every scheme.
  void refuse_what_was_issued(const MarkRequest& request, FileMarking& marking) const {
    if (context_.resume == nullptr || request.options.remark) return;
    const TraceSpan span(trace(), "look up", marking.result().mesh.native());
    if (const auto reason = context_.resume->issued_before(marking.result().input_hash)) {
      marking.refuse(FileStatus::AlreadyMarked, *reason);
    }
  }

  void describe(MarkItem& item, const FileMarking& marking) const {
    Record& record = item.record;
    record.file = marking.result();
    record.file.key_fingerprint = key_.fingerprint();  // also of what was never marked
    record.index = item.job.place;
    if (!context_.shard.is_whole()) {
      record.shard = context_.shard.text();
      record.jobs = context_.jobs_of_all;
    }
    record.memory_estimate = item.memory_estimate;
    record.peak_bytes = peak_bytes();
    record.directory = directory_;
    record.task = task_hash(item.job.request);
    record.line.clear();
  }

  const Key& key_;
  const RunContext& context_;
  Share share_;
  const std::atomic<bool>& stop_;
  std::string directory_;
};

}  // namespace

void run_jobs(JobSource& jobs, const Key& key, const RunContext& context, const RunEvents& events,
              const std::atomic<bool>& stop) {
  const StopScope scope(stop);
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

}  // namespace triglyph
