#include "engine/message/key.h"

#include <set>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "engine/base/error.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

TEST(Key, ComesBackFromItsFile) {
  const test::TempFolder folder;
  const Key key = Key::generate();
  key.save(folder / "a.key");
  const Key loaded = Key::load(folder / "a.key");
  EXPECT_EQ(loaded.fingerprint(), key.fingerprint());
  EXPECT_EQ(loaded.stream(KeyUse::Keystream, 100), key.stream(KeyUse::Keystream, 100));
}

TEST(Key, FileIsPrivateAndNeverOverwritten) {
  const test::TempFolder folder;
  Key::generate().save(folder / "a.key");
  struct stat status {};
  ASSERT_EQ(stat((folder / "a.key").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
  EXPECT_THROW(Key::generate().save(folder / "a.key"), Error);
}

TEST(Key, IsRefusedIfOthersMayReadIt) {
  const test::TempFolder folder;
  Key::generate().save(folder / "a.key");
  chmod((folder / "a.key").c_str(), 0640);
  EXPECT_THROW((void)Key::load(folder / "a.key"), Error);
}

TEST(Key, IsRefusedBehindASymbolicLinkAndWhereThereIsNone) {
  const test::TempFolder folder;
  Key::generate().save(folder / "a.key");
  std::filesystem::create_symlink(folder / "a.key", folder / "b.key");
  EXPECT_THROW((void)Key::load(folder / "b.key"), Error);
  EXPECT_THROW((void)Key::load(folder / "absent.key"), Error);
  EXPECT_THROW((void)Key::load(folder.path()), Error);
}

TEST(Key, IsRefusedIfOneDigitIsWrong) {
  const test::TempFolder folder;
  Key::generate().save(folder / "a.key");
  std::string text = test::read_all(folder / "a.key");
  char& digit = text[text.find("secret ") + 10];
  digit = digit == '0' ? '1' : '0';
  const auto spoiled = folder.write("b.key", text);
  chmod(spoiled.c_str(), 0600);
  EXPECT_THROW((void)Key::load(spoiled), Error);
  const auto foreign = folder.write("c.key", "-----BEGIN KEY-----\n");
  chmod(foreign.c_str(), 0600);
  EXPECT_THROW((void)Key::load(foreign), Error);
}

TEST(Key, StreamsDifferByUseAndByKeyAndExtendEachOther) {
  const Key key = Key::trial();
  EXPECT_NE(key.stream(KeyUse::Marker, 32), key.stream(KeyUse::Offsets, 32));
  EXPECT_NE(key.stream(KeyUse::Marker, 32), Key::generate().stream(KeyUse::Marker, 32));
  const auto longer = key.stream(KeyUse::Marker, 64);
  EXPECT_EQ(key.stream(KeyUse::Marker, 32),
            std::vector<std::uint8_t>(longer.begin(), longer.begin() + 32));
}

// Every file ever marked with the trial key depends on these values.
TEST(Key, TrialKeysDifferByNumberAndNumberZeroIsTheOneWithoutANumber) {
  EXPECT_EQ(Key::trial(0).fingerprint(), Key::trial().fingerprint());
  EXPECT_NE(Key::trial(1).fingerprint(), Key::trial(0).fingerprint());
  EXPECT_NE(Key::trial(1).fingerprint(), Key::trial(2).fingerprint());
  EXPECT_FALSE(Key::trial(1).is_trial());  // a mark made without a key is nobody else's
}

TEST(Key, TrialKeyNeverChanges) {
  EXPECT_TRUE(Key::trial().is_trial());
  EXPECT_FALSE(Key::generate().is_trial());
  EXPECT_EQ(Key::trial().fingerprint(), "e53abf9102f99d1b");
}

TEST(Hex, RoundTripsAndRefusesOtherText) {
  const std::vector<std::uint8_t> bytes{0, 1, 0x7f, 0xff};
  EXPECT_EQ(to_hex(bytes), "00017fff");
  EXPECT_EQ(from_hex("00017fff"), bytes);
  EXPECT_THROW((void)from_hex("0"), Error);
  EXPECT_THROW((void)from_hex("0g"), Error);
}

// BLAKE2b-256 of "abc"; any other tool's b2sum -l 256 agrees.
TEST(ContentHash, IsBlake2b) {
  const std::string text = "abc";
  EXPECT_EQ(content_hash(text), "bddd813c634239723171ef3fee98579b94964e3bb1cb3e427262c8c068d52319");
}

}  // namespace
}  // namespace triglyph
