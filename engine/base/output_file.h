// Atomic file output: the bytes are written under a temporary name in the same directory, and the
// file is renamed when it is complete.
#pragma once

#include <filesystem>
#include <span>

namespace triglyph {

class OutputFile {
 public:
  // Creates missing directories and the temporary file ".<stem>.<unique>.part<extension>", which
  // keeps the extension so that readers recognise the format. Throws Error Unwritable.
  explicit OutputFile(const std::filesystem::path& path);

  // Removes the temporary file unless it was committed.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  // Appends the bytes. Throws Error Unwritable, also if the disk is full.
  void write(std::span<const char> bytes);

  // Returns the path that holds the bytes until commit(). What was written can be read there.
  [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_; }

  // Flushes to disk and renames to the final path, replacing an existing file. Throws Error
  // Unwritable.
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

}  // namespace triglyph
