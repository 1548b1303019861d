#include "engine/message/decode.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace triglyph {
namespace {

// Units that damage spared lie at the centres of their cells, so that weights tell them from
// chance; noise moves all units, and then weights tell little. Of 28 marks of seven meshes each
// alone read 14 and 12 after a simplification by half, 4 and 12 after noise of 0.02 %.
constexpr std::array<Votes::Trust, 2> kTrusts = {{{0.9, 2}, {0.5, 0.25}}};

using Parts = std::vector<std::optional<std::uint32_t>>;

class ChaseDecoder {
 public:
  ChaseDecoder(const Votes& votes, const WordCode& code)
      : code_(code), rankings_(votes.rankings()), parts_(rankings_.size()) {
    for (std::size_t i = 0; i < parts_.size(); ++i) choose(i, 0);
  }

  [[nodiscard]] std::optional<Message> best() const { return code_.message_of(parts_); }

  // The parts that hold the length determine the number of parts, so they are varied first.
  [[nodiscard]] std::optional<Message> vary(int doubtful) {
    const auto part_bits = static_cast<std::size_t>(code_.format().part_bits);
    const std::size_t header = std::min((8 + part_bits - 1) / part_bits, parts_.size());
    if (static_cast<std::size_t>(doubtful) < header) return std::nullopt;
    std::vector<std::size_t> indices(header);
    for (std::size_t i = 0; i < header; ++i) indices[i] = i;
    return for_each_way(indices, [&]() -> std::optional<Message> {
      const auto wanted = code_.parts_wanted(parts_);
      if (!wanted || *wanted > parts_.size()) return std::nullopt;
      const auto doubted =
          most_doubtful(header, *wanted, static_cast<std::size_t>(doubtful) - header);
      return for_each_way(doubted, [&] { return code_.message_of(parts_); });
    });
  }

 private:
  void choose(std::size_t index, std::size_t rank) {
    const Votes::Ranking& ranking = rankings_[index];
    if (rank < ranking.size()) parts_[index] = ranking[rank].part;
  }

  // Calls attempt() with all combinations of the best and second best values of these parts until
  // it returns a message.
  template <typename Attempt>
  std::optional<Message> for_each_way(const std::vector<std::size_t>& indices,
                                      const Attempt& attempt) {
    std::optional<Message> found;
    for (std::uint32_t way = 0; way < 1U << indices.size() && !found; ++way) {
      for (std::size_t i = 0; i < indices.size(); ++i) choose(indices[i], way >> i & 1);
      found = attempt();
    }
    for (const std::size_t index : indices) choose(index, 0);
    return found;
  }

  [[nodiscard]] std::vector<std::size_t> most_doubtful(std::size_t begin, std::size_t end,
                                                       std::size_t count) const {
    std::vector<std::size_t> indices;
    for (std::size_t i = begin; i < end; ++i) {
      if (rankings_[i].size() > 1) indices.push_back(i);
    }
    const auto lead = [&](std::size_t i) { return rankings_[i][0].score - rankings_[i][1].score; };
    std::sort(indices.begin(), indices.end(), [&](std::size_t a, std::size_t b) {
      return lead(a) != lead(b) ? lead(a) < lead(b) : a < b;
    });
    if (indices.size() > count) indices.resize(count);
    return indices;
  }

  const WordCode& code_;
  std::vector<Votes::Ranking> rankings_;
  Parts parts_;
};

}  // namespace

Decoded decode(const Votes& votes, const WordCode& code, int doubtful) {
  if (code.format().is_spread) {
    return {code.spread_message_of(votes.balances()),
            std::ldexp(static_cast<double>(kMaxSpreadBytes), -32)};
  }
  ChaseDecoder decoder(votes, code);
  Decoded decoded{decoder.best(), std::ldexp(1.0, doubtful - 32)};
  if (!decoded.message && doubtful > 0) decoded.message = decoder.vary(doubtful);
  return decoded;
}

Decoded correct(const Votes& votes, const WordCode& code) {
  Decoded decoded;
  if (code.format().is_spread) return decoded;
  for (const Votes::Trust& trust : kTrusts) {
    if (decoded.message) break;
    decoded.message = code.corrected_message_of(votes.bit_evidence(trust));
    decoded.false_alarm += std::ldexp(static_cast<double>(kMaxSpreadBytes), -32);
  }
  return decoded;
}

}  // namespace triglyph
