#include "cli/profile_report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <ostream>
#include <set>
#include <thread>

#include <unistd.h>

namespace triglyph {
namespace {

// What encloses other spans, and is no stage.
constexpr const char* kWholeFile = "file";

template <typename... Values>
std::string text_line(const char* pattern, Values... values) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

template <typename Value>
double median_of(const std::vector<ProfileRun>& runs, int threads, const Value& value) {
  std::vector<double> values;
  for (const ProfileRun& run : runs) {
    if (run.threads == threads) values.push_back(value(run));
  }
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

double stage_seconds(const ProfileRun& run, const std::string& stage) {
  const auto found = run.stages.find(stage);
  return found == run.stages.end() ? 0 : found->second.seconds;
}

// The threads' time that no stage accounts for: they have nothing to do, or do what has no name.
double other_seconds(const ProfileRun& run) {
  double known = 0;
  for (const auto& [stage, total] : run.stages) {
    if (stage != kWholeFile) known += total.seconds;
  }
  return std::max(0.0, run.threads * run.wall_seconds - known);
}

std::set<int> thread_counts(const std::vector<ProfileRun>& runs) {
  std::set<int> counts;
  for (const ProfileRun& run : runs) counts.insert(run.threads);
  return counts;
}

// The stages, the one that takes longest first.
std::vector<std::string> stages_of(const std::vector<ProfileRun>& runs) {
  std::map<std::string, double> seconds;
  for (const ProfileRun& run : runs) {
    for (const auto& [stage, total] : run.stages) seconds[stage] += total.seconds;
  }
  seconds.erase(kWholeFile);
  std::vector<std::string> stages;
  for (const auto& [stage, total] : seconds) stages.push_back(stage);
  std::stable_sort(stages.begin(), stages.end(), [&](const std::string& a, const std::string& b) {
    return seconds[a] > seconds[b];
  });
  return stages;
}

void print_rates(std::ostream& out, const ProfileWorkload& workload,
                 const std::vector<ProfileRun>& runs) {
  out << "threads     wall  processor       MB/s  triangles/s  efficiency\n";
  const auto wall = [](const ProfileRun& run) { return run.wall_seconds; };
  for (const int threads : thread_counts(runs)) {
    const double seconds = median_of(runs, threads, wall);
    const double processor =
        median_of(runs, threads, [](const ProfileRun& run) { return run.processor_seconds; });
    out << text_line("%7d %7.2fs %9.2fs %10.2f %12.0f %10.1f%%\n", threads, seconds, processor,
                     static_cast<double>(workload.bytes) / 1e6 / seconds,
                     static_cast<double>(workload.triangles) / seconds,
                     100 * median_of(runs, 1, wall) / seconds / threads);
  }
}

nlohmann::ordered_json benchmark_context() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 64> date{};
  std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S%z", &local);
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  std::array<double, 3> load{};
  const int known = getloadavg(load.data(), static_cast<int>(load.size()));
  nlohmann::ordered_json loads = nlohmann::ordered_json::array();
  for (int i = 0; i < known; ++i) loads.push_back(load.at(static_cast<std::size_t>(i)));
  return {{"date", date.data()},
          {"host_name", host.data()},
          {"executable", "triglyph profile"},
          {"triglyph_version", TRIGLYPH_VERSION},
          {"num_cpus", std::max(1U, std::thread::hardware_concurrency())},
          {"caches", nlohmann::ordered_json::array()},
          {"load_avg", loads}};
}

}  // namespace

void print_profile(std::ostream& out, const ProfileWorkload& workload,
                   const std::vector<ProfileRun>& runs) {
  out << workload.meshes << " meshes, " << workload.triangles << " triangles, "
      << text_line("%.1f MB\n", static_cast<double>(workload.bytes) / 1e6);
  print_rates(out, workload, runs);
  const std::set<int> counts = thread_counts(runs);
  out << "\nseconds of all threads together\n" << text_line("%-16s", "stage");
  for (const int threads : counts) out << text_line("  %7d threads", threads);
  out << "\n";
  const auto print_row = [&](const std::string& name, const auto& seconds) {
    out << text_line("%-16s", name.c_str());
    for (const int threads : counts) {
      const double all =
          threads * median_of(runs, threads, [](const auto& run) { return run.wall_seconds; });
      const double part = median_of(runs, threads, seconds);
      out << text_line(" %8.3f %5.1f%%", part, 100 * part / all);
    }
    out << "\n";
  };
  for (const std::string& stage : stages_of(runs)) {
    print_row(stage, [&](const ProfileRun& run) { return stage_seconds(run, stage); });
  }
  print_row("idle and other", other_seconds);
}

nlohmann::ordered_json profile_json(const ProfileWorkload& workload,
                                    const std::vector<ProfileRun>& runs) {
  nlohmann::ordered_json benchmarks = nlohmann::ordered_json::array();
  std::map<std::string, int> seen;
  const auto add = [&](const std::string& name, const ProfileRun& run, double wall,
                       double processor) {
    const auto repetitions = std::count_if(runs.begin(), runs.end(), [&](const ProfileRun& other) {
      return other.threads == run.threads;
    });
    benchmarks.push_back({{"name", name},
                          {"run_name", name},
                          {"run_type", "iteration"},
                          {"repetitions", repetitions},
                          {"repetition_index", seen[name]++},
                          {"threads", run.threads},
                          {"iterations", 1},
                          {"real_time", 1000 * wall},
                          {"cpu_time", 1000 * processor},
                          {"time_unit", "ms"}});
  };
  for (const ProfileRun& run : runs) {
    const std::string name = "mark/threads:" + std::to_string(run.threads);
    add(name, run, run.wall_seconds, run.processor_seconds);
    benchmarks.back()["bytes_per_second"] = static_cast<double>(workload.bytes) / run.wall_seconds;
    benchmarks.back()["items_per_second"] =
        static_cast<double>(workload.triangles) / run.wall_seconds;
    for (const std::string& stage : stages_of(runs)) {
      const double seconds = stage_seconds(run, stage);
      add(name + "/stage:" + stage, run, seconds, seconds);
    }
    add(name + "/stage:idle and other", run, other_seconds(run), other_seconds(run));
  }
  return {{"context", benchmark_context()}, {"benchmarks", benchmarks}};
}

}  // namespace triglyph
