// A mesh file as marking loads it, alone or for several copies.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "engine/base/once.h"
#include "engine/io/mesh_file.h"
#include "engine/marking/marking.h"
#include "engine/marking/options.h"
#include "engine/mesh/surface.h"
#include "engine/message/key.h"

namespace triglyph {

// Digits more than a file's that moved coordinates get at most without being asked for.
inline constexpr int kMostDigits = 8;

struct LoadedMesh {
  MeshFile file;
  Halfedges halfedges;
  std::string hash;  // of the file's bytes

  // Throws Error as MeshFile::open() does.
  [[nodiscard]] static std::shared_ptr<LoadedMesh> open(const std::filesystem::path& path);
  [[nodiscard]] Surface surface() const { return {file.mesh(), halfedges}; }
  // Returns what takes points to what the file can hold, and what cuts its polygons; empty without
  // polygons. The mesh must outlive them.
  [[nodiscard]] Rounding rounding() const;
  [[nodiscard]] Recut recut() const;
};

// A mesh of which several copies are marked, loaded and planned when the first copy needs it. May
// be used from several threads at a time; the others wait for the first.
class MeshOfCopies {
 public:
  MeshOfCopies();
  ~MeshOfCopies();

  // Returns the file's mesh, whose numbers must not be changed. The path is the same in every call.
  // Throws as LoadedMesh::open() does, in every call.
  [[nodiscard]] std::shared_ptr<LoadedMesh> loaded(const std::filesystem::path& path) const;

  // Marks the loaded mesh; see CopyPlan::copy(). Key and options are the same in every call.
  [[nodiscard]] Marking copy(const Message& name, const MarkOptions& options, const Key& key) const;

  // Returns the digits that moved coordinates have more than the file's; after a copy was marked.
  [[nodiscard]] int digits() const;

 private:
  struct Planned;
  Once<std::shared_ptr<LoadedMesh>> loaded_;
  Once<std::unique_ptr<Planned>> planned_;
};

}  // namespace triglyph
