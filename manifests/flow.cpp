#include "manifests/flow.h"

#include <algorithm>
#include <exception>
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

 private:
  std::uint64_t budget_;
  std::uint64_t in_work_ = 0;
  std::size_t items_in_work_ = 0;
  std::vector<ItemPointer> waiting_;  // largest first
};

namespace tbbflow = tbb::flow;

// A message to the admission node: an item that waits, or memory that is free again.
using Request = std::variant<ItemPointer, Released>;

// source -> window -> announce -> admit -> stage ... stage -> release -> in order -> deliver
//             ^                     ^                            |                      |
//             |                     +------- memory released ----+                      |
//             +------------------------ one more may be known --------------------------+
class Graph {
 public:
  Graph(const Flow& flow, const FlowOptions& options, const std::atomic<bool>& stop)
      : flow_(flow),
        stop_(stop),
        admission_(options.memory_bytes),
        source_(graph_, [this](tbb::flow_control& control) { return next_item(control); }),
        window_(graph_, kWindow),
        announce_(graph_, tbbflow::serial, [](const ItemPointer& item) { return Request(item); }),
        admit_(graph_, tbbflow::serial,
               [this](const Request& request, auto& ports) { decide(request, ports); }),
        release_(graph_, tbbflow::unlimited,
                 [](const ItemPointer& item, auto& ports) {
                   std::get<1>(ports).try_put(Released{item->memory_estimate});
                   std::get<0>(ports).try_put(item);
                 }),
        in_order_(graph_, [](const ItemPointer& item) { return item->index; }),
        deliver_(graph_, tbbflow::serial, [this](const ItemPointer& item) {
          flow_.deliver(*item);
          return 1;
        }) {
    add_stages();
    connect();
  }

  void run() {
    source_.activate();
    graph_.wait_for_all();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  using Stage = tbbflow::function_node<ItemPointer, ItemPointer>;

  void add_stages() {
    for (const auto& work : flow_.stages) {
      stages_.push_back(
          std::make_unique<Stage>(graph_, tbbflow::unlimited, [&work](const ItemPointer& item) {
            work(*item);
            return item;
          }));
    }
  }

  ItemPointer next_item(tbb::flow_control& control) {
    try {
      if (!stop_) {
        if (std::unique_ptr<FlowItem> item = flow_.next()) return item;
      }
    } catch (...) {
      failure_ = std::current_exception();
    }
    control.stop();
    return nullptr;
  }

  template <typename Ports>
  void decide(const Request& request, Ports& ports) {
    if (const auto* item = std::get_if<ItemPointer>(&request)) admission_.wait(*item);
    if (const auto* released = std::get_if<Released>(&request)) admission_.release(released->bytes);
    while (const ItemPointer item = admission_.admit()) std::get<0>(ports).try_put(item);
  }

  void connect() {
    tbbflow::make_edge(source_, window_);
    tbbflow::make_edge(window_, announce_);
    tbbflow::make_edge(announce_, admit_);
    tbbflow::make_edge(tbbflow::output_port<0>(admit_), *stages_.front());
    for (std::size_t i = 1; i < stages_.size(); ++i) {
      tbbflow::make_edge(*stages_[i - 1], *stages_[i]);
    }
    tbbflow::make_edge(*stages_.back(), release_);
    tbbflow::make_edge(tbbflow::output_port<0>(release_), in_order_);
    tbbflow::make_edge(tbbflow::output_port<1>(release_), admit_);
    tbbflow::make_edge(in_order_, deliver_);
    tbbflow::make_edge(deliver_, window_.decrementer());
  }

  const Flow& flow_;
  const std::atomic<bool>& stop_;
  Admission admission_;
  std::exception_ptr failure_;

  tbbflow::graph graph_;
  tbbflow::input_node<ItemPointer> source_;
  tbbflow::limiter_node<ItemPointer, int> window_;
  tbbflow::function_node<ItemPointer, Request> announce_;
  tbbflow::multifunction_node<Request, std::tuple<ItemPointer>> admit_;
  std::vector<std::unique_ptr<Stage>> stages_;
  tbbflow::multifunction_node<ItemPointer, std::tuple<ItemPointer, Request>> release_;
  tbbflow::sequencer_node<ItemPointer> in_order_;
  tbbflow::function_node<ItemPointer, int> deliver_;
};

}  // namespace

void run_flow(const Flow& flow, const FlowOptions& options, const std::atomic<bool>& stop) {
  Graph(flow, options, stop).run();
}

}  // namespace triglyph
