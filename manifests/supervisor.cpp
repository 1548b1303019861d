#include "manifests/supervisor.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <iostream>
#include <new>
#include <stdexcept>

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace triglyph {
namespace {

// How long a worker may take to end after an interrupt, in milliseconds.
constexpr std::int64_t kGrace = 2000;

// How often the supervisor looks at the clock while there is a deadline, in milliseconds.
constexpr std::int64_t kTick = 50;

std::int64_t now_milliseconds() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{time.tv_sec} * 1000 + time.tv_nsec / 1000000;
}

// Within this time, in milliseconds, several questions are one: `pkill` asks both processes.
constexpr std::int64_t kQuestion = 100;

// Hands a worker's question on to the supervisor, which knows the answer.
void ask_supervisor(int) {
  const int error = errno;
  kill(getppid(), SIGUSR1);
  errno = error;
}

// The board, in memory that child processes share.
class SharedBoard {
 public:
  SharedBoard() {
    void* memory =
        mmap(nullptr, sizeof(RunBoard), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    board_ = new (memory) RunBoard;
  }
  ~SharedBoard() { munmap(board_, sizeof(RunBoard)); }
  SharedBoard(const SharedBoard&) = delete;
  SharedBoard& operator=(const SharedBoard&) = delete;
  [[nodiscard]] RunBoard& operator*() const { return *board_; }

 private:
  RunBoard* board_;
};

// The signals that the supervisor takes one by one instead of being interrupted by them. A signal
// that is ignored, as SIGHUP under nohup, stays ignored.
sigset_t supervised_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGCHLD);
  sigaddset(&signals, SIGUSR1);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    if (action.sa_handler != SIG_IGN) sigaddset(&signals, number);
  }
  return signals;
}

std::string cause_of(int signal) {
  const std::string text = "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
  return signal == SIGKILL ? text + ", perhaps for want of memory" : text;
}

}  // namespace

void RunBoard::begin(std::size_t index, std::string_view name) {
  for (Slot& slot : slots_) {
    std::uint64_t free = 0;
    if (!slot.item.compare_exchange_strong(free, index + 1)) continue;
    name.remove_prefix(name.size() - std::min(name.size(), slot.name.size()));
    for (std::size_t i = 0; i < slot.name.size(); ++i) {
      slot.name[i].store(i < name.size() ? name[i] : '\0', std::memory_order_relaxed);
    }
    slot.since = now_milliseconds();
    return;
  }
}

void RunBoard::end(std::size_t index) {
  for (Slot& slot : slots_) {
    if (slot.item != index + 1) continue;
    slot.since = 0;
    slot.item = 0;
    return;
  }
}

std::vector<ItemInWork> RunBoard::items_in_work() const {
  std::vector<ItemInWork> items;
  const std::int64_t now = now_milliseconds();
  for (const Slot& slot : slots_) {
    const std::uint64_t item = slot.item;
    const std::int64_t since = slot.since;
    if (item == 0 || since == 0) continue;
    std::string name;
    for (const std::atomic<char>& letter : slot.name) {
      if (letter == '\0') break;
      name += letter;
    }
    if (slot.item != item) continue;  // another has taken the place meanwhile
    items.push_back({static_cast<std::size_t>(item - 1), std::move(name),
                     static_cast<double>(now - since) / 1000});
  }
  std::stable_sort(items.begin(), items.end(),
                   [](const ItemInWork& a, const ItemInWork& b) { return a.seconds > b.seconds; });
  return items;
}

const Casualty* WorkOrder::casualty(std::size_t index) const {
  const auto found = std::find_if(casualties.begin(), casualties.end(),
                                  [&](const Casualty& one) { return one.index == index; });
  return found == casualties.end() ? nullptr : &*found;
}

// The life of one run.
class Supervision {
 public:
  Supervision(const std::function<int(const WorkOrder&)>& work, double timeout,
              const SupervisorEvents& events)
      : work_(work),
        events_(events),
        timeout_(static_cast<std::int64_t>(timeout * 1000)),
        period_(events.tick ? static_cast<std::int64_t>(events.period * 1000) : 0) {
    order_.board = &*board_;
    signals_ = supervised_signals();
    sigprocmask(SIG_BLOCK, &signals_, &former_);
  }
  ~Supervision() { sigprocmask(SIG_SETMASK, &former_, nullptr); }
  Supervision(const Supervision&) = delete;
  Supervision& operator=(const Supervision&) = delete;

  std::optional<int> run() {
    try {
      const std::optional<int> code = run_workers();
      if (events_.ended) events_.ended(*board_, code);
      return code;
    } catch (...) {
      if (events_.ended) events_.ended(*board_, std::nullopt);
      throw;
    }
  }

 private:
  std::optional<int> run_workers() {
    while (true) {
      const End end = run_worker();
      order_.is_first = false;
      if (end.exit_code) return end.exit_code;
      if (end.was_stopped) return std::nullopt;
      if (end.slow.empty()) find_culprits(end);
      for (const Casualty& slow : end.slow) {
        check_is_new(slow.index, "the run hangs");
        order_.casualties.push_back(slow);
      }
      if ((*board_).stop_) return std::nullopt;
    }
  }

  // How a worker ended.
  struct End {
    std::optional<int> exit_code;
    int signal = 0;
    bool was_stopped = false;           // killed, because it did not end after an interrupt
    std::vector<Casualty> slow;         // killed, because of these
    std::vector<std::size_t> suspects;  // items in process when it died
  };

  End run_worker() {
    RunBoard& board = *board_;
    for (RunBoard::Slot& slot : board.slots_) slot.item = 0;
    std::cout.flush();
    const pid_t supervisor = getpid();
    const pid_t child = fork();
    if (child == 0) become_worker(supervisor);
    if (child > 0) {
      if (events_.started) events_.started(child);
      return await(child);
    }
    End end;
    end.exit_code = work_(order_);
    return end;
  }

  [[noreturn]] void become_worker(pid_t supervisor) {
    // dies with its supervisor, which alone hears the user's signals
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != supervisor) _exit(1);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_IGN);
    struct sigaction ask {};
    ask.sa_handler = ask_supervisor;
    ask.sa_flags = SA_RESTART;
    sigaction(SIGUSR1, &ask, nullptr);
    sigprocmask(SIG_SETMASK, &former_, nullptr);
    const int code = work_(order_);
    std::cout.flush();
    std::cerr.flush();
    _exit(code);  // what the process set up before it was the supervisor's, which will clean it up
  }

  End await(pid_t child) {
    End end;
    while (true) {
      int status = 0;
      if (waitpid(child, &status, WNOHANG) == child) {
        if (WIFEXITED(status)) {
          end.exit_code = WEXITSTATUS(status);
        } else {
          end.signal = WTERMSIG(status);
          end.suspects = suspects();
          if (events_.died) events_.died(*board_, end.signal);
        }
        return end;
      }
      look(child);
      if (timeout_ > 0 && end.slow.empty()) {
        end.slow = slow_items();
        if (!end.slow.empty()) kill(child, SIGKILL);
      }
      if (stopped_at_ > 0 && now_milliseconds() - stopped_at_ > kGrace) {
        end.was_stopped = true;
        kill(child, SIGKILL);
      }
      const timespec patience = time_until_next_look();
      const int signal = sigtimedwait(&signals_, nullptr, &patience);
      if (signal == SIGUSR1) answer(child);
      if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP) {
        // the second signal ends the grace
        stopped_at_ = stopped_at_ > 0 ? 1 : now_milliseconds();
        (*board_).stop_ = true;
      }
    }
  }

  // Calls what is to be called now and then, if it is time.
  void look(pid_t child) {
    if (period_ == 0 || now_milliseconds() < next_tick_) return;
    events_.tick(*board_, child);
    next_tick_ = now_milliseconds() + period_;
  }

  [[nodiscard]] timespec time_until_next_look() const {
    std::int64_t left = 3600000;
    if (timeout_ > 0 || stopped_at_ > 0) left = kTick;
    if (period_ > 0) {
      left = std::min(left, std::max<std::int64_t>(1, next_tick_ - now_milliseconds()));
    }
    return {.tv_sec = static_cast<time_t>(left / 1000), .tv_nsec = left % 1000 * 1000000};
  }

  void answer(pid_t child) {
    if (!events_.asked || now_milliseconds() - answered_at_ < kQuestion) return;
    events_.asked(*board_, child);
    answered_at_ = now_milliseconds();
  }

  [[nodiscard]] std::vector<std::size_t> suspects() const {
    std::vector<std::size_t> items;
    for (const RunBoard::Slot& slot : (*board_).slots_) {
      if (slot.item > 0) items.push_back(static_cast<std::size_t>(slot.item - 1));
    }
    return items;
  }

  [[nodiscard]] std::vector<Casualty> slow_items() const {
    std::vector<Casualty> slow;
    for (const RunBoard::Slot& slot : (*board_).slots_) {
      const std::uint64_t item = slot.item;
      const std::int64_t since = slot.since;
      if (item == 0 || since == 0 || now_milliseconds() - since < timeout_) continue;
      slow.push_back({static_cast<std::size_t>(item - 1), true, "took longer than the time limit"});
    }
    return slow;
  }

  // A casualty is not processed any more. A worker that dies or hangs all the same would do so for
  // ever, as where what became of the casualty cannot be written.
  void check_is_new(std::size_t index, const std::string& what) const {
    if (order_.casualty(index) != nullptr) throw std::runtime_error(what);
  }

  // Tries the suspects alone, and adds those that kill again to the casualties.
  void find_culprits(const End& end) {
    if (end.signal == SIGPIPE) {  // the reader of the output is gone
      std::signal(SIGPIPE, SIG_DFL);
      sigprocmask(SIG_SETMASK, &former_, nullptr);
      std::raise(SIGPIPE);
    }
    const auto add = [&](std::size_t index, int signal) {
      check_is_new(index, "the run was killed by " + cause_of(signal));
      order_.casualties.push_back({index, false, "killed the process by " + cause_of(signal)});
    };
    if (end.suspects.empty()) {
      throw std::runtime_error("the run was killed by " + cause_of(end.signal));
    }
    // somebody else may have sent SIGKILL, which says nothing of the item before it does so again
    if (end.suspects.size() == 1 && end.signal != SIGKILL) {
      return add(end.suspects.front(), end.signal);
    }
    const std::size_t known = order_.casualties.size();
    for (const std::size_t suspect : end.suspects) {
      order_.only = suspect;
      const End alone = run_worker();
      order_.only.reset();
      if (alone.was_stopped || (*board_).stop_) return;
      if (!alone.slow.empty()) order_.casualties.push_back(alone.slow.front());
      if (alone.signal != 0 && alone.slow.empty()) add(suspect, alone.signal);
    }
    if (order_.casualties.size() == known) {
      if (order_.one_at_a_time) {
        throw std::runtime_error("the run was killed by " + cause_of(end.signal));
      }
      order_.one_at_a_time = true;
    }
  }

  const std::function<int(const WorkOrder&)>& work_;
  const SupervisorEvents& events_;
  std::int64_t timeout_;          // milliseconds
  std::int64_t period_;           // between two ticks, milliseconds; 0: none
  std::int64_t next_tick_ = 0;    // milliseconds
  std::int64_t answered_at_ = 0;  // milliseconds
  SharedBoard board_;
  WorkOrder order_;
  sigset_t signals_{};
  sigset_t former_{};
  std::int64_t stopped_at_ = 0;  // milliseconds; 0: not interrupted
};

std::optional<int> supervise(const std::function<int(const WorkOrder&)>& work, double timeout,
                             const SupervisorEvents& events) {
  return Supervision(work, timeout, events).run();
}

}  // namespace triglyph
