#include "cli/screen.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ostream>
#include <string>

#include <unistd.h>

#include "engine/base/text.h"

namespace triglyph {
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string shortened(const std::string& text, std::size_t width) {
  if (text.size() <= width) return text;
  std::size_t begin = text.size() - (width - 3);
  // not in the middle of a character of UTF-8
  while (begin < text.size() && (static_cast<unsigned char>(text[begin]) & 0xc0U) == 0x80) ++begin;
  return "..." + text.substr(begin);
}

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  std::string text(256, '\0');
  const int size = std::snprintf(text.data(), text.size(), pattern, values...);
  text.resize(std::min(static_cast<std::size_t>(std::max(size, 0)), text.size() - 1));
  return text;
}

}  // namespace

void print_table_heading(std::ostream& out) {
  out << format("%-32s %9s %9s %6s %6s %10s %7s  %s\n", "mesh", "vertices", "faces", "units",
                "read", "hausdorff", "time", "verdict");
}

void print_table_row(std::ostream& out, const Record& record) {
  const MarkedFile& file = record.file;
  const StageTimes& times = file.times;
  const double seconds = times.load + times.mark + times.write + times.read_back + times.measure;
  const std::string distance =
      file.is_marked() ? format("%.5f%%", 100 * file.hausdorff_rel_diag) : "-";
  out << format("%-32s %9llu %9llu %6u %6u %10s %6.2fs  ",
                shortened(printable(file.mesh.string()), 32).c_str(),
                static_cast<unsigned long long>(file.vertices),
                static_cast<unsigned long long>(file.faces), file.units_valid, file.units_embedded,
                distance.c_str(), seconds)
      << name_of(file.status) << (record.is_kept ? " (kept)" : "") << "\n";
}

ProgressBar::ProgressBar(std::size_t total, std::size_t done, bool quiet)
    : total_(total),
      done_(done),
      start_s_(now_s()),
      visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::advance(bool failed) {
  ++done_;
  failed_ += failed ? 1 : 0;
  const double now = now_s();
  if (!visible_ || (now - last_draw_s_ < 0.1 && done_ != total_)) return;
  last_draw_s_ = now;
  draw();
}

void ProgressBar::draw() {
  if (total_ == 0) {
    std::fputs(format("\r\033[K%zu files, %zu failed", done_, failed_).c_str(), stderr);
    std::fflush(stderr);
    return;
  }
  const double share = static_cast<double>(done_) / static_cast<double>(total_);
  const std::string bar(static_cast<std::size_t>(30 * std::min(share, 1.0)), '#');
  const double elapsed = now_s() - start_s_;
  const double left = share > 0 ? elapsed * (1 - share) / share : 0;
  std::fputs(format("\r\033[K[%-30s] %zu/%zu files, %zu failed, %.0f s left", bar.c_str(), done_,
                    total_, failed_, std::max(left, 0.0))
                 .c_str(),
             stderr);
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!visible_ || done_ == 0) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace triglyph
