#include "manifests/shard.h"

#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/io/export_mesh.h"
#include "engine/samples/sample_shapes.h"
#include "manifests/json_line.h"
#include "manifests/merge.h"
#include "manifests/records_file.h"
#include "manifests/run.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

TEST(Shard, IsAPartOfSoMany) {
  const Shard shard = Shard::parsed("3/7", "--shard");
  EXPECT_EQ(shard.number, 3U);
  EXPECT_EQ(shard.count, 7U);
  EXPECT_EQ(shard.text(), "3/7");
  for (const char* wrong : {"", "3", "0/7", "8/7", "3/7x", "-1/7", " 3/7", "3/0", "a/b", "3/7/9"}) {
    EXPECT_THROW((void)Shard::parsed(wrong, "--shard"), Error) << wrong;
  }
  EXPECT_EQ(name_for(shard, "a/run.jsonl"), "a/run.shard-3-of-7.jsonl");
  EXPECT_EQ(name_for(Shard(), "a/run.jsonl"), "a/run.jsonl");
}

// Jobs for files of these sizes; each name comes as often in a row as it has copies.
class SizedJobs final : public JobSource {
 public:
  SizedJobs(const fs::path& folder, std::size_t count) : folder_(folder), count_(count) {}
  [[nodiscard]] std::optional<Job> next() override {
    if (next_ == count_) return std::nullopt;
    Job job;
    job.index = job.place = next_++;
    job.mesh = folder_ / std::to_string(job.place / 2);  // two copies of each
    job.out = folder_ / ("out" + std::to_string(job.place));
    return job;
  }

 private:
  fs::path folder_;
  std::size_t count_;
  std::size_t next_ = 0;
};

TEST(Shard, SharesAreDisjointWholeBalancedAndKeepCopiesTogether) {
  const test::TempFolder folder;
  constexpr std::size_t kJobs = 400;
  std::map<fs::path, std::uint64_t> sizes;
  std::uint64_t heaviest = 0;
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < kJobs / 2; ++i) {
    const std::uint64_t size = random_bits(1, 2, i) % (i % 10 == 0 ? 900'000 : 60'000);
    sizes[folder.write(std::to_string(i), std::string(size, ' '))] = size;
    heaviest = std::max(heaviest, 2 * size);
    all += 2 * size;
  }
  SizedJobs jobs(folder.path(), kJobs);
  const ShardPlan plan = plan_shards(jobs);
  EXPECT_EQ(plan.jobs, kJobs);
  for (const std::uint32_t count : {1U, 3U, 7U, 1000U}) {
    std::set<std::size_t> places;
    std::map<fs::path, std::uint32_t> shard_of;
    for (std::uint32_t number = 1; number <= count; ++number) {
      ShardSource shard(std::make_unique<SizedJobs>(folder.path(), kJobs), {number, count}, plan);
      std::uint64_t bytes = 0;
      std::size_t index = 0;
      while (const std::optional<Job> job = shard.next()) {
        EXPECT_EQ(job->index, index++);
        EXPECT_TRUE(places.insert(job->place).second);
        EXPECT_EQ(shard_of.try_emplace(job->mesh, number).first->second, number);
        bytes += sizes.at(job->mesh);
      }
      EXPECT_LE(static_cast<double>(bytes),
                1.2 * static_cast<double>(all) / count + static_cast<double>(heaviest));
    }
    EXPECT_EQ(places.size(), kJobs);
  }
}

// A collection with files that cannot be marked, marked whole and in shards.
class ShardedRun : public testing::Test {
 protected:
  ShardedRun() {
    for (std::size_t i = 0; i < kMeshes; ++i) {
      const std::vector<char> bytes =
          export_mesh(make_sample_shape(SampleShape::Closed, 100 + 50 * (i % 7) * (i % 7), i), {});
      folder_.write("in/" + std::to_string(i) + ".obj", std::string(bytes.begin(), bytes.end()));
    }
    folder_.write("in/x.obj", "this is no mesh\n");
    folder_.write("list.txt", "Ada\nBen\n");
    manifest_ =
        folder_.write("m.jsonl",
                      "{\"triglyph\":1,\"defaults\":{\"message\":\"ab\",\"scheme\":\"tsq\"}}\n"
                      "{\"mesh\":\"in/1.obj\",\"out\":\"to/"
                      "1.obj\",\"message\":\"abc\"}\n{\"mesh\":\"in/*.obj\",\"out\":\"to/\"}\n");
  }

  // Returns the exit of a run of one shard; what it enters goes to its own ledger and records.
  void mark(const Shard& shard, const std::string& to, std::size_t most = ~std::size_t{0}) const {
    const auto open = [&] {
      return std::make_unique<CopiesSource>(
          std::make_unique<ManifestReader>(manifest_, OptionValues(), folder_ / "out"), nullptr,
          folder_ / "out");
    };
    const ShardPlan plan = plan_shards(*open());
    ShardSource source(open(), shard, plan);
    Ledger ledger(name_for(shard, folder_ / (to + ".ledger")));
    const std::int64_t run = ledger.begin_run({.verb = "mark", .command = shard.text()});
    const Resume resume(ledger, run, Key::trial(), {});
    RecordsFile records(name_for(shard, folder_ / (to + ".jsonl")), false);
    RunContext context;
    context.resume = &resume;
    context.shard = shard;
    context.jobs_of_all = plan.jobs;
    std::atomic<bool> stop{false};
    std::size_t count = 0;
    run_jobs(source, Key::trial(), context,
             {.completed =
                  [&](const Record& record) {
                    records.write(record);
                    if (++count == most) stop = true;
                  }},
             stop);
    records.finish();
    ledger.end_run(run, "done");
  }

  [[nodiscard]] std::vector<fs::path> names(std::uint32_t count, const std::string& file) const {
    std::vector<fs::path> paths;
    for (std::uint32_t i = 1; i <= count; ++i)
      paths.push_back(name_for({i, count}, folder_ / file));
    return paths;
  }

  // Returns what the records say, without what differs from run to run.
  [[nodiscard]] static std::string told(const fs::path& records) {
    std::string text;
    std::ifstream stream(records);
    for (std::string line; std::getline(stream, line);) {
      nlohmann::ordered_json json = parse_json_line(line);
      json["place"] = json["run"]["place"];
      json.erase("run");
      text += to_line(json);
    }
    return text;
  }

  [[nodiscard]] static std::string told(const Ledger& ledger) {
    std::string text;
    std::string last;
    while (const std::optional<LedgerItem> item = ledger.find_after(last)) {
      last = item->target;
      nlohmann::ordered_json record = parse_json_line(item->record);
      record.erase("run");
      text += item->target + " " + item->status + " " + item->output_hash + " " +
              std::to_string(item->place) + to_line(record);
    }
    std::set<std::string> marks;
    ledger.for_each_mark([&](const LedgerMark& mark) {
      marks.insert(mark.out + mark.message_hex + mark.options + mark.output_hash);
    });
    for (const std::string& mark : marks) text += mark;
    return text;
  }

  static constexpr std::size_t kMeshes = 16;
  test::TempFolder folder_;
  fs::path manifest_;
};

TEST_F(ShardedRun, MergedIsTheWholeRun) {
  mark({1, 1}, "whole");
  const std::string records = told(folder_ / "whole.jsonl");
  const std::string ledger = told(Ledger(folder_ / "whole.ledger"));
  EXPECT_NE(records.find("malformed"), std::string::npos);
  EXPECT_NE(records.find("too small"), std::string::npos);
  for (const std::uint32_t count : {3U, 7U}) {
    fs::remove_all(folder_ / "to");
    const std::string name = "s" + std::to_string(count);
    for (std::uint32_t i = count; i > 0; --i) mark({i, count}, name);
    const MergedRecords merged =
        merge_records(names(count, name + ".jsonl"), folder_ / "m.jsonl.new");
    EXPECT_TRUE(merged.gaps.empty());
    EXPECT_EQ(merged.records, merged.jobs);
    EXPECT_EQ(told(folder_ / "m.jsonl.new"), records);
    Ledger out(folder_ / (name + ".ledger"));
    for (int again = 0; again < 2; ++again) {  // the second changes nothing
      merge_ledgers(names(count, name + ".ledger"), out);
      EXPECT_EQ(told(out), ledger);
      std::size_t runs = 0;
      out.for_each_run([&](const LedgerRun& run) { runs += run.outcome == "done" ? 1 : 0; });
      EXPECT_EQ(runs, count);
      std::vector<std::string> marked;
      out.for_each_mark([&](const LedgerMark& mark) { marked.push_back(mark.out); });
      std::vector<std::uint64_t> places;  // of the marks, in the order of their numbers
      for (const std::string& name_of_mark : marked) {
        places.push_back(out.find(name_of_mark)->place);
      }
      EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
    }
  }
}

TEST_F(ShardedRun, AShardThatRanTwiceOrInPartIsMergedOnce) {
  mark({1, 1}, "whole");
  const std::string records = told(folder_ / "whole.jsonl");
  const std::string ledger = told(Ledger(folder_ / "whole.ledger"));
  fs::remove_all(folder_ / "to");
  mark({1, 2}, "first", 2);  // killed on the way
  mark({1, 2}, "s");
  mark({2, 2}, "s");
  std::vector<fs::path> files = names(2, "s.jsonl");
  files.push_back(name_for({1, 2}, folder_ / "first.jsonl"));
  const MergedRecords merged = merge_records(files, folder_ / "out.jsonl");
  EXPECT_TRUE(merged.gaps.empty());
  EXPECT_EQ(told(folder_ / "out.jsonl"), records);
  std::vector<fs::path> ledgers = names(2, "s.ledger");
  ledgers.insert(ledgers.begin(), name_for({1, 2}, folder_ / "first.ledger"));
  Ledger out(folder_ / "out.ledger");
  merge_ledgers(ledgers, out);
  EXPECT_EQ(told(out), ledger);
}

TEST_F(ShardedRun, SaysWhatIsMissingAndWhatContradicts) {
  for (std::uint32_t i = 1; i <= 3; ++i) mark({i, 3}, "s");
  std::vector<fs::path> two = names(3, "s.jsonl");
  two.erase(two.begin() + 1);
  const MergedRecords merged = merge_records(two, folder_ / "out.jsonl");
  ASSERT_EQ(merged.gaps.size(), 1U);
  EXPECT_EQ(merged.records + merged.gaps[0].last - merged.gaps[0].first + 1, merged.jobs);
  const MergedRecords last =
      merge_records(std::vector{names(3, "s.jsonl")[0]}, folder_ / "out.jsonl");
  ASSERT_EQ(last.gaps.size(), 1U);
  EXPECT_EQ(last.gaps[0].last, last.jobs - 1);

  // a file of another run
  std::string text = test::read_all(two[0]);
  const std::size_t at = text.find("\"output_hash\":\"") + 15;
  text[at] = text[at] == '0' ? '1' : '0';
  const fs::path other = folder_.write("other.jsonl", text);
  EXPECT_THROW((void)merge_records(std::vector{two[0], other}, folder_ / "out.jsonl"), Error);
  const fs::path precious = folder_.write("precious.jsonl", "{\"a\":1}\n");
  EXPECT_THROW((void)merge_records(two, precious), Error);
  EXPECT_EQ(test::read_all(precious), "{\"a\":1}\n");

  const fs::path path = names(3, "s.ledger")[0];
  Ledger out(folder_ / "out.ledger");
  merge_ledgers(std::vector{path}, out);
  std::optional<LedgerItem> item;
  for (std::string name; (item = out.find_after(name));) {
    name = item->target;
    if (!item->output_hash.empty()) break;
  }
  ASSERT_TRUE(item);
  item->output_hash = "other";
  out.put(*item, std::nullopt);
  const std::string before = told(out);
  EXPECT_THROW(merge_ledgers(std::vector{names(3, "s.ledger")[1], path}, out), Error);
  EXPECT_EQ(told(out), before);  // all or nothing
}

// What the ledger of the whole knows is not done again.
TEST_F(ShardedRun, KeepsWhatTheLedgerOfTheWholeKnows) {
  mark({1, 1}, "whole");
  const Ledger base(folder_ / "whole.ledger");
  Ledger ledger(folder_ / "s.ledger");
  const Resume resume(ledger, ledger.begin_run({.verb = "mark"}), Key::trial(), {}, &base);
  RunContext context;
  context.resume = &resume;
  context.shard = {1, 2};
  CopiesSource source(std::make_unique<ManifestReader>(manifest_, OptionValues(), folder_ / "out"),
                      nullptr, folder_ / "out");
  const std::atomic<bool> stop{false};
  std::size_t kept = 0;
  run_jobs(source, Key::trial(), context,
           {.delivered = [&](const Record& record) { kept += record.is_kept ? 1 : 0; }}, stop);
  EXPECT_EQ(kept, kMeshes + 1);
  std::size_t known = 0;
  for (std::string name; const std::optional<LedgerItem> item = ledger.find_after(name);) {
    name = item->target;
    ++known;
  }
  EXPECT_EQ(known, kMeshes + 1);
}

}  // namespace
}  // namespace triglyph
