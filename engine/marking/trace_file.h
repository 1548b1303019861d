// Tracing: whose copy a mesh file is, of all who may have one.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/message/fingerprint.h"
#include "engine/trace/suspects.h"

namespace triglyph {

// Names whose fingerprints have the same code, and how these are encoded.
struct SuspectGroup {
  int colluders = 1;
  std::vector<Encoding> encodings;  // in formats of fingerprints
  std::vector<Message> names;
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

// Returns the names for which most speaks. Each bound pays for all names, keys, groups and files,
// and for all that a reader tries. Throws Error as MeshFile::open() does. O(triangles) for each
// encoding and key, and O(names); see read_fingerprints() and best_of().
[[nodiscard]] FileTrace trace_file(const std::filesystem::path& path,
                                   std::span<const Suspects> suspects, const TraceOptions& options);

}  // namespace triglyph
