#include "manifests/flow.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <tuple>
#include <variant>

#include <tbb/flow_graph.h>

namespace triglyph {
namespace {

// Flow graph nodes copy their messages, so items travel as shared pointers.
using ItemPointer = std::shared_ptr<FlowItem>;

// Most items in the graph at once: enough to start large ones first and to deliver in order while
// one takes long, few enough to take hardly any memory.
constexpr std::size_t kWindow = 256;

// The message that an item has released its memory.
struct Released {
  std::uint64_t bytes = 0;
};

// Selects the waiting item that may start: the largest that fits into the budget, or one larger
// than the whole budget if no other is in process. Runs in a serial node, so it needs no lock.
class Admission {
 public:
  explicit Admission(std::uint64_t budget) : budget_(budget) {}

  void wait(const ItemPointer& item) {
    const auto larger = [](const ItemPointer& a, const ItemPointer& b) {
      return a->memory_estimate > b->memory_estimate;
    };
    waiting_.insert(std::upper_bound(waiting_.begin(), waiting_.end(), item, larger), item);
  }

  void release(std::uint64_t bytes) {
    in_work_ -= bytes;
    --items_in_work_;
  }

  // Returns the next item to start, or null.
  ItemPointer admit() {
    const auto fits = [&](const ItemPointer& item) {
      return items_in_work_ == 0 || in_work_ + item->memory_estimate <= budget_;
    };
    const auto next = std::find_if(waiting_.begin(), waiting_.end(), fits);
    if (next == waiting_.end()) return nullptr;
    ItemPointer item = *next;
    waiting_.erase(next);
    in_work_ += item->memory_estimate;
    ++items_in_work_;
    return item;
  }

  // `in_work` is the number of items that threads work on; the other items that may start wait for
  // a thread.
  void trace(const RunTrace& trace, std::size_t in_work) const {
    const std::size_t ready = items_in_work_ - std::min(in_work, items_in_work_);
    trace.count("items", {{"waiting for memory", static_cast<double>(waiting_.size())},
                          {"waiting for a thread", static_cast<double>(ready)},
                          {"in work", static_cast<double>(in_work)}});
    trace.count("bytes in flight", {{"bytes", static_cast<double>(in_work_)}});
    trace.count_memory();
  }

 private:
  std::uint64_t budget_;
  std::uint64_t in_work_ = 0;
  std::size_t items_in_work_ = 0;
  std::vector<ItemPointer> waiting_;  // largest first
};

namespace tbbflow = tbb::flow;

// A message to the admission node: an item that waits, or memory that is free again.
using Request = std::variant<ItemPointer, Released>;

// Delivers items in their order, each as soon as all before it are there. It is called by the
// thread that completed an item: as a node of the graph it would wait while a single thread has
// other items to process, and a run that is killed would know nothing of the files that it wrote.
class Delivery {
 public:
  Delivery(const Flow& flow, const RunTrace* trace) : flow_(flow), trace_(trace) {}

  // Returns the number of items delivered.
  int take(const ItemPointer& item) {
    TraceSpan wait(trace_, "wait to deliver", item->name());
    const std::lock_guard lock(mutex_);
    wait.end();
    if (flow_.completed) {
      const TraceSpan span(trace_, "records", item->name());
      flow_.completed(*item);
    }
    waiting_.emplace(item->index, item);
    int delivered = 0;
    for (auto first = waiting_.begin(); first != waiting_.end() && first->first == next_;
         first = waiting_.erase(first)) {
      const TraceSpan span(trace_, "deliver", first->second->name());
      flow_.deliver(*first->second);
      ++next_;
      ++delivered;
    }
    if (trace_ != nullptr) {
      trace_->count("items undelivered", {{"items", static_cast<double>(waiting_.size())}});
    }
    return delivered;
  }

 private:
  const Flow& flow_;
  const RunTrace* trace_;
  std::mutex mutex_;
  std::map<std::size_t, ItemPointer> waiting_;  // by index
  std::size_t next_ = 0;
};

// source -> window -> announce -> admit -> work, completion and delivery
//             ^                     ^         |   |
//             |                     +- memory +   |
//             +---- that many more may be known --+
class Graph {
 public:
  Graph(const Flow& flow, const FlowOptions& options, const std::atomic<bool>& stop)
      : flow_(flow),
        stop_(stop),
        trace_(options.trace),
        admission_(options.memory_bytes),
        delivery_(flow, options.trace),
        source_(graph_, [this](tbb::flow_control& control) { return next_item(control); }),
        window_(graph_, kWindow),
        announce_(graph_, tbbflow::serial, [](const ItemPointer& item) { return Request(item); }),
        admit_(graph_, tbbflow::serial,
               [this](const Request& request, auto& ports) { decide(request, ports); }),
        work_(graph_, tbbflow::unlimited, [this](const ItemPointer& item, auto& ports) {
          unless_failed([&] { work_on(*item); });
          std::get<0>(ports).try_put(Released{item->memory_estimate});
          int delivered = 0;
          unless_failed([&] { delivered = delivery_.take(item); });
          if (delivered > 0) std::get<1>(ports).try_put(delivered);
        }) {
    tbbflow::make_edge(source_, window_);
    tbbflow::make_edge(window_, announce_);
    tbbflow::make_edge(announce_, admit_);
    tbbflow::make_edge(tbbflow::output_port<0>(admit_), work_);
    tbbflow::make_edge(tbbflow::output_port<0>(work_), admit_);
    tbbflow::make_edge(tbbflow::output_port<1>(work_), window_.decrementer());
  }

  void run() {
    try {
      source_.activate();
      graph_.wait_for_all();
    } catch (...) {  // of TBB, for want of memory: the nodes go before the graph and its tasks do
      graph_.cancel();
      throw;
    }
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  // Keeps the first exception until the items in process are done. One that TBB saw would cancel
  // the parallel loops inside these as well, which then go on with half of their results.
  template <typename Step>
  void unless_failed(const Step& step) {
    if (failed_) return;
    try {
      step();
    } catch (...) {
      note_failure();
      failed_ = true;
    }
  }

  void note_failure() {
    const std::lock_guard lock(failure_mutex_);
    if (!failure_) failure_ = std::current_exception();
  }

  void work_on(FlowItem& item) {
    if (trace_ == nullptr) return flow_.work(item);
    const TraceTime start = std::chrono::steady_clock::now();
    ++in_work_;
    flow_.work(item);
    --in_work_;
    const std::chrono::duration<double> waited = start - item.announced;
    trace_->span("file", item.name(), start, std::chrono::steady_clock::now(),
                 {{"place", static_cast<double>(item.index)},
                  {"waited_seconds", waited.count()},
                  {"memory_estimate_bytes", static_cast<double>(item.memory_estimate)}});
  }

  ItemPointer next_item(tbb::flow_control& control) {
    ItemPointer item;
    const TraceSpan span(trace_, "next", "");
    try {
      if (!stop_ && !failed_) item = flow_.next();
    } catch (...) {
      note_failure();  // what came before is still done
    }
    if (!item) control.stop();
    return item;
  }

  template <typename Ports>
  void decide(const Request& request, Ports& ports) {
    if (const auto* item = std::get_if<ItemPointer>(&request)) {
      if (trace_ != nullptr) (*item)->announced = std::chrono::steady_clock::now();
      admission_.wait(*item);
    }
    if (const auto* released = std::get_if<Released>(&request)) admission_.release(released->bytes);
    while (const ItemPointer item = admission_.admit()) std::get<0>(ports).try_put(item);
    if (trace_ != nullptr) admission_.trace(*trace_, in_work_);
  }

  const Flow& flow_;
  const std::atomic<bool>& stop_;
  const RunTrace* trace_;
  std::atomic<std::size_t> in_work_{0};  // items; counted for the trace alone
  Admission admission_;
  Delivery delivery_;
  std::atomic<bool> failed_{false};
  std::mutex failure_mutex_;
  std::exception_ptr failure_;

  tbbflow::graph graph_;
  tbbflow::input_node<ItemPointer> source_;
  tbbflow::limiter_node<ItemPointer, int> window_;
  tbbflow::function_node<ItemPointer, Request> announce_;
  tbbflow::multifunction_node<Request, std::tuple<ItemPointer>> admit_;
  tbbflow::multifunction_node<ItemPointer, std::tuple<Request, int>> work_;
};

}  // namespace

void run_flow(const Flow& flow, const FlowOptions& options, const std::atomic<bool>& stop) {
  Graph(flow, options, stop).run();
}

}  // namespace triglyph
