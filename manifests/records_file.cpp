#include "manifests/records_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "manifests/json_line.h"
#include "manifests/ledger.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// A line of the file.
struct Place {
  std::uint64_t place = 0;
  std::uint64_t begin = 0;
  std::uint64_t size = 0;  // without the newline
};

[[noreturn]] void fail_to_write(const fs::path& path) {
  throw Error(ErrorCode::Unwritable, path, "",
              "the record cannot be written: " + system_reason(errno == 0 ? EIO : errno));
}

// Returns the place in the run that a line of this file ends with, `"place":7}}`.
std::uint64_t place_in(const std::string& line) {
  constexpr std::string_view kKey = "\"place\":";
  const std::size_t key = line.rfind(kKey);
  std::uint64_t place = 0;
  if (key != line.npos) {
    const char* end = line.data() + line.size();
    const auto [rest, error] = std::from_chars(line.data() + key + kKey.size(), end, place);
    if (error == std::errc() && std::string_view(rest, end) == "}}") return place;
  }
  return parse_record(line).index;
}

// Returns the lines ascending by place, the last one of each place.
std::vector<Place> sorted_lines(std::istream& stream) {
  std::vector<Place> lines;
  std::string line;
  std::uint64_t begin = 0;
  while (read_line(stream, line)) {
    lines.push_back({place_in(line), begin, line.size()});
    begin += line.size() + 1;
  }
  const auto by_place = [](const Place& a, const Place& b) { return a.place < b.place; };
  std::stable_sort(lines.begin(), lines.end(), by_place);
  std::vector<Place> last;
  for (const Place& one : lines) {
    if (!last.empty() && last.back().place == one.place) last.pop_back();
    last.push_back(one);
  }
  return last;
}

std::function<std::optional<Record>()> lines_of_records(const fs::path& path) {
  struct Source {
    std::ifstream stream;
    std::size_t number = 0;
  };
  auto source = std::make_shared<Source>();
  source->stream.open(path, std::ios::binary);
  if (fs::is_directory(path) || !source->stream) {
    throw Error(ErrorCode::Unreadable, path, "", "the records cannot be read");
  }
  if (source->stream.peek() == std::ifstream::traits_type::eof()) {
    throw Error(ErrorCode::Malformed, path, "", "holds no records");
  }
  return [source, path]() -> std::optional<Record> {
    std::string line;
    ++source->number;
    try {
      if (!read_line(source->stream, line)) return std::nullopt;
      return parse_record(line);
    } catch (const Error& error) {
      throw Error(error.code(), path, at_line(source->number), error.message());
    }
  };
}

std::function<std::optional<Record>()> items_of_ledger(const fs::path& path) {
  auto ledger = std::make_shared<const Ledger>(path);
  auto last = std::make_shared<std::string>();
  return [ledger, last]() -> std::optional<Record> {
    std::optional<LedgerItem> item = ledger->find_after(*last);
    if (!item) return std::nullopt;
    *last = std::move(item->target);
    return parse_record(item->record);
  };
}

// Removes what stands after the last newline: a worker died while it wrote that.
void cut_off_torn_line(const fs::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(ErrorCode::Unwritable, path, "", system_reason(errno));
  std::string line;
  std::uint64_t end = 0;  // of the whole lines
  while (read_line(stream, line) && !stream.eof()) end += line.size() + 1;
  std::error_code error;
  fs::resize_file(path, end, error);
  if (error) throw Error(ErrorCode::Unwritable, path, "", error.message());
}

}  // namespace

void check_holds_records(const fs::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(ErrorCode::Unwritable, path, "", system_reason(errno));
  std::string line;
  try {
    if (!read_line(stream, line)) return;
    if (stream.eof() && line.starts_with("{\"schema\":")) return;
    (void)parse_record(line);
  } catch (const Error&) {
    throw Error(ErrorCode::Usage, path, "",
                "holds something other than records, which would be lost; name another file");
  }
}

RecordsFile::RecordsFile(const fs::path& path, bool append) : path_(path) {
  std::error_code ignored;
  if (fs::is_regular_file(path, ignored)) {
    check_holds_records(path);
    remove_leftovers(path.parent_path());
    if (append) cut_off_torn_line(path);
  }
  errno = 0;
  stream_.open(path, std::ios::binary | (append ? std::ios::app : std::ios::trunc));
  if (!stream_) throw Error(ErrorCode::Unwritable, path, "", system_reason(errno));
}

void RecordsFile::write(const Record& record) {
  errno = 0;
  stream_ << line_of(record) << std::flush;
  if (!stream_) fail_to_write(path_);
}

void RecordsFile::finish() {
  errno = 0;
  stream_.close();
  if (!stream_) fail_to_write(path_);
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (status.type() == fs::file_type::none) {
    throw Error(ErrorCode::Unwritable, path_, "", "the records: " + error.message());
  }
  if (!fs::is_regular_file(status)) return;  // a pipe has its order
  std::ifstream stream(path_, std::ios::binary);
  if (!stream) fail_to_write(path_);
  const std::vector<Place> lines = sorted_lines(stream);
  std::uint64_t end = 0;  // of the lines so far, if they lie as they should
  for (const Place& line : lines) end = line.begin == end ? end + line.size + 1 : ~std::uint64_t{0};
  const std::uint64_t size = fs::file_size(path_, error);  // on a failure as large as no end is
  if (error) throw Error(ErrorCode::Unwritable, path_, "", "the records: " + error.message());
  if (end == size) return;
  OutputFile sorted(path_);
  std::string text;
  stream.clear();
  for (const Place& line : lines) {
    text.resize(line.size);
    stream.seekg(static_cast<std::streamoff>(line.begin));
    if (!stream.read(text.data(), static_cast<std::streamsize>(line.size))) fail_to_write(path_);
    text += '\n';
    sorted.write(text);
  }
  sorted.commit();
}

std::function<std::optional<Record>()> record_source(const fs::path& path) {
  return is_ledger_file(path) ? items_of_ledger(path) : lines_of_records(path);
}

fs::path resolved(const fs::path& name, const Record& record) {
  if (name.is_absolute() || record.directory.empty()) return name;
  std::error_code ignored;
  fs::path there = fs::path(record.directory) / name;
  return fs::exists(there, ignored) ? there : name;
}

}  // namespace triglyph
