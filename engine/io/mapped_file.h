// A regular file mapped into memory for reading, released with the object.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace triglyph {

class MappedFile {
 public:
  // Never blocks on a pipe or a device: what is no regular file is refused.
  // Throws Error Unreadable (absent, no permission, not a regular file, empty), with the reason.
  // note: a file that another process shortens while it is mapped ends this process by SIGBUS.
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
