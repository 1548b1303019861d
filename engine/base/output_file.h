// A file that appears whole or not at all: written under a temporary name in the same directory and
// renamed when it is done.
#pragma once

#include <filesystem>
#include <span>

namespace triglyph {

class OutputFile {
 public:
  // Creates missing directories and the temporary file ".<stem>.<unique>.part<extension>".
  // Throws Error Unwritable.
  explicit OutputFile(const std::filesystem::path& path);

  // Removes the temporary file unless it was committed.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  // Appends. Throws Error Unwritable, also on a full disk.
  void write(std::span<const char> bytes);

  // Where the bytes are until commit(); readable once they are written.
  [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_; }

  // Flushes to the disk and renames over whatever stands at `path`. Throws Error Unwritable.
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

}  // namespace triglyph
