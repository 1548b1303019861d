// Atomic file output: the bytes are written under a temporary name in the same directory, and the
// file is renamed when it is complete.
//
// The order is: write, fdatasync of the file, rename. A file that has its name is therefore whole,
// also after a power failure. The directory is not synchronised: alone that takes 0.1 to 0.7 ms a
// file, and six pairs of runs over 200 meshes of 2,000 triangles on a busy machine differed by -27
// % to 15 %, 3 % in all, which settles nothing. It would save only that after a power failure the
// last names are missing or still those of the former files. The ledger, which compares contents,
// then has these made again.
#pragma once

#include <filesystem>
#include <span>

namespace triglyph {

class OutputFile {
 public:
  // Creates missing directories and the temporary file ".<stem>.<pid>-<n>.part<extension>", which
  // keeps the extension so that readers recognise the format, and stays locked (flock) while it is
  // written. Calls remove_leftovers() for the directory. Throws Error Unwritable.
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

// Removes the temporary files that killed processes left in the directory (the current one if the
// path is empty): those whose names have the form above and that nobody has locked. Does so once in
// the life of the process, since it reads the whole directory, and ignores failures, since
// leftovers are in nobody's way. note: on a network file system whose locks do not reach other
// machines, a file that another machine is writing would be removed too, and its commit() would
// fail.
void remove_leftovers(const std::filesystem::path& parent);

}  // namespace triglyph
