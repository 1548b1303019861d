// Read-only memory mapping of a regular file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace triglyph {

class MappedFile {
 public:
  // Maps the file. Throws Error Unreadable, with the reason, if it does not exist, may not be read,
  // is empty or is no regular file; a pipe or device is refused without blocking.
  // note: if another process truncates the file while it is mapped, this process ends with SIGBUS.
  [[nodiscard]] static MappedFile open(const std::filesystem::path& path);

  MappedFile() = default;
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  [[nodiscard]] std::span<const char> bytes() const noexcept { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace triglyph
