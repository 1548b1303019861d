// Terminal output and input: a table of records, a progress bar, and the interrupt key.
#pragma once

#include <iosfwd>

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
  // Starts at `done`, the number of files that are done already. A `total` of 0 is not known.
  ProgressBar(std::size_t total, std::size_t done, bool quiet);
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

}  // namespace triglyph
