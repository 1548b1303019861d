// Isolation of a run: the work happens in a child process, so that a mesh that kills it (a crash, a
// stack overflow, the kernel for want of memory) costs one mesh and not the run.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace triglyph {

class RunTrace;

// An item in process.
struct ItemInWork {
  std::size_t index = 0;
  std::string name;  // the end of it, if it is long
  double seconds = 0;
};

// What a worker and its supervisor both see, in shared memory.
class RunBoard {
 public:
  // Becomes true when the user interrupts the run, or a worker gives it up.
  [[nodiscard]] const std::atomic<bool>& stop() const { return stop_; }

  // Ends the run like an interrupt, because too much failed.
  void give_up() {
    gave_up_ = true;
    stop_ = true;
  }
  [[nodiscard]] bool gave_up() const { return gave_up_; }

  // Say that a thread begins or ends to process an item. The name is for people.
  void begin(std::size_t index, std::string_view name = {});
  void end(std::size_t index);

  // Returns the items in process, the one that has taken longest first.
  [[nodiscard]] std::vector<ItemInWork> items_in_work() const;

  // Number of items whose results were delivered, in their order, by this worker or an earlier one.
  std::atomic<std::uint64_t> delivered{0};

  // Number of items in the run, once it is known.
  std::atomic<std::uint64_t> total{0};

  // Number of bytes of all input files, once it is known.
  std::atomic<std::uint64_t> total_bytes{0};

  // Counters of the user; they outlive the worker.
  std::array<std::atomic<std::uint64_t>, 32> counters{};

 private:
  friend class Supervision;

  struct Slot {
    std::atomic<std::uint64_t> item{0};  // index + 1, or 0
    std::atomic<std::int64_t> since{0};  // milliseconds of the monotonic clock
    std::array<std::atomic<char>, 120> name{};
  };
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

  std::atomic<bool> stop_{false};
  std::atomic<bool> gave_up_{false};
  std::array<Slot, 1024> slots_{};  // as many as --threads may be
};

// An item that is not to be tried again.
struct Casualty {
  std::size_t index = 0;
  bool is_slow = false;  // took longer than allowed; otherwise it killed the process
  std::string reason;
};

// What a worker is told.
struct WorkOrder {
  RunBoard* board = nullptr;
  const RunTrace* trace = nullptr;  // null: nothing is traced
  bool is_first = true;             // no worker of this run came before
  bool one_at_a_time = false;       // after a crash that no item causes when alone
  std::optional<std::size_t> only;  // a suspect to be tried alone; nothing is to be delivered
  std::vector<Casualty> casualties;

  // Returns the item's casualty, or null.
  [[nodiscard]] const Casualty* casualty(std::size_t index) const;
};

// What a supervisor tells while it waits for a worker. Everything is called in the supervisor's
// process, between system calls and never by a signal handler.
struct SupervisorEvents {
  std::function<void(pid_t worker)> started = {};
  // The worker was killed by the signal.
  std::function<void(const RunBoard& board, int signal)> died = {};
  // Somebody asked how far the run is, by SIGUSR1 to the supervisor or to the worker. Several
  // signals within a tenth of a second are one question.
  std::function<void(const RunBoard& board, pid_t worker)> asked = {};
  // Called every `period` seconds, if that is not 0.
  std::function<void(const RunBoard& board, pid_t worker)> tick = {};
  double period = 0;
  // The run is over; nothing: it was interrupted, or an exception ends it.
  std::function<void(const RunBoard& board, std::optional<int> exit_code)> ended = {};
};

// Runs `work` in a child process and returns its exit code. If the child dies, the items that it
// was processing are suspects: each is tried alone, those that kill again become casualties, and
// another child runs `work` for the rest; `work` skips what RunBoard::delivered and its own memory
// say is done. An item that is processed for longer than `timeout` seconds is a casualty too (0: no
// limit). SIGINT, SIGTERM and SIGHUP set RunBoard::stop(); a child that has not ended two seconds
// after that, or at the second signal, is killed, and the result is empty. To be called while the
// process has one thread. Where no process can be made, `work` runs in this one, and there are no
// events. Throws std::runtime_error if the child dies while it processes no item.
[[nodiscard]] std::optional<int> supervise(const std::function<int(const WorkOrder&)>& work,
                                           double timeout, const SupervisorEvents& events = {});

}  // namespace triglyph
