// Runs the same work with different numbers of threads, for tests that its result does not depend
// on them. TBB arenas, since a global limit would leave the arena as large as the machine.
#pragma once

#include <array>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace triglyph::test {

template <typename Work>
void expect_same_for_any_threads(const Work& work) {
  const auto expected = work();
  for (const int threads : {1, 2, 3, 8}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { EXPECT_EQ(work(), expected) << threads << " threads"; });
  }
}

}  // namespace triglyph::test
