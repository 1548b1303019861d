// What came of tracing, on the screen, as JSON, and as a file of evidence.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include <nlohmann/json.hpp>

#include "manifests/file_runs.h"
#include "manifests/ledger.h"

namespace triglyph {

// What a trace looked for. All must outlive the report.
struct TraceSubject {
  std::size_t names = 0;  // under all keys
  std::size_t most = 5;   // names to tell of a file
  std::span<const Key> keys;
  const Ledger* ledger = nullptr;  // null: nothing is known of the copies
  TraceOptions options = {};
};

class TraceReport {
 public:
  explicit TraceReport(const TraceSubject& subject) : subject_(subject) {}

  // Says whether somebody is named: by a fingerprint, or as the reader of a message.
  [[nodiscard]] bool names_one(const TraceResult& result) const;

  // Returns "traced", "nobody", or why the file has no result.
  [[nodiscard]] std::string_view status_of(const TraceResult& result) const;

  [[nodiscard]] nlohmann::ordered_json json_of(const TraceResult& result) const;

  // Prints the result, and an error on standard error.
  void print(const TraceResult& result, bool json) const;

  // Writes the evidence for who is named, in Markdown. Throws Error Unwritable, and Unreadable if
  // the file that was traced has gone.
  void write(const TraceResult& result, const std::filesystem::path& file) const;

  // Returns the mesh, if it is there, of which the ledger issued the first named a copy.
  [[nodiscard]] std::optional<std::filesystem::path> original_of(const TraceResult& result) const;

 private:
  [[nodiscard]] std::span<const Traced> shown_names(const TraceResult& result) const;
  [[nodiscard]] nlohmann::ordered_json json_of(const Traced& traced) const;
  void print_text(const TraceResult& result) const;
  void print_marks(const Message& name) const;
  void write_name(const Traced& traced, std::string_view hash, std::string& text) const;
  void for_each_mark(const Message& name,
                     const std::function<void(const LedgerMark&)>& visit) const;

  TraceSubject subject_;
};

}  // namespace triglyph
