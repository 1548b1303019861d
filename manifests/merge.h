// The ledgers and records of the shards of a run, made into those of the whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "manifests/ledger.h"

namespace triglyph {

// What the shards lack.
struct Gap {
  std::uint64_t first = 0;  // place in the whole run
  std::uint64_t last = 0;
};

struct MergedRecords {
  std::uint64_t records = 0;
  std::uint64_t jobs = 0;  // of the whole run; 0: no record tells
  std::vector<Gap> gaps;   // places without a record, ascending
};

// Writes the records of all files, ordered by their place, each place once. Of records of
// the same place the first counts that has an output, else the first that was not interrupted; all
// that have outputs must be the same but for their object "run". Throws Error
// Malformed naming both lines where they are not, and for what is no record; Unreadable and
// Unwritable. Takes 32 bytes of memory per record.
MergedRecords merge_records(std::span<const std::filesystem::path> files,
                            const std::filesystem::path& out);

// Enters runs, items, marks, results, states and shapes of other ledgers into one, in one
// transaction. What is there already stays as it is, so that merging again changes nothing. Marks
// get their numbers in the order of their place in the run. Of two items of the same output the
// later counts, but one that has an output before one that has none. Throws Error Malformed naming
// both ledgers if the same mesh, request and key gave other bytes. O(rows).
void merge_ledgers(std::span<const std::filesystem::path> ledgers, Ledger& out);

}  // namespace triglyph
