#include "manifests/pairs.h"

#include <deque>
#include <iostream>
#include <memory>

#include "engine/base/error.h"
#include "manifests/inputs.h"
#include "manifests/ledger.h"
#include "manifests/records_file.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& word) {
  std::error_code ignored;
  return fs::is_directory(word, ignored);
}

PairSource pairs_of_folders(const std::string& originals, const std::string& marked) {
  auto files = std::make_shared<std::deque<fs::path>>();
  const std::string folder[] = {originals};
  for (fs::path& file : gather_files(folder, std::cin)) files->push_back(std::move(file));
  return [files, originals, marked]() -> std::optional<MeshPair> {
    if (files->empty()) return std::nullopt;
    MeshPair pair;
    pair.original = std::move(files->front());
    files->pop_front();
    pair.name = pair.original.lexically_relative(originals);
    pair.marked = marked / pair.name;
    return pair;
  };
}

PairSource pairs_of_records(const std::string& records) {
  const auto next = record_source(records);
  return [next]() -> std::optional<MeshPair> {
    while (const std::optional<Record> record = next()) {
      if (!record->file.is_marked()) continue;
      const fs::path& out = record->file.out;
      return MeshPair{resolved(record->file.mesh, *record), resolved(out, *record),
                      out.is_absolute() ? out.relative_path() : out};
    }
    return std::nullopt;
  };
}

}  // namespace

bool name_many_pairs(std::span<const std::string> words) {
  return words.size() == 1 || (words.size() == 2 && is_folder(words[0]) && is_folder(words[1]));
}

PairSource pairs_of(std::span<const std::string> words) {
  if (words.size() == 1) return pairs_of_records(words[0]);
  if (words.size() != 2 || is_folder(words[0]) != is_folder(words[1])) {
    throw Error(ErrorCode::Usage, {}, "",
                "two meshes, two folders, or one file of records or ledger are compared");
  }
  if (is_folder(words[0])) return pairs_of_folders(words[0], words[1]);
  auto pair = std::make_shared<std::optional<MeshPair>>(
      MeshPair{words[0], words[1], fs::path(words[1]).filename()});
  return [pair]() { return std::exchange(*pair, std::nullopt); };
}

}  // namespace triglyph
