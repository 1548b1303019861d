#include "manifests/recipients.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/io/export_mesh.h"
#include "engine/marking/kept_shape.h"
#include "manifests/manifest.h"
#include "manifests/run.h"
#include "manifests/suspects_of.h"
#include "tests/flux/flux_shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

class RecipientLists : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> names(const std::string& file,
                                               const std::string& text) const {
    std::vector<std::string> all;
    const auto list = read_recipients(folder_.write(file, text));
    for (const Recipient& one : *list) all.push_back(one.name);
    return all;
  }
  test::TempFolder folder_;
};

TEST_F(RecipientLists, AreReadALineEach) {
  const std::vector<std::string> wanted = {"Ada", "Ben, Ltd.", "Zoë"};
  EXPECT_EQ(names("l.txt", "Ada\r\n\n  Ben, Ltd. \nZoë"), wanted);
  EXPECT_EQ(names("l.csv", "recipient,mail\nAda,a@b\n\"Ben, Ltd.\",\"x\"\nZoë\n"), wanted);
  EXPECT_EQ(names("q.csv", "\xef\xbb\xbfname\n\"say \"\"hi\"\"\",1\n"),
            std::vector<std::string>{"say \"hi\""});
  EXPECT_EQ(names("h.txt", "name\n"), std::vector<std::string>{"name"});  // no heading
}

TEST_F(RecipientLists, ThatCannotBeMeantAreRefusedWithTheirLine) {
  const auto error_of = [&](const std::string& file, const std::string& text) {
    try {
      (void)read_recipients(folder_.write(file, text));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(
      error_of("a.txt", "Ada\nBen\nAda\n").find("line 3: \"Ada\" is there twice, first in line 1"),
      std::string::npos)
      << error_of("a.txt", "Ada\nBen\nAda\n");
  EXPECT_NE(error_of("a.txt", "Ada\nB\x01\n").find("line 2"), std::string::npos);
  EXPECT_NE(error_of("a.txt", std::string(300, 'x')).find("not 300"), std::string::npos);
  EXPECT_NE(error_of("a.csv", "Ada\n\"Ben\n").find("line 2"), std::string::npos);
  EXPECT_NE(error_of("a.txt", "\n\n").find("names no recipient"), std::string::npos);
  EXPECT_THROW((void)read_recipients(folder_ / "absent"), Error);
  EXPECT_THROW((void)read_recipients(folder_.path()), Error);
}

TEST(Recipients, HaveFoldersThatLeaveNoPath) {
  EXPECT_EQ(folder_of("Ada Lovelace"), "Ada Lovelace");
  EXPECT_EQ(folder_of("a/b"), "a%2fb");
  EXPECT_EQ(folder_of(".."), "%2e%2e");
  EXPECT_EQ(folder_of("100%"), "100%25");
  EXPECT_EQ(folder_of("a."), "a%2e");
  EXPECT_EQ(folder_of("Zoë"), "Zoë");
  EXPECT_NE(folder_of("a/b"), folder_of("a%2fb"));
}

class RunsForRecipients : public testing::Test {
 protected:
  void save(const std::string& name, const Mesh& mesh) const {
    const std::vector<char> bytes = export_mesh(mesh, {});
    folder_.write(name, std::string(bytes.begin(), bytes.end()));
  }
  [[nodiscard]] std::vector<Job> jobs_of(const std::string& manifest) const {
    CopiesSource source(std::make_unique<ManifestReader>(folder_.write("m.jsonl", manifest),
                                                         OptionValues(), folder_ / "out"),
                        nullptr, folder_ / "out");
    std::vector<Job> jobs;
    while (std::optional<Job> job = source.next()) jobs.push_back(std::move(*job));
    return jobs;
  }
  test::TempFolder folder_;
};

TEST_F(RunsForRecipients, MakeACopyForEach) {
  folder_.write("list.txt", "Ada\nBen\n");
  folder_.write("a.obj", "");
  folder_.write("sub/b.obj", "");
  const std::vector<Job> jobs = jobs_of(
      "{\"triglyph\":1,\"defaults\":{\"recipients\":\"list.txt\"}}\n{\"mesh\":\"a.obj\"}\n"
      "{\"mesh\":\"sub/b.obj\"}\n{\"mesh\":\"sub/b.obj\",\"out\":\"else/\"}\n");
  ASSERT_EQ(jobs.size(), 6U);
  const std::vector<std::string> outs = {"out/Ada/a.obj",      "out/Ben/a.obj",
                                         "out/Ada/sub/b.obj",  "out/Ben/sub/b.obj",
                                         "else/sub/Ada/b.obj", "else/sub/Ben/b.obj"};
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    EXPECT_EQ(jobs[i].index, i);
    EXPECT_EQ(jobs[i].out, folder_ / outs[i]);
    EXPECT_EQ(jobs[i].request.options.carry, Carry::Fingerprint);
    EXPECT_EQ(jobs[i].request.message(),
              (i % 2 == 0 ? Message{'A', 'd', 'a'} : Message{'B', 'e', 'n'}));
    EXPECT_EQ(jobs[i].copies == jobs[i / 2 * 2].copies, true);
  }
  EXPECT_NE(jobs[0].copies, jobs[2].copies);
}

TEST_F(RunsForRecipients, AreEnteredInTheLedgerThatKnowsThemAgain) {
  save("a.obj", test::knobbly(40));
  folder_.write("list.txt", "Ada\nBen\nCem\n");
  Ledger ledger(folder_ / "l.ledger");
  const auto mark_all = [&] {
    const Resume resume(ledger, ledger.begin_run({}), Key::trial(), {});
    RunContext context;
    context.resume = &resume;
    CopiesSource source(
        std::make_unique<ManifestReader>(
            folder_.write("m.jsonl", "{\"mesh\":\"a.obj\",\"recipients\":\"list.txt\"}\n"),
            OptionValues(), folder_ / "out"),
        nullptr, folder_ / "out");
    std::vector<Record> records;
    run_jobs(source, Key::trial(), context,
             {.delivered = [&](const Record& record) { records.push_back(record); }}, false);
    return records;
  };
  const std::vector<Record> records = mark_all();
  ASSERT_EQ(records.size(), 3U);
  for (const Record& record : records) {
    ASSERT_EQ(record.file.status, FileStatus::Traceable) << record.file.error;
    const Record again = parse_record(line_of(record));
    EXPECT_EQ(line_of(again), line_of(record));
    EXPECT_EQ(again.file.evidence, record.file.evidence);
  }
  for (const Record& record : mark_all()) EXPECT_TRUE(record.is_kept);
  std::vector<std::string> recipients;
  ledger.for_each_mark([&](const LedgerMark& mark) { recipients.push_back(mark.recipient); });
  std::sort(recipients.begin(), recipients.end());
  EXPECT_EQ(recipients, (std::vector<std::string>{"Ada", "Ben", "Cem"}));
  const std::vector<Key> keys = {Key::trial(), Key::trial(1)};
  const KnownCopies known = known_copies(&ledger, nullptr, {}, keys, {});
  ASSERT_EQ(known.suspects.size(), 2U);
  EXPECT_EQ(known.suspects[0].count(), 3U);
  EXPECT_EQ(known.suspects[1].count(), 0U);
  ASSERT_TRUE(known.suspects[0].groups()[0].group.shapes);  // one mesh, three copies
  EXPECT_EQ(known.suspects[0].groups()[0].group.shapes->size(), 1U);
  EXPECT_TRUE(KeptShape::from_bytes(known.suspects[0].groups()[0].group.shapes->bytes(0)));
  const FileTrace trace = trace_file(folder_ / "out/Ben/a.obj", known.suspects, {});
  ASSERT_FALSE(trace.names.empty());
  EXPECT_EQ(trace.names[0].name, (Message{'B', 'e', 'n'}));
  EXPECT_TRUE(TraceOptions{}.believes(trace.names[0]));
}

}  // namespace
}  // namespace triglyph
