#include "engine/io/file_bytes.h"

#include <cerrno>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/base/error.h"
#include "engine/base/parallel.h"

namespace triglyph {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) noexcept : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

// Large enough that a call of the system costs little, small enough for all threads to help and for
// a run to stop soon.
constexpr std::size_t kBytesPerTask = std::size_t{1} << 22;

[[noreturn]] void refuse_file(const std::filesystem::path& path, const std::string& reason) {
  throw Error(ErrorCode::Unreadable, path, "", reason);
}

struct stat status_of(int descriptor, const std::filesystem::path& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) refuse_file(path, "cannot stat: " + system_reason(errno));
  return status;
}

std::size_t size_of(int descriptor, const std::filesystem::path& path) {
  return static_cast<std::size_t>(status_of(descriptor, path).st_size);
}

// Reads bytes of the file from an offset on; the system may deliver them in pieces.
void fill_from(int descriptor, std::size_t offset, std::span<char> bytes,
               const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t count =
        ::pread(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse_file(path, "cannot read: " + system_reason(errno));
    if (count == 0) refuse_file(path, "was truncated while it was read");
    offset += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

}  // namespace

FileBytes FileBytes::open(const std::filesystem::path& path) {
  // O_NONBLOCK: opening a pipe without a writer would otherwise wait for ever.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (file.number() < 0) refuse_file(path, "cannot open: " + system_reason(errno));
  const struct stat status = status_of(file.number(), path);
  if (S_ISDIR(status.st_mode)) refuse_file(path, "is a directory, not a regular file");
  if (!S_ISREG(status.st_mode)) refuse_file(path, "is not a regular file");
  if (status.st_size == 0) refuse_file(path, "is empty");
  const auto size = static_cast<std::size_t>(status.st_size);
  return read(file.number(), size, path);
}

FileBytes FileBytes::read(int descriptor, std::size_t size, const std::filesystem::path& path) {
  FileBytes file;
  file.data_ = std::make_unique_for_overwrite<char[]>(size);
  file.size_ = size;
  parallel_blocks(
      size,
      [&](std::size_t begin, std::size_t end) {
        fill_from(descriptor, begin, {file.data_.get() + begin, end - begin}, path);
      },
      kBytesPerTask);
  if (size_of(descriptor, path) > size) refuse_file(path, "grew while it was read");
  return file;
}

}  // namespace triglyph
