#include "engine/marking/verify_file.h"

#include <algorithm>

#include "engine/base/error.h"
#include "engine/marking/extract.h"
#include "engine/marking/readable.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

// Returns the number of units with one of the words, at any anchor.
std::uint32_t count_words(const WordCode& code, std::span<const Word> words,
                          std::span<const Reading> readings) {
  return static_cast<std::uint32_t>(
      std::count_if(readings.begin(), readings.end(), [&](const Reading& reading) {
        const std::uint32_t index = code.part_index(reading.word.subscript);
        return index < words.size() && words[index] == reading.word;
      }));
}

std::vector<std::uint32_t> anchors_not_among(std::span<const Carrier> expected,
                                             std::span<const Carrier> found) {
  std::vector<std::uint32_t> anchors;
  auto next = found.begin();
  for (const Carrier& carrier : expected) {
    if (next != found.end() && *next == carrier) {
      ++next;
    } else {
      anchors.push_back(carrier.anchor);
    }
  }
  return anchors;
}

std::vector<std::uint64_t> vertices_of(const MeshFile& file, const PointLists& lists) {
  std::vector<char> touched(file.mesh().positions.size(), 0);
  for (const std::uint32_t point : lists.points) touched[point] = 1;
  std::vector<std::uint64_t> vertices;
  const auto points = file.point_of_vertex();
  for (std::size_t vertex = 0; vertex < points.size(); ++vertex) {
    if (touched[points[vertex]] != 0) vertices.push_back(vertex);
  }
  return vertices;
}

// Returns nothing if the mesh is numbered differently from the one written, whose indices anchors
// are.
std::optional<Damage> damage_of(const MarkedFile& marked, const Readable& readable,
                                const BoundScheme& scheme, std::span<const Word> words,
                                std::span<const Reading> readings, std::uint32_t units_found,
                                bool locate) {
  const bool same_size = readable.file.mesh().positions.size() == marked.points &&
                         readable.file.face_count() == marked.faces;
  if (!marked.units || !same_size) return std::nullopt;
  const std::vector<Carrier> intact = carriers_read(*marked.units, words, readings);
  if (2 * intact.size() < units_found) return std::nullopt;
  const std::vector<std::uint32_t> damaged = anchors_not_among(*marked.units, intact);
  Damage damage;
  damage.units_expected = static_cast<std::uint32_t>(marked.units->size());
  damage.units_damaged = static_cast<std::uint32_t>(damaged.size());
  if (locate && !damaged.empty()) {
    damage.vertices = vertices_of(readable.file, scheme.points_of(damaged));
  }
  return damage;
}

// Says whether the surface carries the flux layer that was written; a word that is known needs less
// evidence than one that is read.
bool carries(const FluxMark& mark, const Surface& surface, const Key& key) {
  const BlockCode code(key, mark.payload.content, mark.payload.bits);
  return flux_evidence(surface, key, code.encode(mark.payload.value)).evidence >= kBelieved;
}

// Says whether the surface carries the fingerprint that was written: one name is tried.
bool carries_fingerprint(const MarkedFile& marked, const Surface& surface, const Key& key) {
  std::optional<Mesh> original;
  if (marked.needs_original) original = MeshFile::open(marked.mesh).mesh();
  for (const FluxEffort effort : {FluxEffort::AsItIs, FluxEffort::All}) {
    if (fingerprint_evidence(marked, surface, original, key, effort) >= kBelieved) return true;
    if (!marked.flux) break;
  }
  return false;
}

// Fills in the verdict and its reason.
void judge(const Readable& readable, const MarkedFile& marked, const Key& key, bool carries_mark,
           Verification& result) {
  if (!carries_mark) {
    result.verdict = FileVerdict::Lost;
    result.detail = marked.key_fingerprint == key.fingerprint()
                        ? std::string(marked.status == FileStatus::Traceable ? "the fingerprint"
                                                                             : "the message") +
                              " is not in the file"
                        : "marked under another key, " + marked.key_fingerprint;
  } else if (content_hash(readable.file.bytes()) != marked.output_hash) {
    result.verdict = FileVerdict::Altered;
    result.detail = "the bytes differ from those written";
  } else {
    result.verdict = FileVerdict::Intact;
  }
}

}  // namespace

std::string_view name_of(FileVerdict verdict) {
  switch (verdict) {
    case FileVerdict::Intact:
      return "intact";
    case FileVerdict::Altered:
      return "altered, mark present";
    case FileVerdict::Missing:
      return "missing";
    case FileVerdict::Lost:
      return "mark lost";
    case FileVerdict::Damaged:
      return "damaged";
    case FileVerdict::NotMarked:
      return "not marked";
  }
  return "";
}

Verification verify_file(const MarkedFile& marked, const Key& key, bool locate) {
  Verification result;
  if (!marked.is_marked()) {
    result.detail = "the mesh was not marked: " + std::string(name_of(marked.status));
    return result;
  }
  if (!std::filesystem::exists(marked.out)) {
    result.verdict = FileVerdict::Missing;
    result.detail = marked.out.string() + ": no such file";
    return result;
  }
  try {
    const Readable readable(marked.out);
    const bool right_key = marked.key_fingerprint == key.fingerprint();
    if (marked.status == FileStatus::Traceable) {
      judge(readable, marked, key, carries_fingerprint(marked, readable.surface(), key), result);
      return result;
    }
    const bool carries_flux = marked.flux && carries(*marked.flux, readable.surface(), key);
    if (marked.parts == 0) {
      judge(readable, marked, key, carries_flux, result);
      return result;
    }
    const Encoding encoding = marked.encoding();
    const WordCode code(key, encoding.format);
    const auto scheme = make_scheme(encoding.scheme, code, encoding.scheme_options);
    const auto bound = scheme->bind(readable.surface());
    const Extraction found = extract(*bound, code, doubtful_parts(encoding.scheme_options));
    const MarkRequest& request = marked.request;
    const std::vector<Word> words = request.is_fill()
                                        ? code.fill_words(marked.parts)
                                        : code.words_of(request.message(), marked.parts);
    result.units_found = count_words(code, words, found.readings);
    const bool carries_units = request.is_fill() ? 2 * result.units_found > marked.units_embedded
                                                 : found.message == request.message();
    if (right_key) {
      result.damage =
          damage_of(marked, readable, *bound, words, found.readings, result.units_found, locate);
    }
    if (result.damage) {
      result.units_found = result.damage->units_expected - result.damage->units_damaged;
    }
    judge(readable, marked, key, carries_units || carries_flux, result);
    if (carries_units != carries_flux && marked.flux) {
      result.detail += std::string(result.detail.empty() ? "" : "; ") + "only the " +
                       (carries_flux ? "flux layer" : "layer of units") + " can be read";
    }
  } catch (const Error& error) {
    result.verdict = FileVerdict::Damaged;
    result.detail = error.what();
  }
  return result;
}

}  // namespace triglyph
