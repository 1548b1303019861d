// Terminal output and input: a table of records, a progress bar, and the interrupt key.
#pragma once

#include <functional>
#include <iosfwd>

#include "cli/progress.h"
#include "manifests/record.h"

namespace triglyph {

// Print a table with one row per mesh, aligned for names of up to 32 characters.
// Longer names are shortened at the front.
void print_table_heading(std::ostream& out);
void print_table_row(std::ostream& out, const Record& record);

// A progress bar on standard error, redrawn at most ten times a second. Silent unless standard
// error is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar();
  // Draws the bar if it is time; only then asks for the progress.
  void advance(const std::function<Progress()>& progress);
  void clear();  // before other output to the same terminal

 private:
  double last_draw_s_ = 0;
  bool is_drawn_ = false;
  bool visible_;
};

}  // namespace triglyph
