// The way of one mesh: load, mark, write, read back, measure. Each stage is a function on the task;
// an error becomes the record's status and the later stages pass the task by.
#pragma once

#include <memory>
#include <optional>

#include "engine/base/output_file.h"
#include "engine/io/mesh_file.h"
#include "engine/marking/extract.h"
#include "engine/mesh/halfedges.h"
#include "manifests/record.h"

namespace triglyph {

struct Task {
  Record record;
  std::optional<MeshFile> file;
  std::optional<Halfedges> halfedges;
  Marking marking;
  std::optional<OutputFile> output;

  explicit Task(Job job) { record.job = std::move(job); }
  [[nodiscard]] bool stands() const { return record.status == Status::Marked; }
};

// Stages run in this order; none throws.
void load(Task& task) noexcept;
void mark(Task& task, const Key& key) noexcept;
void write(Task& task) noexcept;
void read_back(Task& task, const Key& key) noexcept;  // publishes the output if the mark is there
void measure(Task& task) noexcept;                    // and lets go of everything but the record

// A mesh file read under a key, without a record of what it should hold.
struct FileExtraction {
  Extraction extraction;
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
};
[[nodiscard]] FileExtraction extract_file(const std::filesystem::path& path, const Key& key,
                                          const MarkOptions& options);

// Bytes of memory that a mesh of this file size takes at most while it is worked on.
[[nodiscard]] std::uint64_t estimate_memory(std::uint64_t file_bytes, std::string_view extension);

}  // namespace triglyph
