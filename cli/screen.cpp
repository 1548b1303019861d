#include "cli/screen.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ostream>
#include <string>

#include <sys/ioctl.h>
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

ProgressBar::ProgressBar(bool wanted) : visible_(wanted && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::advance(const std::function<Progress()>& progress) {
  if (!visible_) return;
  const double now = now_s();
  if (now - last_draw_s_ < 0.1) return;
  last_draw_s_ = now;
  const Progress state = progress();
  std::string text;
  if (const auto share = state.share()) {
    const std::string bar(static_cast<std::size_t>(20 * std::min(*share, 1.0)), '#');
    text = format("[%-20s] ", bar.c_str());
  }
  text += text_of(state);
  // a line that is longer than the terminal is wide could not be drawn over
  winsize window{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1;
  text.resize(std::min<std::size_t>(text.size(), is_known ? window.ws_col - 1U : 79U));
  std::fputs(("\r\033[K" + text).c_str(), stderr);
  std::fflush(stderr);
  is_drawn_ = true;
}

void ProgressBar::clear() {
  if (!is_drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  is_drawn_ = false;
}

}  // namespace triglyph
