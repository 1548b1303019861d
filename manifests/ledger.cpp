#include "manifests/ledger.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include "engine/base/error.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// "TGLY": tells a ledger from other databases.
constexpr int kApplicationId = 0x54474c59;

// Milliseconds to wait for another process that writes.
constexpr int kBusyTimeout = 20000;

// Step i leads from schema i to schema i + 1. Steps are never changed, only added.
constexpr std::array<const char*, 5> kSteps = {
    R"sql(
CREATE TABLE runs (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  verb TEXT NOT NULL,
  command BLOB NOT NULL,
  directory BLOB NOT NULL,
  version TEXT NOT NULL,
  started TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%SZ', 'now')),
  ended TEXT,
  outcome TEXT
);
CREATE TABLE items (
  target BLOB PRIMARY KEY,
  source BLOB NOT NULL,
  input_hash TEXT NOT NULL,
  task TEXT NOT NULL,
  key TEXT NOT NULL,
  status TEXT NOT NULL,
  output_hash TEXT NOT NULL,
  record TEXT NOT NULL,
  run INTEGER NOT NULL REFERENCES runs (id),
  place INTEGER NOT NULL,
  finished TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%SZ', 'now'))
) WITHOUT ROWID;
CREATE TABLE marks (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  message_hex TEXT NOT NULL,
  recipient TEXT NOT NULL,
  mesh BLOB NOT NULL,
  out BLOB NOT NULL,
  scheme TEXT NOT NULL,
  options TEXT NOT NULL,
  key TEXT NOT NULL,
  input_hash TEXT NOT NULL,
  output_hash TEXT NOT NULL,
  issued TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%SZ', 'now')),
  UNIQUE (output_hash, input_hash, key, out)
);
CREATE TRIGGER marks_stay_as_they_are BEFORE UPDATE ON marks
BEGIN SELECT RAISE(ABORT, 'marks are never changed'); END;
CREATE TRIGGER marks_stay BEFORE DELETE ON marks
BEGIN SELECT RAISE(ABORT, 'marks are never deleted'); END;
)sql",
    R"sql(
CREATE TABLE results (
  run INTEGER NOT NULL REFERENCES runs (id),
  place INTEGER NOT NULL,
  file BLOB NOT NULL,
  status TEXT NOT NULL,
  line TEXT NOT NULL,
  PRIMARY KEY (run, place)
) WITHOUT ROWID;
)sql",
    "CREATE INDEX marks_by_message ON marks (message_hex);",
    R"sql(
CREATE TABLE states (
  target BLOB PRIMARY KEY,
  state TEXT NOT NULL,
  change TEXT NOT NULL,
  expected TEXT NOT NULL,
  hash TEXT NOT NULL,
  accepted INTEGER NOT NULL,
  line TEXT NOT NULL,
  run INTEGER NOT NULL REFERENCES runs (id),
  checked TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%SZ', 'now'))
) WITHOUT ROWID;
)sql",
    R"sql(
CREATE TABLE shapes (
  input_hash TEXT PRIMARY KEY,
  bytes BLOB NOT NULL,
  kept TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%SZ', 'now'))
);
)sql"};
constexpr int kSchema = static_cast<int>(kSteps.size());

constexpr const char* kItemColumns =
    "SELECT target, source, input_hash, task, key, status, output_hash, record, run, place, "
    "finished FROM items ";
constexpr const char* kStateColumns =
    "SELECT target, state, change, expected, hash, accepted, line, run, checked FROM states ";
constexpr const char* kMarkColumns =
    "SELECT number, message_hex, recipient, mesh, out, scheme, options, key, input_hash, "
    "output_hash, issued FROM marks ";

}  // namespace

// The connection. One statement runs at a time.
struct Ledger::Database {
  fs::path path;
  sqlite3* handle = nullptr;
  mutable std::mutex mutex;

  // Prepared statements by their text: preparing one costs as much as running it.
  mutable std::unordered_map<std::string, sqlite3_stmt*> statements;

  // Why no lock can be had. Each attempt takes SQLite ten seconds, so that there is one.
  mutable std::string no_locks;

  ~Database() {
    for (const auto& [sql, statement] : statements) sqlite3_finalize(statement);
    sqlite3_close_v2(handle);
  }

  [[nodiscard]] sqlite3_stmt* prepared(const std::string& sql) const {
    if (!no_locks.empty()) throw Error(ErrorCode::Unwritable, path, "", no_locks);
    sqlite3_stmt*& statement = statements[sql];
    if (statement == nullptr &&
        sqlite3_prepare_v3(handle, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &statement,
                           nullptr) != SQLITE_OK) {
      fail();
    }
    return statement;
  }

  [[noreturn]] void fail() const {
    const int code = sqlite3_errcode(handle) & 0xff;
    const bool is_other = code == SQLITE_NOTADB || code == SQLITE_CORRUPT;
    std::string reason = sqlite3_errmsg(handle);
    // it may quote the file, which may be anything
    for (char& c : reason) c = static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
    reason = "the ledger: " + reason;
    if (code == SQLITE_PROTOCOL) no_locks = reason;
    throw Error(is_other ? ErrorCode::Malformed : ErrorCode::Unwritable, path, "", reason);
  }

  void execute(const char* sql) const {
    if (sqlite3_exec(handle, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }
};

namespace {

// A statement with its parameters bound in order. Text is bound as bytes where the column is BLOB.
class LedgerStatement {
 public:
  template <typename Database>
  LedgerStatement(const Database& database, const std::string& sql)
      : fail_([&database] { database.fail(); }), statement_(database.prepared(sql)) {}
  ~LedgerStatement() {
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
  }
  LedgerStatement(const LedgerStatement&) = delete;
  LedgerStatement& operator=(const LedgerStatement&) = delete;

  LedgerStatement& text(std::string_view value) {
    expect(sqlite3_bind_text(statement_, ++bound_, value.data(), static_cast<int>(value.size()),
                             SQLITE_TRANSIENT));
    return *this;
  }
  LedgerStatement& bytes(std::string_view value) {
    expect(sqlite3_bind_blob(statement_, ++bound_, value.empty() ? "" : value.data(),
                             static_cast<int>(value.size()), SQLITE_TRANSIENT));
    return *this;
  }
  LedgerStatement& number(std::int64_t value) {
    expect(sqlite3_bind_int64(statement_, ++bound_, value));
    return *this;
  }

  // Returns whether there is a row.
  bool step() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail_();
    return code == SQLITE_ROW;
  }

  [[nodiscard]] std::string text_at(int column) const {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_, column));
    const int size = sqlite3_column_bytes(statement_, column);
    return data == nullptr ? std::string() : std::string(data, static_cast<std::size_t>(size));
  }
  [[nodiscard]] std::int64_t number_at(int column) const {
    return sqlite3_column_int64(statement_, column);
  }

 private:
  void expect(int code) {
    if (code != SQLITE_OK) fail_();
  }

  std::function<void()> fail_;
  sqlite3_stmt* statement_;
  int bound_ = 0;
};

// Writes several rows or none.
template <typename Database>
class LedgerTransaction {
 public:
  // Within another transaction it is a part of that.
  explicit LedgerTransaction(const Database& database)
      : database_(database), done_(sqlite3_get_autocommit(database.handle) == 0) {
    is_part_ = done_;
    if (!is_part_) LedgerStatement(database_, "BEGIN IMMEDIATE").step();
  }
  ~LedgerTransaction() {
    if (!done_) sqlite3_exec(database_.handle, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  LedgerTransaction(const LedgerTransaction&) = delete;
  LedgerTransaction& operator=(const LedgerTransaction&) = delete;
  void commit() {
    if (!is_part_) LedgerStatement(database_, "COMMIT").step();
    done_ = true;
  }

 private:
  const Database& database_;
  bool done_;
  bool is_part_ = false;
};

template <typename Database>
std::int64_t pragma(const Database& database, const char* name) {
  LedgerStatement statement(database, std::string("PRAGMA ") + name);
  return statement.step() ? statement.number_at(0) : 0;
}

template <typename Database>
void migrate(const Database& database) {
  LedgerTransaction transaction(database);
  const auto schema = static_cast<int>(pragma(database, "user_version"));
  const bool is_new = schema == 0 && pragma(database, "schema_version") == 0;
  if (schema < 0 || (!is_new && pragma(database, "application_id") != kApplicationId)) {
    throw Error(ErrorCode::Malformed, database.path, "", "is a database, but no ledger");
  }
  if (schema > kSchema) {
    throw Error(ErrorCode::Malformed, database.path, "",
                "the ledger has schema " + std::to_string(schema) +
                    ", which needs a newer triglyph; this one knows up to " +
                    std::to_string(kSchema));
  }
  for (int step = schema; step < kSchema; ++step) {
    database.execute(kSteps[static_cast<std::size_t>(step)]);
  }
  if (schema < kSchema) {
    database.execute(("PRAGMA application_id=" + std::to_string(kApplicationId)).c_str());
    database.execute(("PRAGMA user_version=" + std::to_string(kSchema)).c_str());
  }
  transaction.commit();
}

// Creates an empty file with mode 0600 if there is none: it will hold messages and recipients.
void create_private(const fs::path& path) {
  if (path.has_parent_path()) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) throw Error(ErrorCode::Unwritable, path, "", "the ledger: " + error.message());
  }
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor < 0) {
    throw Error(ErrorCode::Unwritable, path, "",
                "the ledger: " + system_reason(errno) + "; --ledger names another place");
  }
  ::close(descriptor);
}

LedgerItem item_in(const LedgerStatement& row) {
  return {row.text_at(0),   row.text_at(1),
          row.text_at(2),   row.text_at(3),
          row.text_at(4),   row.text_at(5),
          row.text_at(6),   row.text_at(7),
          row.number_at(8), static_cast<std::uint64_t>(row.number_at(9)),
          row.text_at(10)};
}

LedgerState state_in(const LedgerStatement& row) {
  return {row.text_at(0),        row.text_at(1), row.text_at(2),   row.text_at(3), row.text_at(4),
          row.number_at(5) != 0, row.text_at(6), row.number_at(7), row.text_at(8)};
}

LedgerMark mark_in(const LedgerStatement& row) {
  return {row.number_at(0), row.text_at(1), row.text_at(2), row.text_at(3),
          row.text_at(4),   row.text_at(5), row.text_at(6), row.text_at(7),
          row.text_at(8),   row.text_at(9), row.text_at(10)};
}

template <typename Database>
void insert_mark(const Database& database, const LedgerMark& mark) {
  LedgerStatement(database,
                  "INSERT OR IGNORE INTO marks (message_hex, recipient, mesh, out, scheme, "
                  "options, key, input_hash, output_hash, issued) VALUES (?, ?, ?, ?, ?, ?, ?, ?, "
                  "?, coalesce(nullif(?, ''), strftime('%Y-%m-%dT%H:%M:%SZ', 'now')))")
      .text(mark.message_hex)
      .text(mark.recipient)
      .bytes(mark.mesh)
      .bytes(mark.out)
      .text(mark.scheme)
      .text(mark.options)
      .text(mark.key)
      .text(mark.input_hash)
      .text(mark.output_hash)
      .text(mark.issued)
      .step();
}

}  // namespace

Ledger::Ledger(const fs::path& path) : path_(path), database_(std::make_unique<Database>()) {
  create_private(path);
  Database& database = *database_;
  database.path = path;
  // absolute, since SQLite reads a name that begins with ":" or "file:" in its own way
  const std::string name = fs::absolute(path).lexically_normal().string();
  constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(name.c_str(), &database.handle, kFlags, nullptr) != SQLITE_OK) {
    database.fail();
  }
  sqlite3_busy_timeout(database.handle, kBusyTimeout);
  // Readers and a writer do not wait for each other; where a file system cannot share memory,
  // SQLite keeps its rollback journal, which is as safe.
  database.execute("PRAGMA journal_mode=WAL");
  database.execute("PRAGMA synchronous=NORMAL");
  migrate(database);
}

Ledger::~Ledger() = default;

std::int64_t Ledger::begin_run(const LedgerRun& run) {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement(*database_,
                  "INSERT INTO runs (verb, command, directory, version) VALUES (?, ?, ?, ?)")
      .text(run.verb)
      .bytes(run.command)
      .bytes(run.directory)
      .text(run.version)
      .step();
  return sqlite3_last_insert_rowid(database_->handle);
}

void Ledger::end_run(std::int64_t run, std::string_view outcome) {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement(*database_,
                  "UPDATE runs SET ended = strftime('%Y-%m-%dT%H:%M:%SZ', 'now'), outcome = ? "
                  "WHERE id = ?")
      .text(outcome)
      .number(run)
      .step();
}

std::optional<LedgerItem> Ledger::find(std::string_view target) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_, std::string(kItemColumns) + "WHERE target = ?");
  if (!row.bytes(target).step()) return std::nullopt;
  return item_in(row);
}

void Ledger::put(const LedgerItem& item, const std::optional<LedgerMark>& mark) {
  const std::lock_guard lock(database_->mutex);
  LedgerTransaction transaction(*database_);
  LedgerStatement(
      *database_,
      "INSERT OR REPLACE INTO items (target, source, input_hash, task, key, status, "
      "output_hash, record, run, place, finished) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
      "coalesce(nullif(?, ''), strftime('%Y-%m-%dT%H:%M:%SZ', 'now')))")
      .bytes(item.target)
      .bytes(item.source)
      .text(item.input_hash)
      .text(item.task)
      .text(item.key)
      .text(item.status)
      .text(item.output_hash)
      .text(item.record)
      .number(item.run)
      .number(static_cast<std::int64_t>(item.place))
      .text(item.finished)
      .step();
  if (mark) insert_mark(*database_, *mark);
  transaction.commit();
}

void Ledger::put_mark(const LedgerMark& mark) {
  const std::lock_guard lock(database_->mutex);
  insert_mark(*database_, mark);
}

std::int64_t Ledger::put_run(const LedgerRun& run) {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement(*database_,
                  "INSERT INTO runs (verb, command, directory, version, started, ended, outcome) "
                  "VALUES (?, ?, ?, ?, ?, nullif(?, ''), nullif(?, ''))")
      .text(run.verb)
      .bytes(run.command)
      .bytes(run.directory)
      .text(run.version)
      .text(run.started)
      .text(run.ended)
      .text(run.outcome)
      .step();
  return sqlite3_last_insert_rowid(database_->handle);
}

void Ledger::in_one_step(const std::function<void()>& work) {
  LedgerTransaction transaction(*database_);
  work();
  transaction.commit();
}

void Ledger::keep(std::string_view target, std::int64_t run, std::uint64_t place) {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement(*database_, "UPDATE items SET run = ?, place = ? WHERE target = ?")
      .number(run)
      .number(static_cast<std::int64_t>(place))
      .bytes(target)
      .step();
}

void Ledger::note(const LedgerResult& result) {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement(*database_,
                  "INSERT OR REPLACE INTO results (run, place, file, status, line) "
                  "VALUES (?, ?, ?, ?, ?)")
      .number(result.run)
      .number(static_cast<std::int64_t>(result.place))
      .bytes(result.file)
      .text(result.status)
      .text(result.line)
      .step();
}

void Ledger::put_shape(const LedgerShape& shape) {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement(*database_, "INSERT OR IGNORE INTO shapes (input_hash, bytes) VALUES (?, ?)")
      .text(shape.input_hash)
      .bytes(shape.bytes)
      .step();
}

bool Ledger::has_shape(std::string_view input_hash) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_, "SELECT 1 FROM shapes WHERE input_hash = ?");
  return row.text(input_hash).step();
}

std::optional<LedgerShape> Ledger::shape_of(std::string_view input_hash) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_, "SELECT input_hash, bytes FROM shapes WHERE input_hash = ?");
  if (!row.text(input_hash).step()) return std::nullopt;
  return LedgerShape{row.text_at(0), row.text_at(1)};
}

void Ledger::put_state(const LedgerState& state) {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement(*database_,
                  "INSERT OR REPLACE INTO states (target, state, change, expected, hash, accepted, "
                  "line, run, checked) VALUES (?, ?, ?, ?, ?, ?, ?, ?, coalesce(nullif(?, ''), "
                  "strftime('%Y-%m-%dT%H:%M:%SZ', 'now')))")
      .bytes(state.target)
      .text(state.state)
      .text(state.change)
      .text(state.expected)
      .text(state.hash)
      .number(state.is_accepted ? 1 : 0)
      .text(state.line)
      .number(state.run)
      .text(state.checked)
      .step();
}

std::optional<LedgerState> Ledger::state_of(std::string_view target) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_, std::string(kStateColumns) + "WHERE target = ?");
  if (!row.bytes(target).step()) return std::nullopt;
  return state_in(row);
}

std::optional<LedgerMark> Ledger::mark_of(std::string_view output_hash) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_,
                      std::string(kMarkColumns) + "WHERE output_hash = ? ORDER BY number LIMIT 1");
  if (!row.text(output_hash).step()) return std::nullopt;
  return mark_in(row);
}

void Ledger::for_each_mark_of(std::string_view message_hex,
                              const std::function<void(const LedgerMark&)>& visit) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_,
                      std::string(kMarkColumns) + "WHERE message_hex = ? ORDER BY number");
  row.text(message_hex);
  while (row.step()) visit(mark_in(row));
}

std::optional<LedgerItem> Ledger::find_after(std::string_view target) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_,
                      std::string(kItemColumns) + "WHERE target > ? ORDER BY target LIMIT 1");
  if (!row.bytes(target).step()) return std::nullopt;
  LedgerItem item = item_in(row);
  // a damaged file must not lead its readers in circles
  if (item.target <= target) {
    throw Error(ErrorCode::Malformed, path_, "", "the ledger: its items are out of order");
  }
  return item;
}

void Ledger::for_each_mark(const std::function<void(const LedgerMark&)>& visit) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_, std::string(kMarkColumns) + "ORDER BY number");
  while (row.step()) visit(mark_in(row));
}

void Ledger::for_each_run(const std::function<void(const LedgerRun&)>& visit) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_,
                      "SELECT id, verb, command, directory, version, started, ended, outcome "
                      "FROM runs ORDER BY id");
  while (row.step()) {
    visit({row.number_at(0), row.text_at(1), row.text_at(2), row.text_at(3), row.text_at(4),
           row.text_at(5), row.text_at(6), row.text_at(7)});
  }
}

void Ledger::for_each_result(const std::function<void(const LedgerResult&)>& visit) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_,
                      "SELECT run, place, file, status, line FROM results ORDER BY run, place");
  while (row.step()) {
    visit({row.number_at(0), static_cast<std::uint64_t>(row.number_at(1)), row.text_at(2),
           row.text_at(3), row.text_at(4)});
  }
}

void Ledger::for_each_shape(const std::function<void(const LedgerShape&)>& visit) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_, "SELECT input_hash, bytes FROM shapes ORDER BY input_hash");
  while (row.step()) visit({row.text_at(0), row.text_at(1)});
}

void Ledger::for_each_state(const std::function<void(const LedgerState&)>& visit) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_, std::string(kStateColumns) + "ORDER BY target");
  while (row.step()) visit(state_in(row));
}

void Ledger::for_each_state(std::int64_t run,
                            const std::function<void(const LedgerState&)>& visit) const {
  const std::lock_guard lock(database_->mutex);
  LedgerStatement row(*database_, std::string(kStateColumns) + "WHERE run = ? ORDER BY target");
  row.number(run);
  while (row.step()) visit(state_in(row));
}

bool is_ledger_file(const fs::path& path) {
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  std::ifstream stream(path, std::ios::binary);
  std::string start(kMagic.size(), '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  return stream.gcount() == static_cast<std::streamsize>(kMagic.size()) && start == kMagic;
}

}  // namespace triglyph
