#include "manifests/suspects_of.h"

#include <algorithm>
#include <map>
#include <set>

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

// The names of one key by the colluders that their fingerprints resist.
struct Group {
  std::set<std::string> names;
  std::vector<Encoding> encodings;
};
using Groups = std::map<int, Group>;

// Gathers the marks of a ledger.
class MarksInLedger {
 public:
  void add_mark(const LedgerMark& mark) {
    if (mark.message_hex.empty()) return;  // fill
    const MarkOptions& options = options_of(mark);
    const auto colluders = static_cast<int>(options.collusion);
    if (options.carry != Carry::Whole) {
      Group& group = groups_[mark.key][colluders];
      group.names.insert(bytes_of(mark.message_hex));
      if (is_new_) add(group.encodings, fingerprint_encodings(options));
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
    if (is_new) known->second = options_in(mark.options, mark.scheme);
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
                         std::span<const MarkOptions> options, std::span<const Key> keys) {
  MarksInLedger marks;
  if (ledger != nullptr) {
    ledger->for_each_mark([&](const LedgerMark& mark) { marks.add_mark(mark); });
  }
  KnownCopies known;
  for (const Key& key : keys) {
    Groups groups = marks.take(key);
    if (list != nullptr) {
      for (const MarkOptions& each : options) {
        Group& group = groups[static_cast<int>(each.collusion)];
        for (const Recipient& recipient : *list) group.names.insert(recipient.name);
        add(group.encodings, fingerprint_encodings(each));
      }
    }
    std::vector<SuspectGroup> listed;
    for (auto& [colluders, group] : groups) {
      SuspectGroup& one = listed.emplace_back();
      one.colluders = colluders;
      one.encodings = std::move(group.encodings);
      for (const std::string& name : group.names) one.names.emplace_back(name.begin(), name.end());
    }
    known.suspects.emplace_back(key, std::move(listed));
  }
  known.encodings = std::move(marks).encodings();
  return known;
}

}  // namespace triglyph
