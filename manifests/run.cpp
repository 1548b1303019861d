#include "manifests/run.h"

#include <algorithm>
#include <exception>
#include <variant>

#include <tbb/flow_graph.h>
#include <tbb/task_arena.h>

#include "manifests/pipeline.h"

namespace triglyph {
namespace {

using TaskPointer = std::shared_ptr<Task>;

// Jobs that may be known to the graph at once: enough to choose large ones first and to keep
// records in order while one mesh takes long, few enough to cost no memory.
constexpr std::size_t kWindow = 256;

// A mesh has let go of its memory.
struct Released {
  std::uint64_t bytes = 0;
};

// Decides which waiting mesh may start: the largest that fits into the budget; a mesh larger than
// the whole budget when nothing else is in work. Runs in a serial node, so it needs no lock.
class Admission {
 public:
  explicit Admission(std::uint64_t budget) : budget_(budget) {}

  void wait(const TaskPointer& task) {
    const auto larger = [](const TaskPointer& a, const TaskPointer& b) {
      return a->record.memory_estimate > b->record.memory_estimate;
    };
    waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), task, larger), task);
  }

  void release(std::uint64_t bytes) {
    in_work_ -= bytes;
    --meshes_in_work_;
  }

  // The next mesh to start, or nothing.
  TaskPointer admit() {
    const auto fits = [&](const TaskPointer& task) {
      return meshes_in_work_ == 0 || in_work_ + task->record.memory_estimate <= budget_;
    };
    const auto next = std::find_if(waiting_.begin(), waiting_.end(), fits);
    if (next == waiting_.end()) return nullptr;
    TaskPointer task = *next;
    waiting_.erase(next);
    in_work_ += task->record.memory_estimate;
    ++meshes_in_work_;
    return task;
  }

 private:
  std::uint64_t budget_;
  std::uint64_t in_work_ = 0;
  std::size_t meshes_in_work_ = 0;
  std::vector<TaskPointer> waiting_;  // largest first
};

TaskPointer make_task(Job job) {
  auto task = std::make_shared<Task>(std::move(job));
  std::error_code error;
  const auto bytes = std::filesystem::file_size(task->record.job.mesh, error);
  task->record.memory_estimate =
      estimate_memory(error ? 0 : bytes, task->record.job.mesh.extension().string());
  return task;
}

// load -> mark -> write -> read back -> measure of one mesh, between checks for an interrupt.
class Stages {
 public:
  Stages(const Key& key, const std::atomic<bool>& stop) : key_(key), stop_(stop) {}

  void run_load(Task& task) const {
    if (!interrupted(task)) load(task);
  }
  void run_mark(Task& task) const {
    if (!interrupted(task)) mark(task, key_);
  }
  void run_write(Task& task) const {
    if (!interrupted(task)) write(task);
  }
  void run_read_back(Task& task) const { read_back(task, key_); }

 private:
  bool interrupted(Task& task) const {
    if (!stop_) return task.record.status == Status::Interrupted;
    if (task.stands() || task.record.error.empty()) {
      task.record.status = Status::Interrupted;
      task.record.error = task.record.job.mesh.string() + ": interrupted";
    }
    return true;
  }

  const Key& key_;
  const std::atomic<bool>& stop_;
};

namespace flow = tbb::flow;

// A message to the admission node: a mesh that waits, or memory that is free again.
using Request = std::variant<TaskPointer, Released>;

// source -> window -> admit -> load -> mark -> write -> read back -> measure -> in order -> record
//             ^         ^                                              |                      |
//             |         +------------------- memory released ---------+                      |
//             +------------------------------ one more may be known -------------------------+
class MarkGraph {
 public:
  MarkGraph(JobSource& jobs, const Key& key, const RunOptions& options,
            const std::function<void(const Record&)>& on_record, const std::atomic<bool>& stop)
      : jobs_(jobs),
        stop_(stop),
        stages_(key, stop),
        admission_(options.memory_bytes),
        source_(graph_, [this](tbb::flow_control& control) { return next_task(control); }),
        window_(graph_, kWindow),
        announce_(graph_, flow::serial, [](const TaskPointer& task) { return Request(task); }),
        admit_(graph_, flow::serial,
               [this](const Request& request, auto& ports) { decide(request, ports); }),
        load_(stage(&Stages::run_load)),
        mark_(stage(&Stages::run_mark)),
        write_(stage(&Stages::run_write)),
        read_back_(stage(&Stages::run_read_back)),
        measure_(graph_, flow::unlimited,
                 [](const TaskPointer& task, auto& ports) {
                   measure(*task);
                   std::get<1>(ports).try_put(Released{task->record.memory_estimate});
                   std::get<0>(ports).try_put(task);
                 }),
        in_order_(graph_, [](const TaskPointer& task) { return task->record.job.index; }),
        record_(graph_, flow::serial, [&on_record](const TaskPointer& task) {
          on_record(task->record);
          return 1;
        }) {
    connect();
  }

  void run() {
    source_.activate();
    graph_.wait_for_all();
    if (broken_manifest_) std::rethrow_exception(broken_manifest_);
  }

 private:
  using Stage = flow::function_node<TaskPointer, TaskPointer>;

  Stage stage(void (Stages::*work)(Task&) const) {
    return {graph_, flow::unlimited, [this, work](const TaskPointer& task) {
              (stages_.*work)(*task);
              return task;
            }};
  }

  TaskPointer next_task(tbb::flow_control& control) {
    try {
      if (!stop_) {
        if (std::optional<Job> job = jobs_.next()) return make_task(std::move(*job));
      }
    } catch (...) {
      broken_manifest_ = std::current_exception();
    }
    control.stop();
    return nullptr;
  }

  template <typename Ports>
  void decide(const Request& request, Ports& ports) {
    if (const auto* task = std::get_if<TaskPointer>(&request)) admission_.wait(*task);
    if (const auto* released = std::get_if<Released>(&request)) admission_.release(released->bytes);
    while (const TaskPointer task = admission_.admit()) std::get<0>(ports).try_put(task);
  }

  void connect() {
    flow::make_edge(source_, window_);
    flow::make_edge(window_, announce_);
    flow::make_edge(announce_, admit_);
    flow::make_edge(flow::output_port<0>(admit_), load_);
    flow::make_edge(load_, mark_);
    flow::make_edge(mark_, write_);
    flow::make_edge(write_, read_back_);
    flow::make_edge(read_back_, measure_);
    flow::make_edge(flow::output_port<0>(measure_), in_order_);
    flow::make_edge(flow::output_port<1>(measure_), admit_);
    flow::make_edge(in_order_, record_);
    flow::make_edge(record_, window_.decrementer());
  }

  JobSource& jobs_;
  const std::atomic<bool>& stop_;
  Stages stages_;
  Admission admission_;
  std::exception_ptr broken_manifest_;

  flow::graph graph_;
  flow::input_node<TaskPointer> source_;
  flow::limiter_node<TaskPointer, int> window_;
  flow::function_node<TaskPointer, Request> announce_;
  flow::multifunction_node<Request, std::tuple<TaskPointer>> admit_;
  Stage load_, mark_, write_, read_back_;
  flow::multifunction_node<TaskPointer, std::tuple<TaskPointer, Request>> measure_;
  flow::sequencer_node<TaskPointer> in_order_;
  flow::function_node<TaskPointer, int> record_;
};

}  // namespace

void run_jobs(JobSource& jobs, const Key& key, const RunOptions& options,
              const std::function<void(const Record&)>& on_record, const std::atomic<bool>& stop) {
  MarkGraph(jobs, key, options, on_record, stop).run();
}

}  // namespace triglyph
