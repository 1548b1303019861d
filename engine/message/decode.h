// From votes to the message.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/message/votes.h"
#include "engine/message/words.h"

namespace triglyph {

struct Decoded {
  std::optional<Message> message;  // nothing: no mark under this key
  // Chance that votes which mean nothing yield a message: 2^-32, the tag's, times the most values
  // that could have been tried.
  double false_alarm = 0;
};

// The message of the best value of every part; if its tag is wrong, with the second best in place
// of up to `doubtful` parts, in all 2^doubtful ways: the parts that hold the length, then those
// whose second best is least behind. 0 <= doubtful <= 16. This work is based on: Chase. A class of
// algorithms for decoding block codes with channel measurement information. IEEE Transactions on
// Information Theory 18 (1972).
[[nodiscard]] Decoded decode(const Votes& votes, const WordCode& code, int doubtful);

}  // namespace triglyph
