// ledger_dump FILE: prints the items of a ledger, then its marks, one a line and sorted, without
// what two runs of the same work may have different: numbers, times and the record's "run".
#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "manifests/ledger.h"

namespace {

using triglyph::Ledger;
using triglyph::LedgerItem;
using triglyph::LedgerMark;

std::string record_without_run(const std::string& record) {
  auto json = nlohmann::ordered_json::parse(record);
  json.erase("run");
  return json.dump();
}

void print(const Ledger& ledger) {
  std::string last;
  while (const std::optional<LedgerItem> item = ledger.find_after(last)) {
    std::printf("item %s %s %s %s %s %s %s %llu %s\n", item->target.c_str(), item->source.c_str(),
                item->input_hash.c_str(), item->task.c_str(), item->key.c_str(),
                item->status.c_str(), item->output_hash.c_str(),
                static_cast<unsigned long long>(item->place),
                record_without_run(item->record).c_str());
    last = item->target;
  }
  std::vector<std::string> marks;
  ledger.for_each_mark([&](const LedgerMark& mark) {
    marks.push_back("mark " + mark.out + " " + mark.mesh + " " + mark.message_hex + " " +
                    mark.scheme + " " + mark.options + " " + mark.key + " " + mark.input_hash +
                    " " + mark.output_hash);
  });
  std::sort(marks.begin(), marks.end());
  for (const std::string& mark : marks) std::puts(mark.c_str());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fputs("usage: ledger_dump FILE\n", stderr);
    return 2;
  }
  print(Ledger(argv[1]));
} catch (const std::exception& error) {
  std::fprintf(stderr, "ledger_dump: %s\n", error.what());
  return 1;
}
