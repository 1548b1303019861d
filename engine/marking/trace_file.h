// Tracing: whose copy a mesh file is, of all who may have one.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/once.h"
#include "engine/marking/options.h"
#include "engine/mesh/mesh.h"
#include "engine/message/fingerprint.h"
#include "engine/trace/suspects.h"

namespace triglyph {

// A mesh of which the suspect may be a copy. Loaded when it is needed, once.
class OriginalMesh {
 public:
  // `strength` is that of the copies.
  OriginalMesh(std::filesystem::path path, Strength strength)
      : path_(std::move(path)), strength_(strength) {}

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] Strength strength() const { return strength_; }
  // Throws Error as MeshFile::open() does.
  [[nodiscard]] const Mesh& mesh() const;

 private:
  std::filesystem::path path_;
  Strength strength_;
  Once<Mesh> mesh_;
};

// Shapes of originals that are not at hand; see KeptShape. There may be thousands, of which one at
// a time is in memory.
class KeptShapes {
 public:
  virtual ~KeptShapes() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  // Returns the bytes of a shape. May be called from several threads at a time.
  [[nodiscard]] virtual std::vector<char> bytes(std::size_t index) const = 0;
};

// Names whose fingerprints have the same code, and how these are encoded.
struct SuspectGroup {
  int colluders = 1;
  std::vector<Encoding> encodings;  // in formats of fingerprints; none: read with originals alone
  std::vector<Message> names;
  std::vector<std::shared_ptr<const OriginalMesh>> originals;
  std::shared_ptr<const KeptShapes> shapes = {};  // null: none
};

// Names under one key, made ready once for any number of files.
class Suspects {
 public:
  // Throws Error Usage for a number of colluders out of range. O(names), parallel.
  Suspects(const Key& key, std::vector<SuspectGroup> groups);

  [[nodiscard]] const Key& key() const { return key_; }
  [[nodiscard]] std::size_t count() const;  // of names in all groups

  struct Prepared {
    SuspectGroup group;
    FingerprintCode code;
    std::vector<FingerprintSeed> seeds;
  };
  [[nodiscard]] std::span<const Prepared> groups() const { return groups_; }

 private:
  Key key_;
  std::vector<Prepared> groups_;
};

// A name, and what speaks for it.
struct Traced {
  Message name;
  std::size_t key = 0;  // index of its suspects
  NameEvidence evidence;
  // Binary logarithm of an upper bound of the probability that evidence so strong speaks for any of
  // the names that have nothing to do with the file; 0 at most.
  double false_alarm_log2 = 0;
};

struct FileTrace {
  std::vector<Traced> names;  // that are believed or not; the best first, and not more than wanted
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
};

struct TraceOptions {
  double false_alarm = 1e-9;    // a bound at which a name is believed: no more is tried then
  std::size_t most_names = 16;  // that are returned
  double files = 1;             // that are traced together: each pays for all

  [[nodiscard]] bool believes(const Traced& traced) const {
    return std::exp2(traced.false_alarm_log2) <= false_alarm;
  }
};

// Returns the names for which most speaks. With originals, the suspect is brought to the place of
// each, see align(): what was cut off is completed for the flux layer, and displacements of points
// are read. Where that names nobody, the flux layer is also completed by those of the shapes that
// share landmarks with the suspect, or in whose box it lies. An original that cannot be read, or to
// which the suspect cannot be brought, tells nothing. Each bound pays for all names, keys, groups,
// originals, shapes and files, and for all that a reader tries. Throws Error as MeshFile::open()
// does. O(triangles) for each encoding and key, and O(names); see read_fingerprints() and
// best_of().
[[nodiscard]] FileTrace trace_file(const std::filesystem::path& path,
                                   std::span<const Suspects> suspects, const TraceOptions& options);

}  // namespace triglyph
