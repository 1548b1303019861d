#include "manifests/suspects_of.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "engine/base/error.h"
#include "engine/marking/copies.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

// Returns the options of marks as the ledger keeps them.
MarkOptions options_in(const std::string& text, const std::string& scheme) {
  OptionValues values;
  const auto json = parse_json_line(text);
  for (const auto& [key, value] : json.items()) {
    if (find_mark_option(key) != nullptr) values.emplace(key, option_value(key, value));
  }
  values["scheme"] = scheme;
  values["message"] = std::string("any");
  values.erase("fill");
  return resolve(values).options;
}

std::string bytes_of(const std::string& hex) {
  const std::vector<std::uint8_t> bytes = from_hex(hex);
  return {bytes.begin(), bytes.end()};
}

// Adds encodings that are not there yet.
void add(std::vector<Encoding>& encodings, std::vector<Encoding> others) {
  for (Encoding& other : others) {
    if (std::find(encodings.begin(), encodings.end(), other) == encodings.end()) {
      encodings.push_back(std::move(other));
    }
  }
}

// The shapes that a ledger keeps of some meshes.
class ShapesInLedger final : public KeptShapes {
 public:
  ShapesInLedger(const Ledger& ledger, std::vector<std::string> hashes)
      : ledger_(ledger), hashes_(std::move(hashes)) {}
  [[nodiscard]] std::size_t size() const override { return hashes_.size(); }
  [[nodiscard]] std::vector<char> bytes(std::size_t index) const override {
    const std::optional<LedgerShape> shape = ledger_.shape_of(hashes_.at(index));
    if (!shape) return {};
    return {shape->bytes.begin(), shape->bytes.end()};
  }

 private:
  const Ledger& ledger_;
  std::vector<std::string> hashes_;  // of the meshes
};

// Names that are looked for together.
struct Group {
  std::vector<std::string> names;
  std::vector<Encoding> encodings;
  std::optional<Strength> strength;  // of displaced points
  std::set<std::string> meshes;      // hashes of those with a flux layer
};

// The groups of one key, by the colluders that their fingerprints resist and by the original
// without which these cannot be read.
using Groups = std::map<std::pair<int, std::string>, Group>;

// Gathers the marks of a ledger.
class MarksInLedger {
 public:
  void add_mark(const LedgerMark& mark) {
    if (mark.message_hex.empty()) return;  // fill
    const MarkOptions& options = options_of(mark);
    const auto colluders = static_cast<int>(options.collusion);
    const bool needs_original = mark.scheme == kPointsScheme;
    if (options.carry != Carry::Whole) {
      Group& group = groups_[mark.key][{colluders, needs_original ? mark.mesh : ""}];
      group.names.push_back(bytes_of(mark.message_hex));
      if (needs_original) group.strength = options.strength;
      if (!needs_original && options.flux != LayerUse::No) group.meshes.insert(mark.input_hash);
      if (is_new_ && !needs_original) add(group.encodings, fingerprint_encodings(options));
    }
    if (options.carry != Carry::Fingerprint && is_new_) {
      if (options.units != LayerUse::No) add(encodings_, {options.encoding()});
      if (options.flux != LayerUse::No) add(encodings_, {{std::string(kFluxScheme), {}, {}}});
    }
  }

  [[nodiscard]] Groups take(const Key& key) { return std::move(groups_[key.fingerprint()]); }
  [[nodiscard]] std::vector<Encoding> encodings() && { return std::move(encodings_); }

 private:
  // Marks have the same options by the thousand.
  const MarkOptions& options_of(const LedgerMark& mark) {
    const auto [known, is_new] = options_.try_emplace({mark.key, mark.scheme, mark.options});
    const bool has_layers = mark.scheme != kPointsScheme;
    if (is_new) known->second = options_in(mark.options, has_layers ? mark.scheme : "auto");
    is_new_ = is_new;
    return known->second;
  }

  std::map<std::array<std::string, 3>, MarkOptions> options_;
  bool is_new_ = false;  // were the last options
  std::map<std::string, Groups> groups_;
  std::vector<Encoding> encodings_;
};

}  // namespace

KnownCopies known_copies(const Ledger* ledger, const Recipients* list,
                         std::span<const MarkOptions> options, std::span<const Key> keys,
                         std::span<const std::filesystem::path> originals) {
  MarksInLedger marks;
  if (ledger != nullptr) {
    ledger->for_each_mark([&](const LedgerMark& mark) { marks.add_mark(mark); });
  }
  std::vector<std::shared_ptr<const OriginalMesh>> named;
  for (const std::filesystem::path& path : originals) {
    named.push_back(std::make_shared<OriginalMesh>(path, Strength::Normal));
    (void)named.back()->mesh();  // what the user names must be there
  }
  KnownCopies known;
  for (const Key& key : keys) {
    Groups groups = marks.take(key);
    if (list != nullptr) {
      for (const MarkOptions& each : options) {
        Group& group = groups[{static_cast<int>(each.collusion), ""}];
        for (const Recipient& recipient : *list) group.names.push_back(recipient.name);
        add(group.encodings, fingerprint_encodings(each));
      }
    }
    std::vector<SuspectGroup> listed;
    for (auto& [what, group] : groups) {
      const auto& [colluders, original] = what;
      SuspectGroup& one = listed.emplace_back();
      one.colluders = colluders;
      one.encodings = std::move(group.encodings);
      std::sort(group.names.begin(), group.names.end());
      group.names.erase(std::unique(group.names.begin(), group.names.end()), group.names.end());
      for (const std::string& name : group.names) one.names.emplace_back(name.begin(), name.end());
      one.originals = named;
      std::vector<std::string> kept;
      for (const std::string& mesh : group.meshes) {
        if (ledger->has_shape(mesh)) kept.push_back(mesh);
      }
      if (!kept.empty()) one.shapes = std::make_shared<ShapesInLedger>(*ledger, std::move(kept));
      if (group.strength) {
        one.originals = {std::make_shared<OriginalMesh>(original, *group.strength)};
      }
    }
    known.suspects.emplace_back(key, std::move(listed));
  }
  known.encodings = std::move(marks).encodings();
  return known;
}

}  // namespace triglyph
