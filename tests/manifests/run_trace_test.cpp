#include "manifests/run_trace.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/parallel.h"
#include "engine/io/export_mesh.h"
#include "engine/samples/sample_shapes.h"
#include "manifests/run.h"
#include "manifests/trace_summary.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// Marks `count` meshes with three threads, remembered in a ledger, and writes "trace.json".
void mark_traced(const test::TempFolder& folder, std::size_t count) {
  std::vector<NamedFile> meshes;
  for (std::size_t i = 0; i < count; ++i) {
    const fs::path path = folder / ("in/" + std::to_string(i) + ".obj");
    OutputFile file(path);
    file.write(export_mesh(make_sample_shape(SampleShape::Closed, 2000, i), {}));
    file.commit();
    meshes.push_back({path, folder / "in"});
  }
  RunTrace trace(folder / "trace.json");
  Ledger ledger(folder / "ledger");
  const Key key = Key::trial();
  const Resume resume(ledger, ledger.begin_run({}), key, {});
  RunContext context;
  context.resume = &resume;
  context.flow.trace = &trace;
  MeshList jobs(meshes, {{"message", "traced"}}, folder / "out");
  const std::atomic<bool> stop{false};
  with_threads(3, [&] { run_jobs(jobs, key, context, {.completed = [](const Record&) {}}, stop); });
  trace.finish();
}

std::vector<nlohmann::json> spans_of(const nlohmann::json& events) {
  std::vector<nlohmann::json> spans;
  for (const auto& event : events) {
    if (event["ph"] == "X") spans.push_back(event);
  }
  return spans;
}

TEST(RunTrace, HasEveryStageOfEveryMeshOnce) {
  const test::TempFolder folder;
  mark_traced(folder, 12);
  const auto events = nlohmann::json::parse(test::read_all(folder / "trace.json"));
  std::map<std::string, std::multiset<std::string>> stages;  // by file
  for (const auto& span : spans_of(events)) {
    stages[span["args"]["file"]].insert(span["name"].get<std::string>());
  }
  stages.erase("");  // of no file: the plan that is read on
  EXPECT_EQ(stages.size(), 12U);
  const std::multiset<std::string> once = {
      "deliver", "file",    "ledger",    "load",    "look up",         "mark", "measure",
      "plan",    "publish", "read back", "records", "wait to deliver", "write"};
  for (const auto& [file, seen] : stages) EXPECT_EQ(seen, once) << file;
}

// On a thread a span lies within another or apart from it.
TEST(RunTrace, NestsTheSpansOfAThread) {
  const test::TempFolder folder;
  mark_traced(folder, 8);
  const auto events = nlohmann::json::parse(test::read_all(folder / "trace.json"));
  std::map<int, std::vector<std::pair<double, double>>> threads;  // from and to
  std::set<int> named;
  for (const auto& event : events) {
    if (event["name"] == "thread_name") named.insert(event["tid"].get<int>());
  }
  for (const auto& span : spans_of(events)) {
    EXPECT_GE(span["ts"], 0);
    EXPECT_GE(span["dur"], 0);
    const double from = span["ts"];
    threads[span["tid"]].emplace_back(from, from + span["dur"].get<double>());
    EXPECT_TRUE(named.contains(span["tid"].get<int>()));
  }
  constexpr double kRounding = 0.002;  // microseconds
  for (auto& [thread, spans] : threads) {
    std::sort(spans.begin(), spans.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second > b.second;
    });
    std::vector<double> open;
    for (const auto& [from, to] : spans) {
      while (!open.empty() && open.back() <= from + kRounding) open.pop_back();
      if (!open.empty()) {
        EXPECT_LE(to, open.back() + kRounding);
      }
      open.push_back(to);
    }
  }
}

TEST(RunTrace, CountersReturnToZero) {
  const test::TempFolder folder;
  mark_traced(folder, 5);
  const auto events = nlohmann::json::parse(test::read_all(folder / "trace.json"));
  std::map<std::string, nlohmann::json> last;
  std::map<std::string, double> time;
  double most = 0;
  double memory = 0;
  for (const auto& event : events) {
    if (event["ph"] != "C") continue;
    const std::string name = event["name"];
    if (name == "bytes in flight") most = std::max(most, event["args"]["bytes"].get<double>());
    if (name == "resident memory") memory = event["args"]["bytes"];
    if (event["ts"].get<double>() < time[name]) continue;
    time[name] = event["ts"];
    last[name] = event["args"];
  }
  EXPECT_GT(most, 1e6);
  EXPECT_GT(memory, 1e6);
  EXPECT_EQ(last["bytes in flight"]["bytes"], 0);
  EXPECT_EQ(last["items"]["waiting for memory"], 0);
  EXPECT_EQ(last["items"]["waiting for a thread"], 0);
  EXPECT_EQ(last["items"]["in work"], 0);
  EXPECT_EQ(last["items undelivered"]["items"], 0);
}

TEST(RunTrace, IsReadWithoutItsEnd) {
  const test::TempFolder folder;
  mark_traced(folder, 3);
  const std::string text = test::read_all(folder / "trace.json");
  const auto whole = summarise_trace(folder / "trace.json");
  EXPECT_EQ(whole.at("mark").count, 3U);
  EXPECT_GT(whole.at("file").seconds, whole.at("mark").seconds);
  // in the middle of the second span of that name
  const std::size_t first = text.find(R"("name":"mark")");
  const std::size_t torn = text.find(R"("name":"mark")", first + 1) + 20;
  EXPECT_EQ(summarise_trace(folder.write("torn.json", text.substr(0, torn))).at("mark").count, 1U);
  folder.write("bad.json", "[\nno event,\n{},\n");
  EXPECT_THROW((void)summarise_trace(folder / "bad.json"), Error);
  EXPECT_THROW((void)summarise_trace(folder / "absent.json"), Error);
}

TEST(RunTrace, ReplacesATraceAndNothingElse) {
  const test::TempFolder folder;
  folder.write("mesh.obj", "v 0 0 0\n");
  EXPECT_THROW(RunTrace(folder / "mesh.obj"), Error);
  EXPECT_EQ(test::read_all(folder / "mesh.obj"), "v 0 0 0\n");
  for (int time = 0; time < 2; ++time) RunTrace(folder / "trace.json").finish();
  EXPECT_EQ(nlohmann::json::parse(test::read_all(folder / "trace.json")).size(), 2U);
}

TEST(RunTrace, SaysInTheEndThatTheDiskIsFull) {
  RunTrace trace("/dev/full");
  trace.instant("still", "running");
  EXPECT_THROW(trace.finish(), Error);
}

TEST(RunTrace, KeepsNamesThatAreNotUtf8Readable) {
  const test::TempFolder folder;
  RunTrace trace(folder / "trace.json");
  { const TraceSpan span(&trace, "load", "a\"\\\xff\n.obj"); }
  trace.finish();
  const auto events = nlohmann::json::parse(test::read_all(folder / "trace.json"));
  EXPECT_EQ(events[2]["args"]["file"].get<std::string>(), "a\"\\\xef\xbf\xbd\n.obj");
}

}  // namespace
}  // namespace triglyph
