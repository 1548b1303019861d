// The bytes of a regular file, read into memory. A mapping would cost a little less, but if another
// process truncates a mapped file the whole run ends with SIGBUS.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace triglyph {

class FileBytes {
 public:
  // Reads the file. Throws Error Unreadable, with the reason, if it does not exist, may not be
  // read, is empty or is no regular file, or if its size changes meanwhile; a pipe or device is
  // refused without blocking. O(bytes), parallel.
  [[nodiscard]] static FileBytes open(const std::filesystem::path& path);

  // Reads an open file that had `size` bytes; throws as open() does if it has another size by now.
  [[nodiscard]] static FileBytes read(int descriptor, std::size_t size,
                                      const std::filesystem::path& path);

  [[nodiscard]] std::span<const char> bytes() const noexcept { return {data_.get(), size_}; }

 private:
  std::unique_ptr<char[]> data_;
  std::size_t size_ = 0;
};

}  // namespace triglyph
