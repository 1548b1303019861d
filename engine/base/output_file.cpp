#include "engine/base/output_file.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/base/error.h"

namespace triglyph {
namespace {

// Returns a name that is unique among processes and threads that write into one directory.
std::filesystem::path temporary_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};
  std::filesystem::path name = ".";
  name += path.stem();
  name += ".";
  name += std::to_string(getpid());
  name += "-";
  name += std::to_string(counter++);
  name += ".part";
  name += path.extension();
  return path.parent_path() / name;
}

// Returns whether temporary_name() may have made the name: ".<stem>.<pid>-<n>.part<extension>".
bool is_temporary_name(const std::filesystem::path& name) {
  std::string text = name.string();
  constexpr std::string_view kPart = ".part";
  if (!text.ends_with(kPart)) text = name.stem().string();
  if (!text.starts_with('.') || !text.ends_with(kPart)) return false;
  text.resize(text.size() - kPart.size());
  const auto cut_number = [&text](char before) {
    const std::size_t digits = text.find_last_not_of("0123456789") + 1;
    if (digits == text.size() || digits < 2 || text[digits - 1] != before) return false;
    text.resize(digits - 1);
    return true;
  };
  return cut_number('-') && cut_number('.');
}

// Removes the temporary file of a process that is gone: nobody holds its lock.
void remove_if_abandoned(const std::filesystem::path& path) {
  // O_NONBLOCK: a pipe of such a name must not be waited for
  const int file = open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return;
  struct stat status {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && flock(file, LOCK_EX | LOCK_NB) == 0) {
    unlink(path.c_str());
  }
  close(file);
}

// Creates the file and holds a lock on it while it is open. Returns its descriptor, or -1 and
// errno.
int create_locked(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  // Where the file system has no locks, nobody gets one, and nothing is ever taken for a leftover.
  while (file >= 0 && flock(file, LOCK_EX) != 0 && errno == EINTR) continue;
  return file;
}

// Returns whether another process removed the file between its creation and its lock.
bool was_removed(const std::filesystem::path& path) {
  struct stat status {};
  return lstat(path.c_str(), &status) != 0 && errno == ENOENT;
}

}  // namespace

void remove_leftovers(const std::filesystem::path& parent) {
  const std::filesystem::path directory = parent.empty() ? "." : parent;
  static std::mutex mutex;
  static std::set<std::filesystem::path> known;
  std::error_code error;
  // Held until the end: a process with the number of one that was killed makes the same names.
  const std::lock_guard lock(mutex);
  if (!known.insert(std::filesystem::absolute(directory, error)).second) return;
  std::filesystem::directory_iterator it(directory, error);
  for (; !error && it != std::filesystem::directory_iterator(); it.increment(error)) {
    if (is_temporary_name(it->path().filename())) remove_if_abandoned(it->path());
  }
}

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_(path), temporary_(temporary_name(path)) {
  if (path.has_parent_path()) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) fail(error.value());
  }
  remove_leftovers(path.parent_path());
  descriptor_ = create_locked(temporary_);
  while (descriptor_ >= 0 && was_removed(temporary_)) {
    close(descriptor_);
    descriptor_ = create_locked(temporary_);
  }
  if (descriptor_ < 0) fail(errno);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  unlink(temporary_.c_str());
}

void OutputFile::write(std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(written < 0 ? errno : EIO);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void OutputFile::commit() {
  if (fdatasync(descriptor_) != 0) fail(errno);
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(errno);
  close(std::exchange(descriptor_, -1));
}

void OutputFile::fail(int error) const {
  throw Error(ErrorCode::Unwritable, path_, "", system_reason(error));
}

}  // namespace triglyph
