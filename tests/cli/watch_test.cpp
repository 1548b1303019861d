// What a run shows while it lasts: traces, progress, metrics, answers to SIGUSR1; and profiles.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/cli_fixture.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

class CliWatch : public test::CliTest {
 protected:
  void make_samples(std::size_t count, std::size_t triangles = 1500) const {
    for (std::size_t i = 0; i < count; ++i) {
      make_sample("in/" + std::to_string(i) + ".obj", triangles, i);
    }
  }

  // Returns the spans of the trace by name and file.
  [[nodiscard]] std::map<std::string, std::multiset<std::string>> spans_of(
      const nlohmann::json& events) const {
    std::map<std::string, std::multiset<std::string>> spans;
    for (const auto& event : events) {
      if (event["ph"] == "X") spans[event["name"]].insert(event["args"]["file"].get<std::string>());
    }
    return spans;
  }

  [[nodiscard]] nlohmann::json trace() const {
    return nlohmann::json::parse(test::read_all(folder_ / "t.json"));
  }
};

TEST_F(CliWatch, TracesEveryVerbOfARun) {
  make_samples(4);
  const std::multiset<std::string> all = {"in/0.obj", "in/1.obj", "in/2.obj", "in/3.obj"};
  auto result = run("mark in --out out --message m --trace t.json --records r.jsonl --json");
  ASSERT_EQ(result.code, 0) << result.err;
  auto spans = spans_of(trace());
  for (const char* stage : {"plan", "load", "mark", "write", "read back", "measure", "ledger",
                            "publish", "records", "deliver", "file"}) {
    EXPECT_EQ(spans[stage], all) << stage;
  }
  const std::map<std::string, std::string> verbs = {{"extract in", "read"},
                                                    {"verify r.jsonl", "verify"},
                                                    {"measure in out", "pair"},
                                                    {"attack noise:0.1 in --out-dir a", "attack"}};
  for (const auto& [command, stage] : verbs) {
    const std::string words =
        stage == "attack" ? "attack in --out-dir a --attack noise:0.1" : command;
    result = run(words + " --trace t.json");
    EXPECT_LE(result.code, 4) << result.err;
    EXPECT_NE(result.code, 2) << result.err;
    EXPECT_EQ(spans_of(trace())[stage].size(), 4U) << command;
  }
  result = run("extract in --trace in/0.obj");  // what is no trace is not replaced
  EXPECT_EQ(result.code, 1);
  EXPECT_EQ(result.err.find("in/0.obj: is there already"), result.err.find("in/0.obj"));
}

TEST_F(CliWatch, TraceHoldsTheWorkersBeforeAndAfterACrash) {
  make_samples(6);
  const auto result = run("mark in --out out --message m --threads 1 --trace t.json --quiet",
                          "TRIGLYPH_FAULT='crash 3.obj'");
  EXPECT_EQ(result.code, 3);
  const auto events = trace();
  std::set<int> workers;
  std::string death;
  for (const auto& event : events) {
    if (event["ph"] == "X") workers.insert(event["pid"].get<int>());
    if (event["name"] == "worker died") death = event["args"]["detail"];
  }
  EXPECT_EQ(workers.size(), 2U);
  EXPECT_NE(death.find("signal 6"), std::string::npos) << death;
  EXPECT_NE(death.find("in/3.obj"), std::string::npos) << death;
  EXPECT_EQ(spans_of(events)["publish"].size(), 5U);
}

TEST_F(CliWatch, TraceOfAKilledRunHoldsWhatWasDone) {
  make_samples(4);
  const auto result =
      run("mark in --out out --message m --threads 1 --trace t.json --quiet & "
          "pid=$!; for i in $(seq 600); do [ -e out/1.obj ] && break; sleep 0.05; done; "
          "kill -9 $pid; wait $pid",
          "TRIGLYPH_FAULT='hang 2.obj'");
  std::string text = test::read_all(folder_ / "t.json");
  text.erase(text.find_last_of(','));  // as viewers do
  const auto events = nlohmann::json::parse(text + "]");
  const std::multiset<std::string> done = {"in/0.obj", "in/1.obj"};
  EXPECT_EQ(spans_of(events)["publish"], done);
  EXPECT_EQ(result.out, "");
}

TEST_F(CliWatch, SaysHowFarItIsWhenAsked) {
  make_samples(4);
  for (const char* target : {"$pid", "$(pgrep -P $pid)"}) {
    fs::remove_all(folder_ / "out");
    const auto result = run(
        "mark in --out out --message m --threads 1 --quiet --force & "
        "pid=$!; for i in $(seq 600); do [ -e out/1.obj ] && break; sleep 0.05; done; sleep 0.3; "
        "kill -USR1 " +
            std::string(target) + "; sleep 0.5; kill -TERM $pid; wait $pid",
        "TRIGLYPH_FAULT='hang 2.obj'");
    const std::regex line(
        "triglyph: mark: 2 of 4 files, [0-9.]+ of [0-9.]+ kB, [0-9.e+-]+ MB/s, [0-9]+ s left; "
        "2.obj [0-9.]+ s\n");
    EXPECT_TRUE(std::regex_search(result.err, line)) << result.err;
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(CliWatch, QuestionsDoNotDisturbARun) {
  make_samples(6);
  const auto result = run(
      "mark in --out out --message m --json > o.jsonl & pid=$!; sleep 0.1; "
      "for i in $(seq 100); do kill -USR1 $pid 2>/dev/null || break; sleep 0.01; done; wait $pid");
  EXPECT_EQ(result.code, 0) << result.err;
  std::istringstream lines(test::read_all(folder_ / "o.jsonl"));
  std::size_t records = 0;
  for (std::string line; std::getline(lines, line); ++records) {
    EXPECT_TRUE(nlohmann::json::accept(line)) << line;
  }
  EXPECT_EQ(records, 6U);
  const std::string sample = "sample --out s --count 300 --triangles 2000 & pid=$!; sleep 0.1; ";
  EXPECT_EQ(run(sample + "kill -USR1 $pid; wait $pid").code, 0);  // of no run: it means nothing
}

TEST_F(CliWatch, ProgressObjectsLeaveStandardOutputToRecords) {
  make_samples(3);
  const auto result = run("mark in --out out --message m --json --progress json");
  ASSERT_EQ(result.code, 0) << result.err;
  std::istringstream records(result.out);
  for (std::string line; std::getline(records, line);) {
    EXPECT_TRUE(nlohmann::json::parse(line).contains("status")) << line;
  }
  std::istringstream lines(result.err);
  nlohmann::json last;
  for (std::string line; std::getline(lines, line);) {
    if (line.front() == '{') last = nlohmann::json::parse(line);
  }
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "in")) bytes += entry.file_size();
  EXPECT_EQ(last["progress"], "mark");
  EXPECT_EQ(last["files_done"], 3);
  EXPECT_EQ(last["files_total"], 3);
  EXPECT_EQ(last["bytes_done"], bytes);
  EXPECT_EQ(last["bytes_total"], bytes);
  EXPECT_EQ(last["results"]["marked"], 3);
  EXPECT_EQ(last["exit_code"], 0);
  // what an earlier run left is done, but says nothing of the speed
  const auto again = run("mark in --out out --message m --json --quiet --progress json");
  const std::string end = again.err.substr(again.err.rfind("{\"progress\""));
  EXPECT_EQ(nlohmann::json::parse(end)["files_kept"], 3);
  EXPECT_EQ(nlohmann::json::parse(end)["bytes_per_second"], 0);
}

// The rules of OpenMetrics that our metrics are subject to.
void check_open_metrics(const std::string& text) {
  std::map<std::string, std::string> types;
  const std::regex sample("([a-z_]+)\\{verb=\"[a-z]+\"(,result=\"[a-z ]+\")?\\} ([0-9.e+-]+)");
  std::string family;
  std::istringstream lines(text);
  std::string line;
  std::set<std::string> samples;
  while (std::getline(lines, line) && line != "# EOF") {
    std::istringstream words(line);
    std::string hash;
    std::string kind;
    std::string name;
    words >> hash >> kind >> name;
    if (hash == "#") {
      std::string value;
      words >> value;
      if (kind == "TYPE") {
        EXPECT_TRUE(types.emplace(name, value).second) << name;
        family = name;
      }
      EXPECT_EQ(name, family);
      if (kind == "UNIT") {
        EXPECT_TRUE(name.ends_with("_" + value)) << line;
      }
      continue;
    }
    std::smatch parts;
    ASSERT_TRUE(std::regex_match(line, parts, sample)) << line;
    EXPECT_EQ(parts[1], family + (types[family] == "counter" ? "_total" : "")) << line;
    EXPECT_TRUE(samples.insert(parts[1].str() + parts[2].str()).second) << line;
  }
  EXPECT_EQ(line, "# EOF");
  EXPECT_FALSE(std::getline(lines, line));
}

TEST_F(CliWatch, MetricsAreOpenMetrics) {
  make_samples(3);
  folder_.write("in/bad.obj", "v 0 x 0\n");
  const auto result = run("mark in --out out --message m --quiet --metrics m.prom");
  EXPECT_EQ(result.code, 3);
  const std::string text = test::read_all(folder_ / "m.prom");
  check_open_metrics(text);
  for (const char* line :
       {"triglyph_files_total{verb=\"mark\",result=\"marked\"} 3\n",
        "triglyph_files_total{verb=\"mark\",result=\"malformed\"} 1\n",
        "triglyph_failed_files_total{verb=\"mark\"} 1\n", "triglyph_running{verb=\"mark\"} 0\n",
        "triglyph_exit_code{verb=\"mark\"} 3\n", "triglyph_planned_files{verb=\"mark\"} 4\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
  EXPECT_EQ(run("extract in --quiet --metrics in/0.obj").code, 1);  // that is no file of metrics
  // the parser of Prometheus, where it is installed
  const auto parsed = run(
      "--version; /usr/bin/python3 -c 'import prometheus_client.openmetrics.parser' || exit 0; "
      "/usr/bin/python3 -c 'from prometheus_client.openmetrics.parser import "
      "text_string_to_metric_families as parse; print(len(list(parse(open(\"m.prom\").read()))))'");
  EXPECT_EQ(parsed.code, 0) << parsed.err;
}

TEST_F(CliWatch, MetricsTellOfARunThatGoesOn) {
  make_samples(3);
  const auto result =
      run("mark in --out out --message m --threads 1 --quiet --metrics m.prom & "
          "pid=$!; for i in $(seq 600); do grep -q 'in_work.* 1$' m.prom 2>/dev/null && break; "
          "sleep 0.05; done; "
          "cp m.prom seen.prom; kill -TERM $pid; wait $pid",
          "TRIGLYPH_FAULT='hang 0.obj'");
  const std::string text = test::read_all(folder_ / "seen.prom");
  check_open_metrics(text);
  EXPECT_NE(text.find("triglyph_running{verb=\"mark\"} 1\n"), std::string::npos) << text;
  EXPECT_NE(test::read_all(folder_ / "m.prom").find("triglyph_exit_code{verb=\"mark\"} 130"),
            std::string::npos);
}

TEST_F(CliWatch, ProfileIsABenchmarkOfGoogle) {
  const auto result = run("profile --count 4 --triangles 300 --threads 2 --repetitions 2 --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  for (const char* key : {"date", "host_name", "num_cpus", "load_avg", "caches"}) {
    EXPECT_TRUE(json["context"].contains(key)) << key;
  }
  std::map<std::string, int> seen;
  for (const auto& benchmark : json["benchmarks"]) {
    ++seen[benchmark["name"]];
    EXPECT_EQ(benchmark["run_type"], "iteration");
    EXPECT_EQ(benchmark["repetitions"], 2);
    EXPECT_EQ(benchmark["time_unit"], "ms");
    EXPECT_GE(benchmark["real_time"], 0);
    EXPECT_GE(benchmark["cpu_time"], 0);
  }
  for (const char* name : {"mark/threads:1", "mark/threads:2", "mark/threads:2/stage:load",
                           "mark/threads:1/stage:ledger", "mark/threads:1/stage:idle and other"}) {
    EXPECT_EQ(seen[name], 2) << name;
  }
  const auto text = run("profile --count 4 --triangles 300 --threads 2 --repetitions 1");
  EXPECT_NE(text.out.find("efficiency"), std::string::npos) << text.out;
  EXPECT_EQ(run("profile --count 0").code, 2);
}

}  // namespace
}  // namespace triglyph
