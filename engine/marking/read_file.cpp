#include "engine/marking/read_file.h"

#include <algorithm>

#include "engine/marking/extract.h"
#include "engine/marking/readable.h"

namespace triglyph {

FileReading read_file(const std::filesystem::path& path, std::span<const Encoding> encodings,
                      std::span<const Key> keys) {
  const Readable readable(path);
  FileReading reading;
  reading.vertices = readable.file.vertex_count();
  reading.faces = readable.file.face_count();
  for (const ReadEffort effort : {ReadEffort::Direct, ReadEffort::Correct}) {
    for (const Encoding& encoding : encodings) {
      if (effort == ReadEffort::Correct && encoding.format.is_spread) continue;  // nothing is left
      for (std::size_t key = 0; key < keys.size(); ++key) {
        Extraction found = extract(readable.surface(), encoding, keys[key], effort);
        reading.false_alarm += found.false_alarm;
        const auto units = static_cast<std::uint32_t>(found.readings.size());
        reading.units_with_marker = std::max(reading.units_with_marker, units);
        if (!found.message && !found.flux) continue;
        if (found.message && !found.flux) reading.units_with_marker = units;
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
