// Decoding of votes into a message.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/message/votes.h"
#include "engine/message/words.h"

namespace triglyph {

struct Decoded {
  std::optional<Message> message;  // nothing: no mark under this key
  // Probability that random votes yield a message: 2^-32 for the tag, times the number of candidate
  // messages that can be tried.
  double false_alarm = 0;
};

// Returns the message that the best value of every part gives. If its tag is wrong, tries all
// 2^doubtful ways of replacing the best value by the second best in `doubtful` parts: first those
// that hold the length, then those whose two scores are closest. Precondition: 0 <= doubtful <= 16.
// O(2^doubtful * message). Of a spread message, the one of each length that agrees best with all
// votes is tried, and `doubtful` has no effect.
// This work is based on:
// Chase. A class of algorithms for decoding block codes with channel measurement information. IEEE
// Transactions on Information Theory 18 (1972).
[[nodiscard]] Decoded decode(const Votes& votes, const WordCode& code, int doubtful);

// Returns the message of up to kMaxSpreadBytes whose bits and parities agree best with all votes,
// as far as they are trusted: of a mark that lost parts. Nothing for a spread message, which
// decode() corrects. Some tens of milliseconds on one core, parallel.
[[nodiscard]] Decoded correct(const Votes& votes, const WordCode& code);

}  // namespace triglyph
