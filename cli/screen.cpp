#include "cli/screen.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ostream>
#include <string>

#include <unistd.h>

namespace triglyph {
namespace {

std::atomic<bool> interrupted{false};

void on_signal(int number) {
  interrupted = true;
  std::signal(number, SIG_DFL);
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string shortened(const std::string& text, std::size_t width) {
  return text.size() <= width ? text : "..." + text.substr(text.size() - (width - 3));
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
                shortened(file.mesh.string(), 32).c_str(),
                static_cast<unsigned long long>(file.vertices),
                static_cast<unsigned long long>(file.faces), file.units_valid, file.units_embedded,
                distance.c_str(), seconds)
      << name_of(file.status) << "\n";
}

ProgressBar::ProgressBar(std::size_t total)
    : total_(total), start_s_(now_s()), visible_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::advance(bool failed) {
  ++done_;
  failed_ += failed ? 1 : 0;
  const double now = now_s();
  if (!visible_ || (now - last_draw_s_ < 0.1 && done_ < total_)) return;
  last_draw_s_ = now;
  draw();
}

void ProgressBar::draw() {
  const double share = total_ == 0 ? 1 : static_cast<double>(done_) / static_cast<double>(total_);
  const std::string bar(static_cast<std::size_t>(30 * share), '#');
  const double elapsed = now_s() - start_s_;
  std::fputs(format("\r\033[K[%-30s] %zu/%zu meshes, %zu failed, %.0f s left", bar.c_str(), done_,
                    total_, failed_, share > 0 ? elapsed * (1 - share) / share : 0.0)
                 .c_str(),
             stderr);
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!visible_ || done_ == 0) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

const std::atomic<bool>& interrupt_flag() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  return interrupted;
}

}  // namespace triglyph
