#include "manifests/supervisor.h"

#include <chrono>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

namespace triglyph {
namespace {

// Works on items 0 .. 9 two at a time, as two threads would. Exits with the number of casualties.
int work_in_pairs(const WorkOrder& order, const std::function<void(std::size_t)>& process) {
  RunBoard& board = *order.board;
  for (std::size_t i = 0; i < 10; i += 2) {
    for (const std::size_t item : {i, i + 1}) {
      const bool is_wanted = order.only ? *order.only == item : item >= board.delivered;
      if (is_wanted && order.casualty(item) == nullptr) board.begin(item);
    }
    for (const std::size_t item : {i, i + 1}) {
      const bool is_wanted = order.only ? *order.only == item : item >= board.delivered;
      if (!is_wanted || order.casualty(item) != nullptr) continue;
      process(item);
      ++board.counters[item];
    }
    board.end(i);
    board.end(i + 1);
    if (!order.only) board.delivered = i + 2;
  }
  return static_cast<int>(order.casualties.size());
}

TEST(Supervise, ReturnsTheExitCodeOfAWorkerThatLives) {
  EXPECT_EQ(supervise([](const WorkOrder&) { return 42; }, 0), 42);
}

// Of two items in process when the worker dies, the one that kills it is found; the other is done.
TEST(Supervise, FindsTheItemThatKillsAndGoesOnWithoutIt) {
  for (const std::size_t culprit : {4U, 5U}) {
    const auto code = supervise(
        [&](const WorkOrder& order) {
          const int casualties = work_in_pairs(order, [&](std::size_t item) {
            if (item == culprit) std::raise(SIGKILL);
          });
          const bool all_done = [&] {
            for (std::size_t i = 0; i < 10; ++i) {
              if ((order.board->counters[i] > 0) == (i == culprit)) return false;
            }
            return true;
          }();
          const bool is_named = casualties == 1 && order.casualties[0].index == culprit &&
                                order.casualties[0].reason.find("signal 9") != std::string::npos;
          return all_done && is_named ? 7 : 8;
        },
        0);
    EXPECT_EQ(code, 7) << culprit;
  }
}

TEST(Supervise, FindsEveryItemThatKills) {
  const auto code = supervise(
      [&](const WorkOrder& order) {
        return work_in_pairs(order, [&](std::size_t item) {
          if (item == 1 || item == 6 || item == 7) std::abort();
        });
      },
      0);
  EXPECT_EQ(code, 3);
}

// Two items that only together are too much: one at a time they are done.
TEST(Supervise, ProcessesOneAtATimeWhatKillsOnlyTogether) {
  const auto code = supervise(
      [&](const WorkOrder& order) {
        if (order.one_at_a_time || order.only) return 9;
        order.board->begin(0);
        order.board->begin(1);
        std::abort();
      },
      0);
  EXPECT_EQ(code, 9);
}

TEST(Supervise, EndsAnItemThatTakesTooLong) {
  const auto code = supervise(
      [&](const WorkOrder& order) {
        const int casualties = work_in_pairs(order, [&](std::size_t item) {
          while (item == 3) std::this_thread::sleep_for(std::chrono::seconds(1));
        });
        // both of the pair were in process for as long
        return casualties <= 2 && order.casualty(3) != nullptr && order.casualty(3)->is_slow ? 1
                                                                                             : 2;
      },
      0.3);
  EXPECT_EQ(code, 1);
}

TEST(Supervise, ThrowsIfTheWorkerDiesOutsideAnyItem) {
  EXPECT_THROW((void)supervise([](const WorkOrder&) -> int { std::abort(); }, 0),
               std::runtime_error);
}

TEST(Supervise, TellsTheWorkerOfAnInterrupt) {
  const auto code = supervise(
      [&](const WorkOrder& order) {
        kill(getppid(), SIGTERM);
        while (!order.board->stop()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return 5;
      },
      0);
  EXPECT_EQ(code, 5);
}

TEST(Supervise, KillsAWorkerThatDoesNotHearAnInterrupt) {
  const auto start = std::chrono::steady_clock::now();
  const auto code = supervise(
      [&](const WorkOrder&) -> int {
        kill(getppid(), SIGINT);
        while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
      },
      0);
  EXPECT_FALSE(code);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

// Whichever of the two processes is asked, the supervisor answers, and knows what is in process.
TEST(Supervise, AnswersAQuestionToEitherProcess) {
  for (const bool asks_worker : {false, true}) {
    std::vector<std::string> in_work;
    int answers = 0;
    SupervisorEvents events;
    events.asked = [&](const RunBoard& board, pid_t) {
      ++answers;
      for (const ItemInWork& item : board.items_in_work()) in_work.push_back(item.name);
    };
    const auto code = supervise(
        [&](const WorkOrder& order) {
          order.board->begin(3, "a.obj");
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
          order.board->begin(4, std::string(500, 'x') + "b.obj");
          kill(asks_worker ? getpid() : getppid(), SIGUSR1);
          std::this_thread::sleep_for(std::chrono::milliseconds(300));
          return 6;
        },
        0, events);
    EXPECT_EQ(code, 6);
    EXPECT_EQ(answers, 1);
    ASSERT_EQ(in_work.size(), 2U);
    EXPECT_EQ(in_work[0], "a.obj");  // the one that has taken longest
    EXPECT_EQ(in_work[1].substr(in_work[1].size() - 6), "xb.obj");
  }
}

TEST(Supervise, TellsOfWorkersAndOfTime) {
  int started = 0;
  int ticks = 0;
  std::vector<int> signals;
  std::optional<int> ended;
  SupervisorEvents events;
  events.started = [&](pid_t) { ++started; };
  events.died = [&](const RunBoard&, int signal) { signals.push_back(signal); };
  events.tick = [&](const RunBoard&, pid_t) { ++ticks; };
  events.period = 0.02;
  events.ended = [&](const RunBoard&, std::optional<int> code) { ended = code; };
  (void)supervise(
      [](const WorkOrder& order) {
        order.board->begin(0);
        if (order.is_first) std::abort();
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return 8;
      },
      0, events);
  EXPECT_EQ(started, 2);
  EXPECT_EQ(signals, std::vector{SIGABRT});
  EXPECT_GE(ticks, 3);
  EXPECT_EQ(ended, 8);
}

}  // namespace
}  // namespace triglyph
