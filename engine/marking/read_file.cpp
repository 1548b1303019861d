#include "engine/marking/read_file.h"

#include <algorithm>

#include "engine/marking/extract.h"
#include "engine/marking/readable.h"

namespace triglyph {
namespace {

// What corrects raises the probability of a false alarm: flux by 2^-32 in all, a spread message by
// 2^-28 for each attempt, the others by 2^-27 or more.
std::vector<Encoding> in_order(std::span<const Encoding> encodings, ReadEffort effort) {
  std::vector<Encoding> ordered(encodings.begin(), encodings.end());
  if (effort == ReadEffort::Direct) return ordered;
  const auto place = [](const Encoding& encoding) {
    return encoding.scheme == kFluxScheme ? 0 : encoding.format.is_spread ? 1 : 2;
  };
  std::stable_sort(ordered.begin(), ordered.end(),
                   [&](const Encoding& a, const Encoding& b) { return place(a) < place(b); });
  return ordered;
}

}  // namespace

FileReading read_file(const std::filesystem::path& path, std::span<const Encoding> encodings,
                      std::span<const Key> keys) {
  const Readable readable(path);
  FileReading reading;
  reading.vertices = readable.file.vertex_count();
  reading.faces = readable.file.face_count();
  for (const ReadEffort effort : {ReadEffort::Direct, ReadEffort::Correct}) {
    for (const Encoding& encoding : in_order(encodings, effort)) {
      for (std::size_t key = 0; key < keys.size(); ++key) {
        Extraction found = extract(readable.surface(), encoding, keys[key], effort);
        reading.false_alarm += found.false_alarm;
        const auto units = static_cast<std::uint32_t>(found.readings.size());
        reading.units_with_marker = std::max(reading.units_with_marker, units);
        if (!found.message && !found.flux) continue;
        if (!found.flux) reading.units_with_marker = units;  // those of the mark alone
        reading.mark = FoundMark{found.message.value_or(Message{}),
                                 encoding,
                                 key,
                                 found.parts,
                                 found.agreeing,
                                 found.flux ? 1 : found.agreement,
                                 std::move(found.flux)};
        return reading;
      }
    }
  }
  return reading;
}

}  // namespace triglyph
