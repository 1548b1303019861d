// Marking of one mesh file: load, mark, write, read back, measure. The output file appears only
// once its mark was read back from it.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/marking/marking.h"
#include "engine/marking/mesh_of_copies.h"
#include "engine/marking/options.h"
#include "engine/message/key.h"

namespace triglyph {

enum class FileStatus {
  Marked,  // the output exists, and its mark was read back from it
  // Likewise; what it carries is the fingerprint of the message, which is found by whoever has the
  // message or a list in which it is.
  Traceable,
  // All others: there is no output.
  TooSmall,       // fewer units than the message has parts
  TooCoarse,      // the file's numbers cannot hold the mark
  TooVisible,     // a point would move farther than the user allows
  AlreadyMarked,  // the mesh carries a mark of this key already
  NotVerified,    // the mark could not be read back
  Unreadable,     // this and the next four: see ErrorCode
  Malformed,
  Unsupported,
  Unwritable,
  Usage,
  Exists,   // another file has the output's name, and the user wants to keep it
  Failed,   // an error of the program itself, or not enough memory
  Crashed,  // the process that worked on the mesh died
  TooSlow,  // the mesh took longer than the user allows
  Interrupted,
};

// Convert a status to the name in records ("marked", "too small", "positions too coarse", ..) and
// back. file_status() returns nothing for other text.
[[nodiscard]] std::string_view name_of(FileStatus status);
[[nodiscard]] std::optional<FileStatus> file_status(std::string_view name);

// Returns the names in the order of FileStatus.
[[nodiscard]] std::span<const std::string_view> file_status_names();

// Returns the status of a file that an error ended.
[[nodiscard]] FileStatus file_status(ErrorCode code);

// Wall-clock times in seconds.
struct StageTimes {
  double load = 0, mark = 0, write = 0, read_back = 0, measure = 0;
  double layout = 0, assign = 0;  // steps 1 and 2, parts of `mark`
};

// Is told, at the end of each stage that was run, its name and when it began and ended. Must not
// throw.
using StageListener =
    std::function<void(std::string_view stage, std::chrono::steady_clock::time_point start,
                       std::chrono::steady_clock::time_point end)>;

// The result for one mesh. Everything but the times depends on the inputs alone.
struct MarkedFile {
  std::filesystem::path mesh;
  std::filesystem::path out;
  MarkRequest request;  // with relative sizes made absolute for fill
  FileStatus status = FileStatus::Failed;
  std::string error;  // one line naming file and place; empty if marked
  std::string file_format;
  std::uint64_t vertices = 0;  // vertices of the file
  std::uint64_t points = 0;    // distinct positions among them
  std::uint64_t faces = 0;     // faces of the file
  WordFormat format;           // of the words; fill chooses the subscript bits
  std::uint32_t parts = 0;     // of the message; 0: there is no layer of units
  std::uint32_t candidates = 0;
  std::uint32_t units_valid = 0;     // chosen by the layout
  std::uint32_t units_bound = 0;     // upper bound of the size of any layout
  std::uint32_t units_assigned = 0;  // given a word
  std::uint32_t units_embedded = 0;  // whose word was read back from the output
  std::optional<FluxMark> flux;      // the flux layer
  double evidence = 0;               // of a fingerprint in the output, bits: see evidence_of()
  bool needs_original = false;       // to find the fingerprint
  int colluders = 1;                 // that it resists: see colluders_resisted()
  int digits = 0;                    // more than the file's that moved coordinates have
  double cost_max = 0;               // of the assignment, model units
  double cost_sum = 0;               // likewise
  double hausdorff = 0;              // symmetric, model units
  double hausdorff_rel_diag = 0;     // relative to the surface's diagonal
  double displacement_max = 0;       // model units
  double displacement_rms = 0;       // model units, over all points
  // The embedded units, ascending by anchor; only with MarkOptions::detail.
  std::optional<std::vector<Carrier>> units;
  std::string input_hash;
  std::string output_hash;
  std::string key_fingerprint;
  StageTimes times;

  [[nodiscard]] bool is_marked() const {
    return status == FileStatus::Marked || status == FileStatus::Traceable;
  }
  // Returns the encoding of the mark, with the word format that fill chose.
  [[nodiscard]] Encoding encoding() const;
};

// Returns the evidence, in bits, that a surface carries the fingerprint that was written: see
// evidence_of(). `format` is that of its units if they are known to be read as they were written,
// which is all that is then tried; readers pay for more, and so does the evidence. A mark that
// needs the original leaves none without it, and none where the surface has other points.
// Precondition: the status is Traceable, or may become it.
[[nodiscard]] double fingerprint_evidence(const MarkedFile& marked, const Surface& surface,
                                          const std::optional<Mesh>& original, const Key& key,
                                          FluxEffort effort,
                                          const std::optional<WordFormat>& format = {});

// The stages of marking one mesh, to be run in this order, from any thread, one at a time. They do
// not throw: an error becomes the status of the result, and later stages then do nothing.
class FileMarking {
 public:
  // `copies` are the mesh of several copies, of which this is one, if it is shared; its fingerprint
  // must be asked for, by options that differ in the message alone.
  FileMarking(std::filesystem::path mesh, std::filesystem::path out, MarkRequest request,
              std::shared_ptr<const MeshOfCopies> copies = nullptr);
  ~FileMarking();
  FileMarking(FileMarking&&) noexcept;

  // Tells the listener of every stage: "load", "mark", "write", "read back", "measure", "publish".
  void listen(StageListener listener) { listener_ = std::move(listener); }

  void load() noexcept;
  void mark(const Key& key) noexcept;
  void write() noexcept;
  void read_back(const Key& key) noexcept;  // from the file that was written
  void measure() noexcept;
  // Gives the output its name and the permissions of the mesh's file, on request also its
  // modification time, and releases everything but the result.
  void publish(bool keeps_time = false) noexcept;

  // Returns the bytes of the KeptShape of the mesh, for copies with a flux layer; nothing for
  // others, and after publish(). Does not throw: without memory there is nothing.
  [[nodiscard]] std::vector<char> kept_shape() const noexcept;

  // Enters the hash of the mesh's file into the result, if the file can be read; load() does so
  // too.
  void note_input_hash() noexcept;

  // Give the mesh another status than Marked, unless it failed already. To be called only before
  // the output is published.
  void interrupt() noexcept;
  void refuse(FileStatus status, const std::string& reason) noexcept;

  [[nodiscard]] const MarkedFile& result() const { return result_; }

 private:
  struct Work;  // the mesh, its mark and the unfinished output

  template <typename Stage>
  void run_stage(std::string_view name, double& seconds, const Stage& stage) noexcept;
  void end(FileStatus status, const std::string& reason);
  void describe(const Marking& marking);
  [[nodiscard]] Marking marked_as(const MarkOptions& options, const Key& key) const;
  void mark_as(const MarkOptions& options, const Key& key);
  [[nodiscard]] bool reads_fingerprint(const Key& key);
  void write_output();

  MarkedFile result_;
  std::unique_ptr<Work> work_;
  StageListener listener_;
};

// Runs all stages. Does not throw: see MarkedFile::status.
[[nodiscard]] MarkedFile mark_file(const std::filesystem::path& mesh,
                                   const std::filesystem::path& out, const MarkRequest& request,
                                   const Key& key);

// What is done to a mesh, as far as it decides how much memory that takes.
enum class MeshWork : std::uint8_t {
  Usual,  // reading, measuring, marking units
  Fill,   // a cost matrix of all units
  Flux,   // a flux layer
};
[[nodiscard]] MeshWork work_of(const MarkRequest& request);

// Returns an upper estimate of the memory, in bytes, that work on a file takes, from its size and
// its extension (in any case), and of a .glb from its JSON as well, if it is there. Measured on
// common meshes; a file that is mostly comments takes less.
[[nodiscard]] std::uint64_t estimate_memory(std::uint64_t file_bytes,
                                            const std::filesystem::path& mesh, MeshWork work);

}  // namespace triglyph
