#include "engine/message/spread.h"

#include <algorithm>
#include <limits>

#include "engine/base/random.h"

namespace triglyph {
namespace {

// A parity is of bits among so many neighbours; decoding takes twice as long for each bit more.
constexpr std::size_t kWindow = 12;
constexpr std::uint32_t kWindows = 1U << kWindow;       // contents of a window
constexpr std::uint32_t kStates = 1U << (kWindow - 1);  // of all but its newest bit
constexpr std::uint64_t kEnds = 4, kTaps = 5;           // streams of random numbers

// The loops that take the time of decoding: sanitizers would take twenty times as long over them.
#if defined(__clang__)
#define TRIGLYPH_UNCHECKED __attribute__((no_sanitize("address", "undefined")))
#else
#define TRIGLYPH_UNCHECKED
#endif

// Replaces the value of each content c by the sum of the values of all t, negated where c and t
// share an odd number of bits: the fast Walsh-Hadamard transform. `values` has kWindows.
TRIGLYPH_UNCHECKED void sum_over_even_less_odd(float* values) {
  for (std::size_t half = 1; half < kWindows; half *= 2) {
    for (std::size_t begin = 0; begin < kWindows; begin += 2 * half) {
      for (std::size_t i = begin; i < begin + half; ++i) {
        const float sum = values[i] + values[i + half];
        values[i + half] = values[i] - values[i + half];
        values[i] = sum;
      }
    }
  }
}

// Takes the best way to each state on to the next step: `score`, `next` and `dropped` have kStates,
// `gain` kWindows. A state holds the newest bits but one window's oldest; past the end, where
// `stride` is 2, only zeros enter.
TRIGLYPH_UNCHECKED void advance(const float* score, const float* gain, std::uint32_t stride,
                                float* next, std::uint8_t* dropped) {
  for (std::uint32_t content = 0; content < kWindows; content += stride) {
    const std::uint32_t state = content >> 1;  // before the newest bit entered
    const std::uint32_t to = content & (kStates - 1);
    const float reached = score[state] + gain[content];
    if (!(reached > next[to])) continue;
    next[to] = reached;
    dropped[to] = static_cast<std::uint8_t>(content >> (kWindow - 1));
  }
}

#undef TRIGLYPH_UNCHECKED

}  // namespace

std::size_t SpreadCode::steps() const {
  return bits_ + kWindow - 1;
}

// Windows hang over both ends, where fewer bits share more parities.
SpreadCode::Row SpreadCode::row_of(std::uint32_t row) const {
  Row drawn;
  drawn.end = random_bits(seed_, kEnds, row) % steps();
  const std::size_t newest = drawn.end < bits_ ? 0 : drawn.end - bits_ + 1;
  const std::size_t oldest = std::min(drawn.end, kWindow - 1);
  const auto inside = static_cast<std::uint32_t>((kWindows - 1) >> newest << newest &
                                                 ((std::uint64_t{1} << (oldest + 1)) - 1));
  drawn.taps = static_cast<std::uint32_t>(random_bits(seed_, kTaps, row)) & inside;
  drawn.taps |= 1U << newest;  // a parity of nothing would tell nothing
  return drawn;
}

bool SpreadCode::parity(std::span<const std::uint8_t> payload, std::uint32_t row) const {
  const Row drawn = row_of(row);
  bool sum = false;
  for (std::size_t i = 0; i < kWindow; ++i) {
    if ((drawn.taps >> i & 1) == 0) continue;
    const std::size_t bit = drawn.end - i;
    sum = sum != ((payload[bit / 8] >> (bit % 8) & 1) != 0);
  }
  return sum;
}

std::vector<std::uint8_t> SpreadCode::decode(std::span<const SoftParity> parities,
                                             std::span<const SoftBit> read) const {
  struct Tapped {
    std::uint32_t taps;
    float value;
  };
  std::vector<std::vector<Tapped>> rows_at(steps());
  for (const SoftParity& parity : parities) {
    const Row row = row_of(parity.row);
    rows_at[row.end].push_back({row.taps, static_cast<float>(parity.value)});
  }
  for (const SoftBit& own : read) rows_at[own.bit].push_back({1, static_cast<float>(own.value)});
  constexpr float kNever = -std::numeric_limits<float>::infinity();
  std::vector<float> score(kStates, kNever), next(kStates);
  score[0] = 0;
  std::vector<float> gain(kWindows);  // of a window's content, whose newest bit is bit 0
  std::vector<std::vector<std::uint8_t>> dropped(
      steps());  // by state: the bit that left the window
  for (std::size_t step = 0; step < steps(); ++step) {
    std::fill(gain.begin(), gain.end(), 0.0F);
    for (const Tapped& row : rows_at[step]) gain[row.taps] -= row.value;
    if (!rows_at[step].empty()) sum_over_even_less_odd(gain.data());
    dropped[step].assign(kStates, 0);
    std::fill(next.begin(), next.end(), kNever);
    advance(score.data(), gain.data(), step < bits_ ? 1 : 2, next.data(), dropped[step].data());
    std::swap(score, next);
  }
  // what left the window at a step entered it kWindow - 1 steps before
  std::vector<std::uint8_t> payload((bits_ + 7) / 8, 0);
  std::uint32_t state = 0;
  for (std::size_t step = steps(); step-- > 0;) {
    const std::uint32_t left = dropped[step][state];
    if (left != 0 && step >= kWindow - 1) {
      const std::size_t bit = step - (kWindow - 1);
      payload[bit / 8] |= static_cast<std::uint8_t>(1U << (bit % 8));
    }
    state = state >> 1 | left << (kWindow - 2);
  }
  return payload;
}

}  // namespace triglyph
