#include "cli/metrics_text.h"

#include <array>
#include <cstdio>

namespace triglyph {
namespace {

// Collects metrics of one verb.
class MetricsText {
 public:
  explicit MetricsText(std::string_view verb) : label_("verb=\"" + std::string(verb) + "\"") {}

  // Begins a metric; the unit, if it has one, is the end of its name.
  void family(const std::string& name, const std::string& type, const std::string& unit,
              const std::string& help) {
    name_ = "triglyph_" + name;
    sample_ = name_ + (type == "counter" ? "_total" : "");
    text_ += "# TYPE " + name_ + " " + type + "\n";
    if (!unit.empty()) text_ += "# UNIT " + name_ + " " + unit + "\n";
    text_ += "# HELP " + name_ + " " + help + "\n";
  }

  void sample(double value, const std::string& more_labels = "") {
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), "%.15g", value);
    text_ += sample_ + "{" + label_ + more_labels + "} " + number.data() + "\n";
  }

  [[nodiscard]] std::string finish() const { return text_ + "# EOF\n"; }

 private:
  std::string label_;
  std::string name_;
  std::string sample_;
  std::string text_;
};

void add_files(MetricsText& text, const RunName& name, const RunMetrics& metrics) {
  const Progress& progress = metrics.progress;
  text.family("files", "counter", "", "Files that are done, by what came of them.");
  for (std::size_t kind = 0; kind < name.kinds.size(); ++kind) {
    text.sample(static_cast<double>(metrics.results[kind]),
                ",result=\"" + std::string(name.kinds[kind]) + "\"");
  }
  text.family("failed_files", "counter", "", "Files that are done and failed.");
  text.sample(static_cast<double>(progress.failed));
  text.family("kept_files", "counter", "", "Files that an earlier run had done already.");
  text.sample(static_cast<double>(progress.kept));
  if (progress.files_total > 0) {
    text.family("planned_files", "gauge", "", "Files of the run.");
    text.sample(static_cast<double>(progress.files_total));
  }
  text.family("files_in_work", "gauge", "", "Files that are in work now.");
  text.sample(static_cast<double>(progress.in_work.size()));
}

void add_bytes(MetricsText& text, const RunMetrics& metrics) {
  const Progress& progress = metrics.progress;
  text.family("input_bytes", "counter", "bytes", "Size of the files that are done.");
  text.sample(static_cast<double>(progress.bytes_done));
  if (progress.bytes_total > 0) {
    text.family("planned_input_bytes", "gauge", "bytes", "Size of all files of the run.");
    text.sample(static_cast<double>(progress.bytes_total));
  }
  text.family("resident_memory_bytes", "gauge", "bytes", "Resident memory of the worker.");
  text.sample(static_cast<double>(metrics.resident_bytes));
}

void add_times(MetricsText& text, const RunMetrics& metrics) {
  const Progress& progress = metrics.progress;
  text.family("run_seconds", "gauge", "seconds", "How long the run has taken.");
  text.sample(progress.seconds);
  if (const auto left = progress.seconds_left()) {
    text.family("left_seconds", "gauge", "seconds", "How long it will still take, by bytes.");
    text.sample(*left);
  }
  text.family("slowest_file_seconds", "gauge", "seconds",
              "How long the slowest file in work takes.");
  text.sample(progress.in_work.empty() ? 0 : progress.in_work.front().seconds);
}

}  // namespace

std::string metrics_text(const RunName& name, const RunMetrics& metrics) {
  MetricsText text(name.verb);
  add_files(text, name, metrics);
  add_bytes(text, metrics);
  add_times(text, metrics);
  text.family("workers", "counter", "",
              "Processes started; more than one where a file killed one.");
  text.sample(static_cast<double>(metrics.workers));
  text.family("running", "gauge", "", "1 while the run goes on, then 0.");
  text.sample(metrics.exit_code ? 0 : 1);
  if (metrics.exit_code) {
    text.family("exit_code", "gauge", "", "The exit code of the run that is over.");
    text.sample(*metrics.exit_code);
  }
  return text.finish();
}

}  // namespace triglyph
