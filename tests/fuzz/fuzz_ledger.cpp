// Ledgers. If the first byte is odd, the rest is the file; otherwise it is a list of changes to a
// file that holds a run, items and marks: two bytes of place, one of length, and as many bytes.
#include <algorithm>
#include <fstream>

#include "engine/base/error.h"
#include "manifests/ledger.h"
#include "tests/fuzz/fuzz.h"

namespace {

using triglyph::Ledger;
using triglyph::fuzz::folder;

void fill(Ledger& ledger) {
  const auto run =
      ledger.begin_run({.verb = "mark", .command = "triglyph mark a", .directory = "/"});
  for (int i = 0; i < 20; ++i) {
    const std::string name = "/a/" + std::to_string(i);
    ledger.put({name, name + ".obj", "i", "t", "k", "marked", "o" + name, "{}", run,
                static_cast<std::uint64_t>(i)},
               triglyph::LedgerMark{.message_hex = "00", .mesh = name, .out = name});
  }
  ledger.end_run(run, "done");
}

std::string valid_ledger() {
  const auto path = folder() / "valid";
  {
    Ledger ledger(path);
    fill(ledger);
  }
  return triglyph::test::read_all(path);
}

std::string changed(std::string bytes, std::string_view changes) {
  while (changes.size() >= 3) {
    const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(changes[at]); };
    const std::size_t place = (byte(0) * 256U + byte(1)) % bytes.size();
    const std::size_t length =
        std::min({std::size_t{byte(2)}, changes.size() - 3, bytes.size() - place});
    bytes.replace(place, length, changes.substr(3, length));
    changes.remove_prefix(3 + length);
  }
  return bytes;
}

void use(const std::filesystem::path& path) {
  Ledger ledger(path);
  std::string last;
  while (const auto item = ledger.find_after(last)) last = item->target;
  ledger.for_each_mark([](const triglyph::LedgerMark&) {});
  ledger.for_each_run([](const triglyph::LedgerRun&) {});
  (void)ledger.find("/a/3");
  (void)ledger.mark_of("o/a/3");
  fill(ledger);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string valid = valid_ledger();
  if (size == 0) return 0;
  const std::string_view rest = triglyph::fuzz::text_of(data + 1, size - 1);
  for (const char* ending : {"", "-wal", "-shm", "-journal"}) {
    std::filesystem::remove(folder() / (std::string("ledger") + ending));
  }
  const auto path =
      folder().write("ledger", data[0] % 2 == 1 ? std::string(rest) : changed(valid, rest));
  try {
    use(path);
  } catch (const triglyph::Error& error) {
    triglyph::fuzz::expect(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}
