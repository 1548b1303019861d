#include "cli/progress.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

#include "engine/base/text.h"

namespace triglyph {
namespace {

template <typename... Values>
std::string words(const char* pattern, Values... values) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

struct ByteUnit {
  double bytes;
  const char* name;
};

ByteUnit unit_for(double bytes) {
  if (bytes >= 1e9) return {1e9, "GB"};
  if (bytes >= 1e6) return {1e6, "MB"};
  return {1e3, "kB"};
}

std::string time_text(double seconds) {
  if (seconds < 120) return words("%.0f s", seconds);
  if (seconds < 7200) return words("%.0f min", seconds / 60);
  return words("%.1f h", seconds / 3600);
}

std::string bytes_text(const Progress& progress) {
  const auto done = static_cast<double>(progress.bytes_done);
  const auto total = static_cast<double>(progress.bytes_total);
  const ByteUnit unit = unit_for(std::max(done, total));
  if (total == 0) return words("%.1f %s", done / unit.bytes, unit.name);
  return words("%.1f of %.1f %s", done / unit.bytes, total / unit.bytes, unit.name);
}

nlohmann::ordered_json or_null(std::uint64_t value) {
  return value == 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
}

}  // namespace

double Progress::bytes_a_second() const {
  return seconds > 0 ? static_cast<double>(bytes_done - bytes_kept) / seconds : 0;
}

std::optional<double> Progress::share() const {
  const auto part = [](std::uint64_t done, std::uint64_t total) {
    return std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  };
  if (bytes_total > 0) return part(bytes_done, bytes_total);
  if (files_total > 0) return part(files_done, files_total);
  return std::nullopt;
}

std::optional<double> Progress::seconds_left() const {
  const double rate = bytes_a_second();
  if (bytes_total == 0 || rate <= 0) return std::nullopt;
  return static_cast<double>(bytes_total - std::min(bytes_done, bytes_total)) / rate;
}

Progress progress_of(const RunBoard& board) {
  Progress progress;
  // what is counted last is read first, so that no part is larger than its whole
  progress.failed = board.counters[kFailed];
  progress.kept = board.counters[kKept];
  progress.bytes_kept = board.counters[kKeptBytes];
  progress.bytes_done = board.counters[kBytes];
  for (std::size_t kind = 0; kind < kMostKinds; ++kind) {
    progress.files_done += board.counters[kind];
  }
  progress.files_total = board.total;
  progress.bytes_total = board.total_bytes;
  const std::uint64_t started = board.counters[kStarted];
  if (started > 0) progress.seconds = static_cast<double>(milliseconds_now() - started) / 1000;
  progress.in_work = board.items_in_work();
  return progress;
}

std::string text_of(const Progress& progress) {
  std::string text = std::to_string(progress.files_done);
  if (progress.files_total > 0) text += " of " + std::to_string(progress.files_total);
  text += " files";
  if (progress.failed > 0) text += " (" + std::to_string(progress.failed) + " failed)";
  text += ", " + bytes_text(progress);
  text += words(", %.3g MB/s", progress.bytes_a_second() / 1e6);
  if (const auto left = progress.seconds_left()) text += ", " + time_text(*left) + " left";
  if (progress.in_work.empty()) return text;
  const ItemInWork& slowest = progress.in_work.front();
  text += "; " + printable(std::filesystem::path(slowest.name).filename().string()) +
          words(" %.1f s", slowest.seconds);
  if (progress.in_work.size() > 1) {
    text += ", " + std::to_string(progress.in_work.size() - 1) + " more";
  }
  return text;
}

nlohmann::ordered_json json_of(const Progress& progress, std::string_view verb) {
  nlohmann::ordered_json json = {{"progress", verb},
                                 {"files_done", progress.files_done},
                                 {"files_total", or_null(progress.files_total)},
                                 {"files_failed", progress.failed},
                                 {"files_kept", progress.kept},
                                 {"bytes_done", progress.bytes_done},
                                 {"bytes_total", or_null(progress.bytes_total)},
                                 {"seconds", progress.seconds},
                                 {"bytes_per_second", progress.bytes_a_second()},
                                 {"seconds_left", nullptr}};
  if (const auto left = progress.seconds_left()) json["seconds_left"] = *left;
  json["in_work"] = nlohmann::ordered_json::array();
  for (const ItemInWork& item : progress.in_work) {
    json["in_work"].push_back({{"file", item.name}, {"seconds", item.seconds}});
  }
  return json;
}

std::uint64_t milliseconds_now() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(
                                        std::chrono::steady_clock::now().time_since_epoch())
                                        .count());
}

std::uint64_t bytes_of_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  return error ? 0 : bytes;
}

}  // namespace triglyph
