#include "manifests/run.h"

#include <algorithm>
#include <exception>
#include <thread>
#include <variant>

#include <tbb/flow_graph.h>
#include <tbb/global_control.h>
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

  void wait(TaskPointer task) {
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

}  // namespace

void run_jobs(JobSource& jobs, const Key& key, const RunOptions& options,
              const std::function<void(const Record&)>& on_record, const std::atomic<bool>& stop) {
  namespace flow = tbb::flow;
  using AdmissionNode =
      flow::multifunction_node<std::variant<TaskPointer, Released>, std::tuple<TaskPointer>>;
  using MeasureNode =
      flow::multifunction_node<TaskPointer,
                               std::tuple<TaskPointer, std::variant<TaskPointer, Released>>>;

  flow::graph graph;
  const Stages stages(key, stop);
  Admission admission(options.memory_bytes);
  std::exception_ptr broken_manifest;

  flow::input_node<TaskPointer> source(graph, [&](tbb::flow_control& control) -> TaskPointer {
    try {
      if (!stop && !broken_manifest) {
        if (std::optional<Job> job = jobs.next()) return make_task(std::move(*job));
      }
    } catch (...) {
      broken_manifest = std::current_exception();
    }
    control.stop();
    return nullptr;
  });
  flow::limiter_node<TaskPointer, int> window(graph, kWindow);
  flow::function_node<TaskPointer, std::variant<TaskPointer, Released>> announce(
      graph, flow::serial,
      [](const TaskPointer& task) { return std::variant<TaskPointer, Released>(task); });
  AdmissionNode admit(graph, flow::serial, [&](const auto& message, auto& ports) {
    if (const auto* task = std::get_if<TaskPointer>(&message)) admission.wait(*task);
    if (const auto* released = std::get_if<Released>(&message)) admission.release(released->bytes);
    while (TaskPointer task = admission.admit()) std::get<0>(ports).try_put(task);
  });
  const auto stage = [&](void (Stages::*work)(Task&) const) {
    return flow::function_node<TaskPointer, TaskPointer>(graph, flow::unlimited,
                                                         [&stages, work](TaskPointer task) {
                                                           (stages.*work)(*task);
                                                           return task;
                                                         });
  };
  auto load_node = stage(&Stages::run_load);
  auto mark_node = stage(&Stages::run_mark);
  auto write_node = stage(&Stages::run_write);
  auto read_back_node = stage(&Stages::run_read_back);
  MeasureNode measure_node(graph, flow::unlimited, [](TaskPointer task, auto& ports) {
    measure(*task);
    std::get<1>(ports).try_put(Released{task->record.memory_estimate});
    std::get<0>(ports).try_put(std::move(task));
  });
  flow::sequencer_node<TaskPointer> in_order(
      graph, [](const TaskPointer& task) { return task->record.job.index; });
  flow::function_node<TaskPointer, int> record_node(graph, flow::serial,
                                                    [&](const TaskPointer& task) {
                                                      on_record(task->record);
                                                      return 1;
                                                    });

  flow::make_edge(source, window);
  flow::make_edge(window, announce);
  flow::make_edge(announce, admit);
  flow::make_edge(flow::output_port<0>(admit), load_node);
  flow::make_edge(load_node, mark_node);
  flow::make_edge(mark_node, write_node);
  flow::make_edge(write_node, read_back_node);
  flow::make_edge(read_back_node, measure_node);
  flow::make_edge(flow::output_port<0>(measure_node), in_order);
  flow::make_edge(flow::output_port<1>(measure_node), admit);
  flow::make_edge(in_order, record_node);
  flow::make_edge(record_node, window.decrementer());

  source.activate();
  graph.wait_for_all();
  if (broken_manifest) std::rethrow_exception(broken_manifest);
}

void with_threads(int threads, const std::function<void()>& work) {
  const int count =
      threads > 0 ? threads : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(count));
  tbb::task_arena arena(count);
  arena.execute(work);
}

}  // namespace triglyph
