// Lines of records. One that is a record is written and read back as the same.
#include "engine/base/error.h"
#include "manifests/json_line.h"
#include "manifests/record.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  triglyph::Record record;
  try {
    record = triglyph::parse_record(std::string(triglyph::fuzz::text_of(data, size)));
  } catch (const triglyph::Error&) {
    return 0;
  }
  std::string line = triglyph::to_line(triglyph::to_json(record));
  line.pop_back();
  std::string again = triglyph::to_line(triglyph::to_json(triglyph::parse_record(line)));
  again.pop_back();
  triglyph::fuzz::expect(line == again);
  return 0;
}
