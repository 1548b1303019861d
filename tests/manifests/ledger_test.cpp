#include "manifests/ledger.h"

#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/base/error.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

LedgerItem item_named(const std::string& target) {
  LedgerItem item;
  item.target = target;
  item.source = "/in/" + target;
  item.input_hash = "1234";
  item.task = "task";
  item.key = "key";
  item.status = "marked";
  item.output_hash = "abcd" + target;
  item.record = "{\"out\":\"x\"}";
  return item;
}

LedgerMark mark_named(const std::string& target) {
  LedgerMark mark;
  mark.message_hex = "6869";
  mark.mesh = "/in/" + target;
  mark.out = target;
  mark.scheme = "tsq";
  mark.options = "{}";
  mark.key = "key";
  mark.input_hash = "1234";
  mark.output_hash = "abcd" + target;
  return mark;
}

std::size_t count_marks(const Ledger& ledger) {
  std::size_t count = 0;
  ledger.for_each_mark([&](const LedgerMark&) { ++count; });
  return count;
}

TEST(Ledger, RemembersRunsItemsAndMarksWhenItIsOpenedAgain) {
  const test::TempFolder folder;
  std::int64_t run = 0;
  const std::string odd("/out/\xff\n\0'.obj", 12);  // names are bytes
  {
    Ledger ledger(folder / "a/l.ledger");
    run = ledger.begin_run({.verb = "mark", .command = "triglyph mark 'a b'"});
    LedgerItem item = item_named(odd);
    item.run = run;
    item.place = 7;
    ledger.put(item, mark_named(odd));
    ledger.end_run(run, "done");
  }
  const Ledger ledger(folder / "a/l.ledger");
  const auto item = ledger.find(odd);
  ASSERT_TRUE(item);
  EXPECT_EQ(item->target, odd);
  EXPECT_EQ(item->source, "/in/" + odd);
  EXPECT_EQ(item->record, "{\"out\":\"x\"}");
  EXPECT_EQ(item->run, run);
  EXPECT_EQ(item->place, 7U);
  EXPECT_FALSE(ledger.find("/out/"));
  const auto mark = ledger.mark_of("abcd" + odd);
  ASSERT_TRUE(mark);
  EXPECT_EQ(mark->out, odd);
  EXPECT_FALSE(mark->issued.empty());
  std::size_t runs = 0;
  ledger.for_each_run([&](const LedgerRun& one) {
    ++runs;
    EXPECT_EQ(one.command, "triglyph mark 'a b'");
    EXPECT_EQ(one.outcome, "done");
    EXPECT_EQ(one.started.size(), 20U);
  });
  EXPECT_EQ(runs, 1U);
}

TEST(Ledger, IssuesAMarkOnceAndNeverChangesOrDeletesIt) {
  const test::TempFolder folder;
  const auto path = folder / "l.ledger";
  Ledger ledger(path);
  const std::int64_t run = ledger.begin_run({.verb = "mark"});
  for (int i = 0; i < 3; ++i) {
    LedgerItem item = item_named("/a");
    item.run = run;
    item.status = i == 1 ? "malformed" : "marked";
    ledger.put(item, mark_named("/a"));
    EXPECT_EQ(ledger.find("/a")->status, item.status);
  }
  EXPECT_EQ(count_marks(ledger), 1U);
  LedgerMark other = mark_named("/a");
  other.output_hash = "other";
  ledger.put(item_named("/a"), other);
  EXPECT_EQ(count_marks(ledger), 2U);
}

TEST(Ledger, IsPrivateAndKnownByItsFirstBytes) {
  const test::TempFolder folder;
  { const Ledger ledger(folder / "l"); }
  struct stat status {};
  ASSERT_EQ(stat((folder / "l").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  EXPECT_TRUE(is_ledger_file(folder / "l"));
  EXPECT_FALSE(is_ledger_file(folder.write("x", "SQLite format")));
  EXPECT_FALSE(is_ledger_file(folder / "absent"));
}

TEST(Ledger, RefusesWhatIsNoLedgerAndLeavesItAsItIs) {
  const test::TempFolder folder;
  const auto text = folder.write("notes.txt", std::string(5000, 'n'));
  EXPECT_THROW(Ledger{text}, Error);
  EXPECT_EQ(test::read_all(text), std::string(5000, 'n'));
  EXPECT_THROW(Ledger{folder.path()}, Error);

  // a database of something else, and a ledger of a later schema
  const auto change = [&](const std::string& name, std::size_t offset, char byte) {
    { const Ledger ledger(folder / name); }
    std::fstream file(folder / name, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(offset));
    file.put(byte);
    file.close();
    try {
      const Ledger ledger(folder / name);
      return std::string("opened");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Malformed);
      return error.message();
    }
  };
  // the header's big-endian application id is at byte 68, the user version at byte 60 (SQLite's
  // file format, section 1.3)
  EXPECT_NE(change("foreign", 71, 'x').find("no ledger"), std::string::npos);
  EXPECT_NE(change("later", 63, 99).find("newer triglyph"), std::string::npos);
}

TEST(Ledger, KeepsWhatARunFoundInFiles) {
  const test::TempFolder folder;
  const auto results = [&] {
    std::vector<LedgerResult> all;
    Ledger(folder / "l").for_each_result([&](const LedgerResult& one) { all.push_back(one); });
    return all;
  };
  {
    Ledger ledger(folder / "l");
    const std::int64_t first = ledger.begin_run({.verb = "extract"});
    const std::int64_t second = ledger.begin_run({.verb = "verify"});
    ledger.note({.run = second, .place = 0, .file = "/c", .status = "intact", .line = "{}"});
    ledger.note({.run = first, .place = 1, .file = "/b\xff", .status = "no mark", .line = "{}"});
    ledger.note({.run = first, .place = 0, .file = "/a", .status = "x", .line = "{}"});
    // a worker that was killed may have noted it and not said so
    ledger.note({.run = first, .place = 0, .file = "/a", .status = "marked", .line = "{\"a\":1}"});
  }
  const auto all = results();
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].status, "marked");
  EXPECT_EQ(all[0].line, "{\"a\":1}");
  EXPECT_EQ(all[1].file, "/b\xff");
  EXPECT_EQ(all[1].place, 1U);
  EXPECT_EQ(all[2].run, all[0].run + 1);
}

// A ledger that the build of schema 1 wrote: one run, two outputs and their marks.
TEST(Ledger, KeepsTheLastStateOfEachOutput) {
  const test::TempFolder folder;
  Ledger ledger(folder / "l");
  const std::string odd("/out/\xff\n\0'.obj", 12);
  EXPECT_FALSE(ledger.state_of(odd));
  for (const char* state : {"intact", "altered"}) {
    const std::int64_t run = ledger.begin_run({.verb = "sweep"});
    ledger.put_state({.target = odd,
                      .state = state,
                      .change = "c",
                      .expected = "12",
                      .hash = "34",
                      .is_accepted = state == std::string("altered"),
                      .line = "{}",
                      .run = run});
    std::size_t states = 0;
    ledger.for_each_state(run, [&](const LedgerState&) { ++states; });
    EXPECT_EQ(states, 1U);
    const auto known = ledger.state_of(odd);
    ASSERT_TRUE(known);
    EXPECT_EQ(known->target, odd);
    EXPECT_EQ(known->state, state);
    EXPECT_EQ(known->change, "c");
    EXPECT_EQ(known->expected, "12");
    EXPECT_EQ(known->hash, "34");
    EXPECT_EQ(known->line, "{}");
    EXPECT_EQ(known->is_accepted, state == std::string("altered"));
  }
  ledger.for_each_state(1,
                        [](const LedgerState&) { FAIL() << "that of the first run is replaced"; });
}

TEST(Ledger, OpensOneOfAnEarlierSchemaWithAllThatItKnows) {
  const test::TempFolder folder;
  const auto path = folder.write(
      "l", test::read_all(std::filesystem::path(TRIGLYPH_SOURCE) / "tests/golden/schema-1.ledger"));
  ASSERT_EQ(test::read_all(path)[63], 1);  // the user version, see above
  for (int opened = 0; opened < 2; ++opened) {
    Ledger ledger(path);
    EXPECT_EQ(count_marks(ledger), 2U);
    const auto item = ledger.find_after("");
    ASSERT_TRUE(item);
    EXPECT_EQ(item->status, "marked");
    ASSERT_TRUE(ledger.find_after(item->target));
    std::vector<LedgerRun> runs;
    ledger.for_each_run([&](const LedgerRun& run) { runs.push_back(run); });
    ASSERT_EQ(runs.size(), 1U);
    EXPECT_EQ(runs[0].outcome, "done");
    ledger.note({.run = 1, .place = 0, .file = "/a", .status = "marked", .line = "{}"});
    std::size_t results = 0;
    ledger.for_each_result([&](const LedgerResult&) { ++results; });
    EXPECT_EQ(results, 1U);
  }
  EXPECT_EQ(test::read_all(path)[63], 5);
}

TEST(Ledger, TakesWritersOfManyThreadsAndProcesses) {
  const test::TempFolder folder;
  const auto path = folder / "l";
  { const Ledger ledger(path); }
  const auto write = [&](const std::string& who) {
    Ledger ledger(path);
    const std::int64_t run = ledger.begin_run({.verb = "mark"});
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t) {
      threads.emplace_back([&, t] {
        for (int i = 0; i < 20; ++i) {
          const std::string name = who + std::to_string(t) + "-" + std::to_string(i);
          LedgerItem item = item_named(name);
          item.run = run;
          ledger.put(item, mark_named(name));
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  };
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    try {
      write("child");
    } catch (...) {
      _exit(1);
    }
    _exit(0);
  }
  write("parent");
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  const Ledger ledger(path);
  EXPECT_EQ(count_marks(ledger), 120U);
  std::string last;
  std::size_t items = 0;
  while (const auto item = ledger.find_after(last)) {
    EXPECT_LT(last, item->target);  // by name
    last = item->target;
    ++items;
  }
  EXPECT_EQ(items, 120U);
}

}  // namespace
}  // namespace triglyph
