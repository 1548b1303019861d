// What people see: a table of records, a progress bar, and the interrupt key.
#pragma once

#include <atomic>
#include <iosfwd>

#include "manifests/record.h"

namespace triglyph {

// One line a mesh under a heading; printable anywhere, aligned for names up to 32 characters.
void print_table_heading(std::ostream& out);
void print_table_row(std::ostream& out, const Record& record);

// A line on the terminal behind stderr that is redrawn at most ten times a second; silent
// elsewhere.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total);
  ~ProgressBar();
  void advance(bool failed);
  void clear();  // before other output to the same terminal

 private:
  void draw();
  std::size_t total_;
  std::size_t done_ = 0;
  std::size_t failed_ = 0;
  double last_draw_s_ = 0;
  double start_s_ = 0;
  bool visible_;
};

// Becomes true at the first SIGINT or SIGTERM; the second one ends the process at once.
[[nodiscard]] const std::atomic<bool>& interrupt_flag();

}  // namespace triglyph
