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
  for (const Encoding& encoding : encodings) {
    for (std::size_t key = 0; key < keys.size(); ++key) {
      Extraction found = extract(readable.surface(), encoding, keys[key]);
      reading.false_alarm += found.false_alarm;
      const auto units = static_cast<std::uint32_t>(found.readings.size());
      if (found.flux) {
        reading.mark = FoundMark{
            found.message.value_or(Message{}), encoding, key, 0, 0, 1, std::move(found.flux)};
        return reading;
      }
      if (found.message) {
        reading.units_with_marker = units;
        reading.mark =
            FoundMark{std::move(*found.message), encoding, key, found.parts, found.agreeing,
                      found.agreement,           {}};
        return reading;
      }
      reading.units_with_marker = std::max(reading.units_with_marker, units);
    }
  }
  return reading;
}

}  // namespace triglyph
