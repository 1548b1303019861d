#include "manifests/resume.h"

#include <gtest/gtest.h>

#include "engine/base/output_file.h"
#include "engine/io/export_mesh.h"
#include "engine/samples/sample_shapes.h"
#include "manifests/run.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// Three meshes and one that is no mesh, marked with a ledger as often as is wanted.
class Resumed : public testing::Test {
 protected:
  Resumed() {
    for (std::size_t i = 0; i < 3; ++i) {
      OutputFile file(folder_ / ("in/" + std::to_string(i) + ".obj"));
      file.write(export_mesh(make_sample_shape(SampleShape::Closed, 2500, i), {}));
      file.commit();
    }
    folder_.write("in/bad.obj", "v 1 2\n");
  }

  // Returns the numbers of meshes that were marked anew.
  std::vector<std::size_t> run(const OptionValues& values = {{"message", std::string("m")}},
                               const ResumeOptions& options = {}, const Key& key = Key::trial()) {
    Ledger ledger(folder_ / "l");
    const Resume resume(ledger, ledger.begin_run({.verb = "mark"}), key, options);
    MeshList jobs({{folder_ / "in/0.obj", folder_ / "in"},
                   {folder_ / "in/1.obj", folder_ / "in"},
                   {folder_ / "in/2.obj", folder_ / "in"},
                   {folder_ / "in/bad.obj", folder_ / "in"}},
                  values, folder_ / "out");
    const std::atomic<bool> stop{false};
    std::vector<std::size_t> anew;
    records_.clear();
    run_jobs(jobs, key, {.resume = &resume},
             {.delivered =
                  [&](const Record& record) {
                    if (!record.is_kept) anew.push_back(record.index);
                    records_.push_back(record);
                  }},
             stop);
    return anew;
  }

  test::TempFolder folder_;
  std::vector<Record> records_;
};

using Anew = std::vector<std::size_t>;

TEST_F(Resumed, DoesNothingTwice) {
  EXPECT_EQ(run(), (Anew{0, 1, 2, 3}));
  const std::vector<Record> first = records_;
  EXPECT_EQ(run(), Anew{});
  ASSERT_EQ(records_.size(), 4U);
  const auto without_times = [](const Record& record) {
    auto json = to_json(record);
    json.erase("run");
    return json.dump();
  };
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(without_times(records_[i]), without_times(first[i]));
  }
  EXPECT_EQ(records_[3].file.status, FileStatus::Malformed);
}

TEST_F(Resumed, DoesAgainWhatChangedAndNothingElse) {
  (void)run();
  OutputFile other(folder_ / "in/1.obj");
  other.write(export_mesh(make_sample_shape(SampleShape::Open, 2500, 9), {}));
  other.commit();
  EXPECT_EQ(run(), Anew{1});
  fs::remove(folder_ / "out/0.obj");
  folder_.write("out/2.obj", "not what was written");
  EXPECT_EQ(run(), (Anew{0, 2}));
  folder_.write("in/bad.obj", "v 1 2 x\n");
  EXPECT_EQ(run(), Anew{3});
  EXPECT_EQ(run(), Anew{});
  // other options, another message, another key: everything
  EXPECT_EQ(run({{"message", std::string("n")}}), (Anew{0, 1, 2, 3}));
  EXPECT_EQ(run({{"message", std::string("n")}, {"step", 0.006}}), (Anew{0, 1, 2, 3}));
  EXPECT_EQ(run({{"message", std::string("n")}, {"step", 0.006}}), Anew{});
  EXPECT_EQ(run({{"message", std::string("n")}, {"step", 0.006}}, {}, Key::generate()),
            (Anew{0, 1, 2, 3}));
}

TEST_F(Resumed, ForceDoesEverything) {
  (void)run();
  EXPECT_EQ(run({{"message", std::string("m")}}, {.force = true}), (Anew{0, 1, 2, 3}));
}

// Two meshes of one name from two folders, marked into one, must not replace each other unnoticed.
TEST_F(Resumed, RefusesAnOutputThatWasMadeFromAnotherMesh) {
  (void)run();
  OutputFile file(folder_ / "elsewhere/0.obj");
  file.write(export_mesh(make_sample_shape(SampleShape::Open, 2500, 4), {}));
  file.commit();
  const std::string before = test::read_all(folder_ / "out/0.obj");
  const auto mark_other = [&](const ResumeOptions& options) {
    Ledger ledger(folder_ / "l");
    const Resume resume(ledger, ledger.begin_run({.verb = "mark"}), Key::trial(), options);
    MeshList jobs({{folder_ / "elsewhere/0.obj", folder_ / "elsewhere"}},
                  {{"message", std::string("m")}}, folder_ / "out");
    const std::atomic<bool> stop{false};
    Record last;
    run_jobs(jobs, Key::trial(), {.resume = &resume},
             {.completed = [&](const Record& record) { last = record; }}, stop);
    return last;
  };
  const Record refused = mark_other({});
  EXPECT_EQ(refused.file.status, FileStatus::Exists);
  EXPECT_NE(refused.file.error.find("in/0.obj"), std::string::npos) << refused.file.error;
  EXPECT_EQ(test::read_all(folder_ / "out/0.obj"), before);
  EXPECT_EQ(mark_other({.force = true}).file.status, FileStatus::Marked);
  EXPECT_NE(test::read_all(folder_ / "out/0.obj"), before);
}

TEST_F(Resumed, NoClobberKeepsFilesThatTheLedgerDoesNotKnow) {
  folder_.write("out/0.obj", "somebody's");
  EXPECT_EQ(run({{"message", std::string("m")}}, {.no_clobber = true}), (Anew{0, 1, 2, 3}));
  EXPECT_EQ(records_[0].file.status, FileStatus::Exists);
  EXPECT_EQ(test::read_all(folder_ / "out/0.obj"), "somebody's");
  EXPECT_EQ(records_[1].file.status, FileStatus::Marked);
  // its own files it may replace
  OutputFile other(folder_ / "in/1.obj");
  other.write(export_mesh(make_sample_shape(SampleShape::Open, 2500, 9), {}));
  other.commit();
  (void)run({{"message", std::string("m")}}, {.no_clobber = true});
  EXPECT_EQ(records_[1].file.status, FileStatus::Marked);
}

// A run that was killed between the entry in the ledger and the name of the output.
TEST_F(Resumed, AnEntryWithoutItsOutputIsNotDone) {
  (void)run();
  fs::remove(folder_ / "out/1.obj");
  EXPECT_EQ(run(), Anew{1});
  std::size_t marks = 0;
  Ledger(folder_ / "l").for_each_mark([&](const LedgerMark&) { ++marks; });
  EXPECT_EQ(marks, 3U);  // the same bytes are the same mark
}

}  // namespace
}  // namespace triglyph
