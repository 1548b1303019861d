// The file of a run's records: it grows while the run goes on, line by line in the order in which
// meshes are done, and is put into the order of the run at the end.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>

#include "manifests/record.h"

namespace triglyph {

class RecordsFile {
 public:
  // Starts the file anew, or goes on with it (`append`), without a last line that is not whole.
  // Throws Error Usage for a file that holds anything but records, which must not be lost, and
  // Unwritable.
  RecordsFile(const std::filesystem::path& path, bool append);

  // Writes the line at once, so that a run that is killed keeps it. Throws Error Unwritable.
  void write(const Record& record);

  // Sorts the lines by their place in the run, and keeps the last one of each place: a worker that
  // takes over from another writes what that one may not have come to write. Replaces the
  // file in one step; a pipe or device is left as it is. Takes 24 bytes of memory per record.
  // Throws Error Unwritable.
  void finish();

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
};

// Throws Error Usage unless the file is empty or begins with a record, which may be cut off if it
// is all there is: what else it holds must not be lost. Throws Unwritable if it cannot be read.
void check_holds_records(const std::filesystem::path& path);

// Returns a function that returns the records of a file, or of the items of a ledger, one by one,
// and then nothing. Throws Error Unreadable for a file that cannot be read, Malformed for one
// without a record; the function throws Error Malformed naming file and line, and Unreadable.
[[nodiscard]] std::function<std::optional<Record>()> record_source(
    const std::filesystem::path& path);

// Returns the name of a file of the record, which may be relative: from where the run stood if the
// file is there, else unchanged.
[[nodiscard]] std::filesystem::path resolved(const std::filesystem::path& name,
                                             const Record& record);

}  // namespace triglyph
