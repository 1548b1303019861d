// Parallel loops, the engine's only use of oneTBB. Every loop is isolated, so that a thread that
// waits in it never starts another mesh. Results are bitwise equal for any number of threads: each
// index writes its own slot, and folds run over fixed blocks in index order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include "engine/base/stop.h"

namespace triglyph {

// Indices per block. Fixed, so that the order of a fold depends on the input size alone; large
// enough that scheduling a block costs little beside its work.
inline constexpr std::size_t kBlock = 4096;

// Calls body(i) once for every i in [0, n), in parallel, in tasks of about `grain` consecutive
// indices or more. An exception cancels the loop and is rethrown here, so a loop over meshes must
// catch inside its body. Throws Stopped, at the latest after `grain` more indices a thread, once
// stop_point() does.
template <typename Body>
void parallel_for(std::size_t n, const Body& body, std::size_t grain = 1) {
  if (n <= grain) {
    if (n > 0) stop_point();
    for (std::size_t i = 0; i < n; ++i) body(i);
    return;
  }
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        // a range can hold a large share of the loop
                        for (std::size_t i = range.begin(); i < range.end();) {
                          stop_point();
                          const std::size_t end = std::min(range.end(), i + grain);
                          for (; i < end; ++i) body(i);
                        }
                      });
  });
}

// Calls body(begin, end) for consecutive blocks that cover [0, n), in parallel.
template <typename Body>
void parallel_blocks(std::size_t n, const Body& body, std::size_t block = kBlock) {
  const std::size_t blocks = (n + block - 1) / block;
  parallel_for(blocks, [&](std::size_t b) { body(b * block, std::min(n, b * block + block)); });
}

// Returns the fold of map(0) .. map(n - 1) under join, in index order within blocks and across
// them.
template <typename T, typename Map, typename Join>
[[nodiscard]] T parallel_reduce(std::size_t n, T identity, const Map& map, const Join& join) {
  std::vector<T> partial((n + kBlock - 1) / kBlock, identity);
  parallel_blocks(n, [&](std::size_t begin, std::size_t end) {
    T folded = identity;
    for (std::size_t i = begin; i < end; ++i) folded = join(folded, map(i));
    partial[begin / kBlock] = folded;
  });
  T total = identity;
  for (const T& part : partial) total = join(total, part);
  return total;
}

// Returns everything that make(i, out) appends to `out` for i in [0, n), in index order.
template <typename T, typename Make>
[[nodiscard]] std::vector<T> parallel_collect(std::size_t n, const Make& make) {
  std::vector<std::vector<T>> parts((n + kBlock - 1) / kBlock);
  parallel_blocks(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) make(i, parts[begin / kBlock]);
  });
  std::size_t total = 0;
  for (const auto& part : parts) total += part.size();
  std::vector<T> all;
  all.reserve(total);
  for (auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// Sorts in parallel. `less` must be a total order: if elements that compare equal could be told
// apart, the result would depend on the number of threads.
template <typename Iterator, typename Less>
void parallel_sort(Iterator begin, Iterator end, const Less& less) {
  tbb::this_task_arena::isolate([&] { tbb::parallel_sort(begin, end, less); });
}

// Runs two independent functions, in parallel if two threads are free.
template <typename First, typename Second>
void parallel_pair(const First& first, const Second& second) {
  tbb::this_task_arena::isolate([&] { tbb::parallel_invoke(first, second); });
}

// Runs a function that uses oneTBB itself, such as a library call, without starting other meshes
// while it waits.
template <typename Work>
void run_isolated(const Work& work) {
  tbb::this_task_arena::isolate(work);
}

// Returns the number of threads that a user's number means. 0: as many as the machine has.
[[nodiscard]] inline int thread_count(int threads) {
  return threads > 0 ? threads
                     : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

// Runs `work` in an arena of `threads` threads, see thread_count(), and limits oneTBB to that
// number in the whole process meanwhile.
template <typename Work>
void with_threads(int threads, const Work& work) {
  const int count = thread_count(threads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(count));
  tbb::task_arena arena(count);
  arena.execute(work);
}

}  // namespace triglyph
