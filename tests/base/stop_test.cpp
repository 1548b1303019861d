#include "engine/base/stop.h"

#include <atomic>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

TEST(StopPoint, ThrowsOnlyWithinAScopeWhoseFlagIsSet) {
  EXPECT_NO_THROW(stop_point());
  std::atomic<bool> flag = false;
  {
    const StopScope scope(flag);
    EXPECT_NO_THROW(stop_point());
    flag = true;
    EXPECT_THROW(stop_point(), Stopped);
    const std::atomic<bool> other = false;
    {
      const StopScope inner(other);
      EXPECT_NO_THROW(stop_point());
    }
    EXPECT_THROW(stop_point(), Stopped);
  }
  EXPECT_NO_THROW(stop_point());
}

TEST(StopPoint, SaysThatTheRunWasInterrupted) {
  EXPECT_STREQ(Stopped().what(), "interrupted");
}

TEST(ParallelFor, LeavesOutMostOfALoopOnceTheFlagIsSet) {
  constexpr std::size_t kTurns = 1'000'000;
  std::atomic<bool> flag = false;
  const StopScope scope(flag);
  std::atomic<std::size_t> turns = 0;
  const auto loop = [&] {
    parallel_for(
        kTurns,
        [&](std::size_t) {
          if (++turns == 10) flag = true;
        },
        16);
  };
  EXPECT_THROW(loop(), Stopped);
  EXPECT_GE(turns, 10U);
  EXPECT_LT(turns, kTurns / 2);
}

// A loop of one task is not given to oneTBB, and an empty one has nothing to stop.
TEST(ParallelFor, StopsBeforeALoopOfOneTask) {
  const std::atomic<bool> flag = true;
  const StopScope scope(flag);
  int turns = 0;
  EXPECT_THROW(parallel_for(
                   4, [&](std::size_t) { ++turns; }, 8),
               Stopped);
  EXPECT_EQ(turns, 0);
  EXPECT_NO_THROW(parallel_for(
      0, [&](std::size_t) { ++turns; }, 8));
}

}  // namespace
}  // namespace triglyph
