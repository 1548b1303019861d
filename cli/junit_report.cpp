#include "cli/junit_report.h"

#include <cstdint>

#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "manifests/json_line.h"
#include "manifests/sweep.h"

namespace triglyph {
namespace {

enum class TestOutcome : std::uint8_t { Passed, Failed, Error };

TestOutcome outcome_of(const LedgerState& state) {
  const bool is_good = state.state == name_of(FileState::Intact) && state.change == "unchanged";
  if (is_good || state.is_accepted) return TestOutcome::Passed;
  return state.state == name_of(FileState::Unreadable) ? TestOutcome::Error : TestOutcome::Failed;
}

std::string test_case(const LedgerState& state) {
  const std::filesystem::path file = state.target;
  std::string text = "    <testcase classname=\"";
  text.append(xml_text(file.parent_path().string())).append("\" name=\"");
  text.append(xml_text(file.filename().string())).append("\"");
  const TestOutcome outcome = outcome_of(state);
  if (outcome == TestOutcome::Passed) return text.append("/>\n");
  const nlohmann::ordered_json json = parse_json_line(state.line);
  const char* element = outcome == TestOutcome::Error ? "error" : "failure";
  const std::string& type = state.change == "unchanged" ? state.state : state.change;
  text.append(">\n      <").append(element).append(" type=\"").append(xml_text(type));
  text.append("\" message=\"").append(xml_text(type)).append(", was ");
  text.append(xml_text(json.value("before", ""))).append("\">");
  text.append(xml_text(json.value("detail", ""))).append("</").append(element);
  return text.append(">\n    </testcase>\n");
}

}  // namespace

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : printable(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&apos;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

void write_junit_report(const Ledger& ledger, std::int64_t run, const std::filesystem::path& path) {
  std::uint64_t tests = 0;
  std::uint64_t failures = 0;
  std::uint64_t errors = 0;
  ledger.for_each_state(run, [&](const LedgerState& state) {
    const TestOutcome outcome = outcome_of(state);
    ++tests;
    failures += outcome == TestOutcome::Failed ? 1 : 0;
    errors += outcome == TestOutcome::Error ? 1 : 0;
  });
  std::string started;
  ledger.for_each_run([&](const LedgerRun& one) {
    if (one.id == run) started = one.started;
  });
  std::string counts = " tests=\"" + std::to_string(tests);
  counts.append("\" failures=\"").append(std::to_string(failures));
  counts.append("\" errors=\"").append(std::to_string(errors)).append("\"");
  if (!started.empty()) started.pop_back();  // the schema's time has no zone; it is UTC
  OutputFile file(path);
  const auto write = [&](const std::string& text) { file.write(text); };
  write("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"triglyph\"" + counts +
        ">\n  <testsuite name=\"sweep\"" + counts + " skipped=\"0\" timestamp=\"" + started +
        "\">\n");
  ledger.for_each_state(run, [&](const LedgerState& state) { write(test_case(state)); });
  write("  </testsuite>\n</testsuites>\n");
  file.commit();
}

}  // namespace triglyph
