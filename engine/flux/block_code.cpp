#include "engine/flux/block_code.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "engine/base/random.h"

namespace triglyph {
namespace {

// Names the generator matrices among the uses of random numbers.
constexpr std::uint64_t kGenerator = 0x666c7578;  // "flux"

// A word is taken only if it is so many nats more likely than any other that was tried: 1 : 1,000.
// What a payload proves against chance says nothing of a word that differs in a few places.
constexpr double kLeastLead = 7;

// Payloads up to this size are decoded with one more flipped bit: it is cheap there.
constexpr int kSmallPayload = 24;

// Far above the rounding of a sum of the reliabilities of all functionals.
constexpr double kRounding = 1e-9;

constexpr std::size_t kWordBits = 64;
constexpr std::size_t kWords = (kFunctionals + kWordBits - 1) / kWordBits;
constexpr std::size_t kBytesOfWord = kWords * kWordBits / 8;

using BitRow = std::array<std::uint64_t, kWords>;

bool bit_of(const BitRow& row, std::size_t at) {
  return (row[at / kWordBits] >> (at % kWordBits) & 1U) != 0;
}

void set_bit(BitRow& row, std::size_t at) {
  row[at / kWordBits] |= std::uint64_t{1} << (at % kWordBits);
}

BitRow operator^(BitRow a, const BitRow& b) {
  for (std::size_t w = 0; w < kWords; ++w) a[w] ^= b[w];
  return a;
}

// Returns the sum of weights over the set bits of a row, a byte at a time.
template <typename Sums>
double weight_of(const BitRow& row, const Sums& sums) {
  double sum = 0;
  for (std::size_t byte = 0; byte < kBytesOfWord; ++byte) {
    sum += sums[byte][row[byte / 8] >> (byte % 8 * 8) & 0xff];
  }
  return sum;
}

// The rows of the generator over the functionals in order of reliability, brought to a form in
// which each row alone decides one of the most reliable independent positions.
struct ReliableBasis {
  std::vector<BitRow> rows;
  std::vector<std::uint64_t> payloads;  // of the rows

  // Returns false if the positions do not determine a payload.
  bool reduce(std::size_t positions) {
    std::size_t done = 0;
    for (std::size_t at = 0; at < positions && done < rows.size(); ++at) {
      std::size_t pivot = done;
      while (pivot < rows.size() && !bit_of(rows[pivot], at)) ++pivot;
      if (pivot == rows.size()) continue;
      std::swap(rows[pivot], rows[done]);
      std::swap(payloads[pivot], payloads[done]);
      for (std::size_t other = 0; other < rows.size(); ++other) {
        if (other == done || !bit_of(rows[other], at)) continue;
        rows[other] = rows[other] ^ rows[done];
        payloads[other] ^= payloads[done];
      }
      pivots.push_back(at);
      ++done;
    }
    return done == rows.size();
  }

  std::vector<std::size_t> pivots;  // the position that each row decides
};

// The word whose difference from the hard decisions weighs least, among those within a few flips of
// the basis. The flipped positions of the basis alone bound the weight from below, so words that
// can neither be the best nor near it are passed over, and so are words heavier than `most`.
template <typename Sums>
class Search {
 public:
  Search(const ReliableBasis& basis, std::span<const double> reliability, const Sums& sums,
         double most)
      : basis_(basis), sums_(sums), most_(most) {
    for (const std::size_t pivot : basis.pivots) cost_.push_back(reliability[pivot]);
  }

  [[nodiscard]] std::optional<std::uint64_t> best(const BitRow& difference, std::uint64_t payload,
                                                  int flips) {
    least_ = weight_of(difference, sums_);
    best_ = payload;
    descend(difference, payload, basis_.rows.size(), flips, 0);
    if (least_ > most_ || next_ - least_ < kLeastLead) return std::nullopt;
    return best_;
  }

 private:
  // Flips rows below `rows`, the least reliable first.
  void descend(const BitRow& difference, std::uint64_t payload, std::size_t rows, int flips,
               double spent) {
    for (std::size_t row = rows; row-- > 0;) {
      const double cost = spent + cost_[row];
      if (cost >= std::min(least_, most_) + kLeastLead) return;  // as it is of all rows before
      const BitRow flipped = difference ^ basis_.rows[row];
      const std::uint64_t flipped_payload = payload ^ basis_.payloads[row];
      const double weight = weight_of(flipped, sums_);
      if (weight < least_) {
        next_ = least_;
        least_ = weight;
        best_ = flipped_payload;
      } else {
        next_ = std::min(next_, weight);
      }
      if (flips > 1) descend(flipped, flipped_payload, row, flips - 1, cost);
    }
  }

  const ReliableBasis& basis_;
  const Sums& sums_;
  double most_;
  std::vector<double> cost_;  // of flipping the position that a row decides; descending
  double least_ = 0;
  double next_ = std::numeric_limits<double>::infinity();  // of any other word
  std::uint64_t best_ = 0;
};

std::uint64_t low_bits(int bits) {
  return ~std::uint64_t{0} >> (64 - bits);
}

}  // namespace

FluxPhases phases_of(const FluxBits& bits) {
  FluxPhases phases{};
  for (std::size_t i = 0; i < kFunctionals; ++i) phases[i] = 0.5 * bits[i];
  return phases;
}

BlockCode::BlockCode(const Key& key, FluxContent content, int bits)
    : content_(content), bits_(bits) {
  const auto size = static_cast<std::size_t>(bits);
  // one stream for all codes of a key; each has a stretch of its own
  constexpr std::size_t kStretches = 65 * kFluxContents.size();
  const std::vector<std::uint8_t> bytes =
      key.stream(KeyUse::FluxScramble, kStretches * kFunctionals / 8);
  const std::size_t stretch = size * kFluxContents.size() + static_cast<std::size_t>(content);
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    columns_[i] = random_bits(kGenerator, size, i) & low_bits(bits);
    const std::size_t at = stretch * kFunctionals + i;
    scramble_[i] = bytes[at / 8] >> (at % 8) & 1U;
  }
}

FluxBits BlockCode::encode(std::uint64_t payload) const {
  FluxBits word{};
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    word[i] = (std::popcount(columns_[i] & payload) & 1) ^ scramble_[i];
  }
  return word;
}

SoftOrder::SoftOrder(const SoftBits& soft) : most_evidence_(soft.most_evidence()) {
  static_assert(kBytes == kBytesOfWord);
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    if (soft.ratio[i] != 0) functionals_.push_back(i);
  }
  std::stable_sort(functionals_.begin(), functionals_.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(soft.ratio[a]) > std::abs(soft.ratio[b]);
  });
  for (const std::size_t i : functionals_) {
    reliability_.push_back(std::abs(soft.ratio[i]));
    is_one_.push_back(soft.ratio[i] < 0);
  }
  for (std::size_t byte = 0; byte < kBytes; ++byte) {
    for (std::size_t value = 1; value < 256; ++value) {
      const std::size_t at = byte * 8 + static_cast<std::size_t>(std::countr_zero(value));
      sums_[byte][value] =
          sums_[byte][value & (value - 1)] + (at < reliability_.size() ? reliability_[at] : 0);
    }
  }
}

std::optional<std::uint64_t> BlockCode::decode(const SoftOrder& soft, double least_evidence) const {
  const std::vector<std::size_t>& order = soft.functionals_;
  if (order.size() < static_cast<std::size_t>(bits_)) return std::nullopt;
  ReliableBasis basis;
  basis.rows.resize(static_cast<std::size_t>(bits_));
  BitRow hard{};
  for (std::size_t at = 0; at < order.size(); ++at) {
    const std::size_t i = order[at];
    for (std::uint64_t column = columns_[i]; column != 0; column &= column - 1) {
      set_bit(basis.rows[static_cast<std::size_t>(std::countr_zero(column))], at);
    }
    if (soft.is_one_[at] != (scramble_[i] != 0)) set_bit(hard, at);
  }
  for (int row = 0; row < bits_; ++row) basis.payloads.push_back(std::uint64_t{1} << row);
  if (!basis.reduce(order.size())) return std::nullopt;
  BitRow difference = hard;
  std::uint64_t payload = 0;
  for (std::size_t row = 0; row < basis.rows.size(); ++row) {
    if (!bit_of(hard, basis.pivots[row])) continue;
    difference = difference ^ basis.rows[row];
    payload ^= basis.payloads[row];
  }
  // The evidence for a word is the most there is less the weight of its difference.
  const double most = (soft.most_evidence_ - least_evidence) * M_LN2 + kRounding;
  return Search(basis, soft.reliability_, soft.sums_, most)
      .best(difference, payload, bits_ <= kSmallPayload ? 3 : 2);
}

}  // namespace triglyph
