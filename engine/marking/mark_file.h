// Marking one mesh file: load, mark, write, read back, measure. The output appears only after its
// mark was read back from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/marking/marking.h"
#include "engine/marking/options.h"
#include "engine/message/key.h"

namespace triglyph {

enum class FileStatus {
  Marked,       // the output is there and its mark was read back from it
  TooSmall,     // fewer units than the message has parts; no output
  TooCoarse,    // the file's numbers cannot hold the mark; no output
  NotVerified,  // the mark could not be read back; no output
  Unreadable,   // the rest: see ErrorCode
  Malformed,
  Unsupported,
  Unwritable,
  Usage,
  Failed,  // an error of the program itself, or not enough memory
  Interrupted,
};

// "marked", "too small", "positions too coarse", ...; the inverse returns nothing for other text.
[[nodiscard]] std::string_view name_of(FileStatus status);
[[nodiscard]] std::optional<FileStatus> file_status(std::string_view name);

struct StageTimes {
  double load = 0, mark = 0, write = 0, read_back = 0, measure = 0;  // seconds
  double layout = 0, assign = 0;                                     // of mark: steps 1 and 2
};

// What came of one mesh: everything but the times depends on the inputs alone.
struct MarkedFile {
  std::filesystem::path mesh;
  std::filesystem::path out;
  MarkRequest request;  // as it applied
  FileStatus status = FileStatus::Failed;
  std::string error;  // one line naming file and place; empty if marked
  std::string file_format;
  std::uint64_t vertices = 0;  // coordinate triples of the file
  std::uint64_t points = 0;    // distinct ones
  std::uint64_t faces = 0;
  WordFormat format;  // of the words; fill chooses the subscript bits
  std::uint32_t parts = 0;
  std::uint32_t candidates = 0;
  std::uint32_t units_valid = 0;     // after layout
  std::uint32_t units_bound = 0;     // no layout has more
  std::uint32_t units_assigned = 0;  // given a word
  std::uint32_t units_embedded = 0;  // returned all bits when the output was read back
  double cost_max = 0;               // of the assignment, model units
  double cost_sum = 0;
  double hausdorff = 0;           // symmetric, model units
  double hausdorff_rel_diag = 0;  // share of the bounding box's diagonal
  double displacement_max = 0;    // model units
  double displacement_rms = 0;
  // The embedded units, if detail is wanted; ascending by anchor.
  std::optional<std::vector<Carrier>> units;
  std::string input_hash;
  std::string output_hash;
  std::string key_fingerprint;
  StageTimes times;

  [[nodiscard]] bool is_marked() const { return status == FileStatus::Marked; }
  // How the mark is written, with the word format that fill chose.
  [[nodiscard]] Encoding encoding() const;
};

// The stages of one mesh, to be run in this order, from any thread but one at a time. None throws:
// an error becomes the result's status, and the later stages pass the mesh by.
class FileMarking {
 public:
  FileMarking(std::filesystem::path mesh, std::filesystem::path out, MarkRequest request);
  ~FileMarking();
  FileMarking(FileMarking&&) noexcept;

  void load() noexcept;
  void mark(const Key& key) noexcept;
  void write() noexcept;
  void read_back(const Key& key) noexcept;  // publishes the output if the mark is there
  void measure() noexcept;                  // and lets go of everything but the result

  // Ends a mesh whose output is not there yet as interrupted; of one that failed already, nothing
  // changes.
  void interrupt() noexcept;

  [[nodiscard]] const MarkedFile& result() const { return result_; }

 private:
  struct Work;  // the mesh, its mark and the unfinished output

  template <typename Stage>
  void run_stage(double& seconds, const Stage& stage) noexcept;
  void end(FileStatus status, const std::string& reason);
  void describe(const Marking& marking);

  MarkedFile result_;
  std::unique_ptr<Work> work_;
};

// Runs all stages. Does not throw: see MarkedFile::status.
[[nodiscard]] MarkedFile mark_file(const std::filesystem::path& mesh,
                                   const std::filesystem::path& out, const MarkRequest& request,
                                   const Key& key);

// Returns the bytes of memory that marking takes at most, from the size of the file, its ending
// (in any case) and what is to be hidden. An estimate from above for meshes as they are found; a
// file of comments takes less.
[[nodiscard]] std::uint64_t estimate_memory(std::uint64_t file_bytes,
                                            const std::filesystem::path& mesh, bool fill);

}  // namespace triglyph
