#include "engine/marking/refusal.h"

#include <gtest/gtest.h>

namespace triglyph {
namespace {

// A marking of a message of so many bytes that failed, with 12 parts and 20 units.
Marking failed(MarkStatus status, const WayOut& way_out) {
  Marking marking;
  marking.status = status;
  marking.words.resize(12);
  marking.parts_needed = 12;
  marking.units_valid = 20;
  marking.parts_carried = 9;
  marking.way_out = way_out;
  return marking;
}

std::string reason(const Marking& marking, const Payload& payload = Message(8)) {
  return refusal(marking, {payload, {}}, 0.25);
}

TEST(Refusal, SaysByHowMuchAMessageIsTooLong) {
  const Marking marking = failed(MarkStatus::TooSmall, {.message_bytes = 7});
  EXPECT_EQ(reason(marking), "12 parts needed, 11 fit: shorten the message by 1 byte");
}

TEST(Refusal, SaysThatFartherMovesWouldDo) {
  EXPECT_EQ(reason(failed(MarkStatus::TooSmall, {.message_bytes = 5, .max_move_percent = 1.4})),
            "12 parts needed, 9 fit: shorten the message by 3 bytes, or allow moves that may be "
            "seen with --max-move 1.4");
  EXPECT_EQ(reason(failed(MarkStatus::TooSmall, {.max_move_percent = 2})),
            "12 parts needed, 9 carried: allow moves that may be seen with --max-move 2");
}

TEST(Refusal, SaysThatNoMessageFits) {
  Marking marking = failed(MarkStatus::TooSmall, {.least_parts_carried = 4});
  EXPECT_EQ(reason(marking),
            "this mesh carries no message of any length under tsq: its 20 units carry 4 of the 6 "
            "parts of a message of 1 byte");
  marking.units_valid = 1;
  EXPECT_EQ(reason(marking),
            "this mesh carries no message of any length under tsq: it has 1 unit, a message of 1 "
            "byte needs 6");
}

TEST(Refusal, SaysWhatFillLacks) {
  Marking marking = failed(MarkStatus::TooSmall, {});
  EXPECT_EQ(reason(marking, Fill{}), "none of this mesh's 20 units under tsq can carry a part");
  marking.units_valid = 0;
  EXPECT_EQ(reason(marking, Fill{}), "this mesh has no unit under tsq");
}

TEST(Refusal, NamesTheLeastLimitOfMovesThatDoes) {
  EXPECT_EQ(reason(failed(MarkStatus::TooVisible,
                          {.move_needed_percent = 0.13156, .max_move_percent = 0.14})),
            "some part needs a move of 0.132 % of the diagonal; --max-move 0.14 would do");
}

TEST(Refusal, ShowsTheMarkThatIsThereInALine) {
  const auto shown = [](const std::string& text) {
    Marking marking;
    marking.status = MarkStatus::AlreadyMarked;
    marking.found = {Message(text.begin(), text.end()), 32, {}};
    return reason(marking);
  };
  EXPECT_EQ(shown("for Ada"),
            "carries \"for Ada\" under this key already (32 units agree); --remark marks it again");
  EXPECT_NE(shown("f\xc3\xbcr").find("\"f\xc3\xbcr\""), std::string::npos);
  EXPECT_NE(shown("\xe2\x82\xac").find("\"\xe2\x82\xac\""), std::string::npos);
  EXPECT_NE(shown("a\nb").find("carries 0x610a62 under"), std::string::npos);
  EXPECT_NE(shown("a\xc2\x9b").find("0x61c29b"), std::string::npos);
  EXPECT_NE(shown("\xff").find("0xff"), std::string::npos);
  EXPECT_NE(shown("\xc3").find("0xc3"), std::string::npos);
}

TEST(Refusal, SaysWhatTheMemoryIsFor) {
  EXPECT_EQ(too_little_memory(812345678),
            "not enough memory: this mesh takes about 812 MB; with --memory 1M no other is in "
            "process at the same time");
  EXPECT_NE(too_little_memory(999700000).find("about 1 GB;"), std::string::npos);
  EXPECT_NE(too_little_memory(12345678901).find("about 12.3 GB;"), std::string::npos);
}

TEST(Refusal, SaysWhetherTrianglesWouldDo) {
  EXPECT_EQ(not_read_back(5, 11, true),
            "the mark could not be read back (5 of 11 units): its polygons are cut into other "
            "triangles once points have moved; export the mesh as triangles, from which the mark "
            "can be read");
  EXPECT_EQ(not_read_back(0, 1, false),
            "the mark could not be read back (0 of 1 unit): try another --scheme");
}

TEST(Refusal, SaysHowCoarseNumbersBecomeFine) {
  EXPECT_EQ(reason(failed(MarkStatus::TooCoarse, {})),
            "numbers 0.25 apart are too coarse for the mark: export the mesh with more digits or "
            "as float64");
  EXPECT_EQ(reason(failed(MarkStatus::TooCoarse, {.step = 0.045})),
            "numbers 0.25 apart are too coarse for the mark: export the mesh with more digits or "
            "as float64, or mark it with --step 0.045");
}

}  // namespace
}  // namespace triglyph
