#include "manifests/sweep.h"

#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/parallel.h"
#include "engine/io/export_mesh.h"
#include "engine/io/mesh_file.h"
#include "engine/mesh/edge_length.h"
#include "engine/samples/sample_shapes.h"
#include "manifests/manifest.h"
#include "manifests/run.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// A library of marked meshes, in a ledger.
class Library {
 public:
  static constexpr std::size_t kFiles = 9;

  Library() : ledger_(folder_ / "l.ledger") {
    std::vector<NamedFile> meshes;
    for (std::size_t i = 0; i < kFiles; ++i) {
      const fs::path path = folder_ / ("in/" + std::to_string(i) + ".obj");
      OutputFile file(path);
      file.write(export_mesh(make_sample_shape(SampleShape::Closed, 600, i), {}));
      file.commit();
      meshes.push_back({path, folder_ / "in"});
    }
    MeshList jobs(
        meshes, {{"message", std::string("ab")}, {"scheme", std::string("tsq")}, {"detail", true}},
        folder_ / "out");
    const std::int64_t run = ledger_.begin_run({.verb = "mark"});
    const Resume resume(ledger_, run, Key::trial(), {});
    RunContext context;
    context.resume = &resume;
    const std::atomic<bool> stop{false};
    run_jobs(jobs, Key::trial(), context,
             {.delivered = [](const Record& record) { ASSERT_TRUE(record.file.is_marked()); }},
             stop);
  }

  [[nodiscard]] fs::path file(std::size_t i) const {
    return folder_ / ("out/" + std::to_string(i) + ".obj");
  }
  [[nodiscard]] fs::path folder() const { return folder_.path(); }
  Ledger& ledger() { return ledger_; }

  std::int64_t begin() { return ledger_.begin_run({.verb = "sweep"}); }

  std::vector<SweptFile> sweep_as(std::int64_t run, const SweepOptions& options = {},
                                  std::size_t most = ~std::size_t{0}) {
    std::vector<SweptFile> files;
    std::atomic<bool> stop{false};
    const std::vector<Key> keys{key_};
    end_ = sweep(
        ledger_, run, keys, options, {},
        [&](const SweptFile& file) {
          files.push_back(file);
          if (files.size() == most) stop = true;
        },
        stop);
    return files;
  }
  std::vector<SweptFile> sweep_again(const SweepOptions& options = {}) {
    return sweep_as(begin(), options);
  }

  // The news of a new sweep, by the file's name.
  std::map<std::string, std::string> news(const SweepOptions& options = {}) {
    std::map<std::string, std::string> found;
    for (const SweptFile& file : sweep_again(options)) {
      if (file.is_news()) {
        found[fs::path(file.target).filename().string()] =
            std::string(name_of(file.state)) + (file.is_new ? "" : " still");
      }
    }
    return found;
  }

  void append(std::size_t i, const std::string& text) const {
    std::ofstream(file(i), std::ios::app) << text;
  }

  // Moves the vertices near one place, by a tenth of an edge or so.
  void dent(std::size_t i) const {
    const MeshFile mesh = MeshFile::open(file(i));
    std::vector<Vec3> positions = mesh.mesh().positions;
    const Vec3 place = positions[positions.size() / 2];
    const double edge = mean_edge_length(mesh.mesh());
    for (Vec3& p : positions) {
      if ((p - place).norm() < 2 * edge) p += Vec3(0.3, -0.2, 0.25) * edge * std::sin(7e3 * p[0]);
    }
    const std::vector<char> bytes = mesh.patched(positions);
    OutputFile out(file(i));
    out.write(bytes);
    out.commit();
  }

  Key key_ = Key::trial();
  SweepEnd end_;

 private:
  test::TempFolder folder_;
  Ledger ledger_;
};

using News = std::map<std::string, std::string>;

TEST(Sweep, SaysExactlyWhatWasTouched) {
  Library library;
  EXPECT_EQ(library.news(), News());
  fs::remove(library.file(0));
  fs::create_directories(library.folder() / "out/sub");
  fs::rename(library.file(1), library.folder() / "out/sub/else.obj");
  library.append(2, "# a word\n");
  library.dent(3);
  std::ofstream(library.file(4)) << "f 1 2\n";
  fs::copy_file(library.folder() / "in/5.obj", library.file(5),
                fs::copy_options::overwrite_existing);
  const News found = library.news();
  EXPECT_EQ(found, (News{{"0.obj", "missing"},
                         {"1.obj", "moved"},
                         {"2.obj", "altered"},
                         {"3.obj", "mark damaged"},
                         {"4.obj", "damaged"},
                         {"5.obj", "mark lost"}}));
}

TEST(Sweep, TellsNewsFromWhatIsKnownAcceptedOrRestored) {
  Library library;
  const std::string before = test::read_all(library.file(2));
  library.append(2, "# a word\n");
  fs::rename(library.file(0), library.folder() / "out/away.obj");
  EXPECT_EQ(library.news(), (News{{"0.obj", "moved"}, {"2.obj", "altered"}}));
  EXPECT_EQ(library.news(), (News{{"0.obj", "moved still"}, {"2.obj", "altered still"}}));
  library.append(2, "# another\n");  // the same state, but other bytes
  EXPECT_EQ(library.news(), (News{{"0.obj", "moved still"}, {"2.obj", "altered"}}));

  SweepOptions accepting;
  accepting.accepts = true;
  EXPECT_EQ(library.news(accepting), News());
  EXPECT_EQ(library.news(), News());
  library.append(2, "# a third\n");
  EXPECT_EQ(library.news(), (News{{"2.obj", "altered"}}));

  std::ofstream(library.file(2)) << before;
  fs::rename(library.folder() / "out/away.obj", library.file(0));
  for (const SweptFile& file : library.sweep_again()) {
    const std::string name = fs::path(file.target).filename();
    EXPECT_EQ(file.change(), name == "2.obj" || name == "0.obj" ? "restored" : "unchanged") << name;
  }
  EXPECT_EQ(library.news(), News());
}

// Reading needs the record; what is known by its bytes does not.
TEST(Sweep, ReadsAMarkOnceAndThenKnowsItByItsBytes) {
  Library library;
  library.append(3, "# a word\n");
  EXPECT_EQ(library.news(), (News{{"3.obj", "altered"}}));
  std::string last;
  while (std::optional<LedgerItem> item = library.ledger().find_after(last)) {
    last = item->target;
    item->record = "{}";
    library.ledger().put(*item, std::nullopt);
  }
  EXPECT_EQ(library.news(), (News{{"3.obj", "altered still"}}));
  SweepOptions full;
  full.reads_all = true;
  EXPECT_EQ(library.news(full).size(), Library::kFiles);
}

TEST(Sweep, OfAFileMadeAnewStartsFromIt) {
  Library library;
  library.append(3, "# a word\n");
  EXPECT_EQ(library.news().size(), 1U);
  std::optional<LedgerItem> item = library.ledger().find(library.file(3).string());
  ASSERT_TRUE(item);
  item->output_hash = content_hash(test::read_all(library.file(3)));
  Record record = parse_record(item->record);
  record.file.output_hash = item->output_hash;
  item->record = to_json(record).dump();
  library.ledger().put(*item, std::nullopt);
  EXPECT_EQ(library.news(), News());
}

TEST(Sweep, GoesOnWhereItWasStopped) {
  Library library;
  library.append(1, "# a word\n");
  const std::int64_t run = library.begin();
  const std::size_t first = library.sweep_as(run, {}, 3).size();
  ASSERT_GE(first, 3U);
  ASSERT_LT(first, Library::kFiles);
  const std::vector<SweptFile> all = library.sweep_as(run);
  ASSERT_EQ(all.size(), Library::kFiles);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].is_kept, i < first);
    EXPECT_EQ(all[i].is_new, i == 1) << all[i].line;  // what the first part found is not forgotten
  }
}

TEST(Sweep, StartsNoFileAfterItsTime) {
  Library library;
  SweepOptions options;
  options.deadline = std::chrono::steady_clock::now();
  EXPECT_TRUE(library.sweep_again(options).empty());
  EXPECT_TRUE(library.end_.is_out_of_time);
  options.deadline = std::chrono::steady_clock::now() + std::chrono::hours(1);
  EXPECT_EQ(library.sweep_again(options).size(), Library::kFiles);
  EXPECT_FALSE(library.end_.is_out_of_time);
}

TEST(Sweep, WithoutTheKeyForgetsNothing) {
  Library library;
  library.append(4, "# a word\n");
  EXPECT_EQ(library.news().size(), 1U);
  library.key_ = Key::trial(7);
  for (const SweptFile& file : library.sweep_again()) EXPECT_EQ(file.state, FileState::WrongKey);
  library.key_ = Key::trial();
  EXPECT_EQ(library.news(), (News{{"4.obj", "altered"}}));
}

TEST(Sweep, FindsTheSameWithAnyThreads) {
  Library library;
  library.append(1, "# a word\n");
  fs::remove(library.file(2));
  std::set<std::string> found;
  for (const int threads : {1, 2, 3, 8}) {
    SweepOptions options;
    options.reads_all = true;
    std::string lines;
    with_threads(threads, [&] {
      for (const SweptFile& file : library.sweep_again(options)) {
        lines += std::string(name_of(file.state)) + " " + file.target + "\n";
      }
    });
    found.insert(lines);
  }
  EXPECT_EQ(found.size(), 1U);
}

// A ledger of outputs that are not there.
class Names {
 public:
  static constexpr std::size_t kCount = 2000;

  Names() : ledger_(folder_ / "l.ledger") {
    const std::int64_t run = ledger_.begin_run({.verb = "mark"});
    for (std::size_t i = 0; i < kCount; ++i) {
      LedgerItem item;
      item.target = folder_ / std::to_string(i % 10) / std::to_string(i).append(".obj");
      item.status = i == 0 ? "too small" : "marked";
      item.output_hash = "abcd";
      item.run = run;
      ledger_.put(item, std::nullopt);
    }
  }

  std::set<std::string> swept(const SweepSelection& selection) {
    std::set<std::string> names;
    const std::int64_t run = ledger_.begin_run({.verb = "sweep"});
    const std::atomic<bool> stop{false};
    SweepOptions options;
    options.selection = selection;
    sweep(
        ledger_, run, {}, options, {},
        [&](const SweptFile& file) { EXPECT_TRUE(names.insert(file.target).second); }, stop);
    return names;
  }
  [[nodiscard]] std::string name(const std::string& below) const { return folder_ / below; }

 private:
  test::TempFolder folder_;
  Ledger ledger_;
};

TEST(SweepSelection, PartsAreDisjointCompleteAndNearlyEqual) {
  Names names;
  std::set<std::string> all;
  for (std::uint32_t part = 1; part <= 7; ++part) {
    const std::set<std::string> some = names.swept({.part = {part, 7}});
    EXPECT_NEAR(static_cast<double>(some.size()), Names::kCount / 7., 75);  // five deviations
    EXPECT_EQ(some, names.swept({.part = {part, 7}}));
    for (const std::string& name : some) EXPECT_TRUE(all.insert(name).second);
  }
  EXPECT_EQ(all.size(), Names::kCount - 1);  // one was not marked
}

TEST(SweepSelection, SamplesDifferFromSweepToSweep) {
  Names names;
  const std::set<std::string> one = names.swept({.sample = 0.1});
  const std::set<std::string> other = names.swept({.sample = 0.1});
  EXPECT_NEAR(static_cast<double>(one.size()), 200, 70);  // five deviations
  EXPECT_NEAR(static_cast<double>(other.size()), 200, 70);
  EXPECT_NE(one, other);
}

TEST(SweepSelection, NamesAreFilesAndFoldersAndMustExist) {
  Names names;
  EXPECT_EQ(names.swept({.below = {names.name("3")}}).size(), Names::kCount / 10);
  EXPECT_EQ(names.swept({.below = {names.name("3/13.obj"), names.name("4/14.obj")}}).size(), 2U);
  EXPECT_THROW((void)names.swept({.below = {names.name("3/1")}}), Error);  // no part of a name
}

TEST(SweepSelection, OfWhatWasMarkedSince) {
  Names names;
  EXPECT_EQ(names.swept({.marked_since = "2020-01-01T00:00:00Z"}).size(), Names::kCount - 1);
  EXPECT_TRUE(names.swept({.marked_since = "2999-01-01T00:00:00Z"}).empty());
}

TEST(Sweep, IsUnfinishedUntilItsEndAndOnlyForTheSameCommand) {
  const test::TempFolder folder;
  Ledger ledger(folder / "l.ledger");
  EXPECT_FALSE(unfinished_sweep(ledger, "c", "/d"));
  const std::int64_t one = ledger.begin_run({.verb = "sweep", .command = "c", .directory = "/d"});
  EXPECT_EQ(unfinished_sweep(ledger, "c", "/d"), one);  // killed, or under way
  EXPECT_FALSE(unfinished_sweep(ledger, "other", "/d"));
  EXPECT_FALSE(unfinished_sweep(ledger, "c", "/elsewhere"));
  ledger.end_run(one, "interrupted");
  EXPECT_EQ(unfinished_sweep(ledger, "c", "/d"), one);
  ledger.end_run(one, kOutOfTime);
  EXPECT_EQ(unfinished_sweep(ledger, "c", "/d"), one);
  ledger.end_run(one, "changed");
  EXPECT_FALSE(unfinished_sweep(ledger, "c", "/d"));
  (void)ledger.begin_run({.verb = "mark", .command = "c", .directory = "/d"});
  EXPECT_FALSE(unfinished_sweep(ledger, "c", "/d"));
}

}  // namespace
}  // namespace triglyph
