// The memory of an owner: one SQLite file that knows every run, the state of every output, every
// mark that was ever issued, and what was found in files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace triglyph {

// A run as the ledger remembers it. Times are UTC, as "2026-03-01T12:00:00Z".
struct LedgerRun {
  std::int64_t id = 0;
  std::string verb = {};
  std::string command = {};    // the arguments, as a shell would take them
  std::string directory = {};  // where the run stood
  std::string version = {};    // of triglyph
  std::string started = {};
  std::string ended = {};    // empty: the run was killed, or is under way
  std::string outcome = {};  // "done", "some failed", "interrupted", ..
};

// The state of one output. Names are those of Job, made absolute, byte for byte.
struct LedgerItem {
  std::string target;  // the output, which identifies the item
  std::string source;  // the mesh
  std::string input_hash;
  std::string task;  // hash of the request: payload, scheme and options
  std::string key;   // fingerprint
  std::string status;
  std::string output_hash;    // empty: there is no output
  std::string record;         // one line of JSON; see record.h
  std::int64_t run = 0;       // that made the item or last found it done
  std::uint64_t place = 0;    // in that run, from 0
  std::string finished = {};  // UTC; empty: it is put now
};

// How a sweep last found an output. There is one row for each, so that a sweep of an unchanged
// library does not let the ledger grow.
struct LedgerState {
  std::string target;        // as LedgerItem::target
  std::string state;         // "intact", "altered", ..; see FileState
  std::string change;        // what was new in it
  std::string expected;      // LedgerItem::output_hash at that time
  std::string hash;          // of the file as it was found; empty: it could not be read
  bool is_accepted = false;  // the owner knows, and wants to hear no more of it
  std::string line;          // one JSON object: what the sweep prints with --json
  std::int64_t run = 0;      // the sweep
  std::string checked = {};  // UTC
};

// The scheme of marks that displace every point, in the ledger: they are read with their mesh.
inline constexpr std::string_view kPointsScheme = "points";

// A mark that was issued. Never changed and never deleted.
struct LedgerMark {
  std::int64_t number = 0;  // assigned by the ledger, from 1
  std::string message_hex;  // empty: fill
  std::string recipient;    // empty: none
  std::string mesh;         // absolute
  std::string out;          // absolute
  std::string scheme;
  std::string options;  // JSON object
  std::string key;      // fingerprint
  std::string input_hash;
  std::string output_hash;
  std::string issued;  // UTC
};

// The shape of a mesh of which copies were issued; see KeptShape.
struct LedgerShape {
  std::string input_hash;  // of the mesh
  std::string bytes;
};

// What a run that writes no mesh (extract, verify, measure, render) found in one file or pair.
struct LedgerResult {
  std::int64_t run = 0;
  std::uint64_t place = 0;  // in that run, from 0
  std::string file;         // absolute; of a pair the original
  std::string status;       // in the words of the verb: "marked", "altered", "crashed", ..
  std::string line;         // one JSON object: what the verb prints with --json
};

class Ledger {
 public:
  // Opens the ledger, or creates it with mode 0600. Several processes may have it open: writers
  // wait for each other. Throws Error Malformed for a file that is no ledger or of a newer schema,
  // and Unwritable.
  explicit Ledger(const std::filesystem::path& path);
  ~Ledger();
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  // All members may be called from any thread, and throw Error Unwritable if the ledger cannot be
  // read or written. What returned is there after the process was killed; a power failure may take
  // the last moments.

  // Returns the number of the new run. `run.id`, `started` and what follows are ignored.
  [[nodiscard]] std::int64_t begin_run(const LedgerRun& run);
  void end_run(std::int64_t run, std::string_view outcome);

  [[nodiscard]] std::optional<LedgerItem> find(std::string_view target) const;

  // Enter what another ledger knows, with its times: a run, whose number here is returned, and a
  // mark, as put() does.
  [[nodiscard]] std::int64_t put_run(const LedgerRun& run);
  void put_mark(const LedgerMark& mark);

  // Calls `work`, of whose changes all are made or, if it throws, none. Not to be nested, and
  // nothing else may use this object meanwhile.
  void in_one_step(const std::function<void()>& work);

  // Inserts or replaces the item, and issues the mark unless one with the same input, output, key
  // and name was issued before; in one transaction.
  void put(const LedgerItem& item, const std::optional<LedgerMark>& mark);

  // Says that the run found the item done.
  void keep(std::string_view target, std::int64_t run, std::uint64_t place);

  // Inserts or replaces what the run found at this place.
  void note(const LedgerResult& result);

  // Keep the shape of a mesh, unless there is one.
  void put_shape(const LedgerShape& shape);
  [[nodiscard]] bool has_shape(std::string_view input_hash) const;
  // Returns nothing if there is none.
  [[nodiscard]] std::optional<LedgerShape> shape_of(std::string_view input_hash) const;

  // Inserts or replaces the state of an output.
  void put_state(const LedgerState& state);
  [[nodiscard]] std::optional<LedgerState> state_of(std::string_view target) const;

  // Returns the mark that was issued with this content, if any.
  [[nodiscard]] std::optional<LedgerMark> mark_of(std::string_view output_hash) const;

  // Returns the first item whose output's name is greater, by bytes; nothing after the last. From
  // "" on, this yields all items in the order of their names. Throws Error Malformed for a damaged
  // ledger.
  [[nodiscard]] std::optional<LedgerItem> find_after(std::string_view target) const;

  // Call the function for every mark or run, ascending by number; every result, by run and place;
  // or every state that a sweep left, by name.
  void for_each_mark(const std::function<void(const LedgerMark&)>& visit) const;
  void for_each_mark_of(std::string_view message_hex,
                        const std::function<void(const LedgerMark&)>& visit) const;
  void for_each_run(const std::function<void(const LedgerRun&)>& visit) const;
  void for_each_result(const std::function<void(const LedgerResult&)>& visit) const;
  void for_each_shape(const std::function<void(const LedgerShape&)>& visit) const;
  void for_each_state(const std::function<void(const LedgerState&)>& visit) const;
  void for_each_state(std::int64_t run, const std::function<void(const LedgerState&)>& visit) const;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  struct Database;

  std::filesystem::path path_;
  std::unique_ptr<Database> database_;
};

// Returns whether the file begins as a SQLite database does.
[[nodiscard]] bool is_ledger_file(const std::filesystem::path& path);

}  // namespace triglyph
