#include "engine/marking/trace_file.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/stop.h"
#include "engine/marking/readable.h"

namespace triglyph {
namespace {

bool has_flux(std::span<const Encoding> encodings) {
  return std::any_of(encodings.begin(), encodings.end(),
                     [](const Encoding& encoding) { return encoding.scheme == kFluxScheme; });
}

// Returns the best names of one group.
std::vector<Traced> trace_group(const Surface& surface, const Key& key,
                                const Suspects::Prepared& prepared, FluxEffort effort,
                                std::size_t most) {
  const std::vector<ScoreTable> tables =
      read_fingerprints(surface, key, prepared.code, prepared.group.encodings, effort);
  std::vector<Traced> traced;
  for (Scored& scored : best_of(tables, prepared.code, prepared.seeds, most)) {
    traced.push_back({prepared.group.names[scored.name], 0, std::move(scored.evidence), 0});
  }
  return traced;
}

}  // namespace

Suspects::Suspects(const Key& key, std::vector<SuspectGroup> groups) : key_(key) {
  for (SuspectGroup& group : groups) {
    FingerprintCode code(key, group.colluders);
    std::vector<FingerprintSeed> seeds = seeds_of(code, group.names);
    groups_.push_back({std::move(group), std::move(code), std::move(seeds)});
  }
}

std::size_t Suspects::count() const {
  return std::accumulate(
      groups_.begin(), groups_.end(), std::size_t{0},
      [](std::size_t sum, const Prepared& group) { return sum + group.seeds.size(); });
}

FileTrace trace_file(const std::filesystem::path& path, std::span<const Suspects> suspects,
                     const TraceOptions& options) {
  const Readable readable(path);
  FileTrace trace;
  trace.vertices = readable.file.vertex_count();
  trace.faces = readable.file.face_count();
  constexpr double kRounds = 2;  // with more and more effort
  double tried = kRounds * options.files;
  double names = 0;
  for (const Suspects& each : suspects) names += static_cast<double>(each.count());
  tried *= std::max(1.0, names);
  for (const FluxEffort effort : {FluxEffort::AsItIs, FluxEffort::All}) {
    std::vector<Traced> found;
    bool tries_more = false;
    for (std::size_t key = 0; key < suspects.size(); ++key) {
      for (const Suspects::Prepared& group : suspects[key].groups()) {
        stop_point();
        tries_more = tries_more || has_flux(group.group.encodings);
        for (Traced& traced : trace_group(readable.surface(), suspects[key].key(), group, effort,
                                          options.most_names)) {
          traced.key = key;
          traced.false_alarm_log2 = std::min(0.0, std::log2(tried) - traced.evidence.bits);
          found.push_back(std::move(traced));
        }
      }
    }
    std::stable_sort(found.begin(), found.end(), [](const Traced& a, const Traced& b) {
      return a.evidence.bits > b.evidence.bits;
    });
    if (found.size() > options.most_names) found.resize(options.most_names);
    trace.names = std::move(found);
    const bool is_sure = !trace.names.empty() && options.believes(trace.names[0]);
    if (is_sure || !tries_more) break;
  }
  return trace;
}

}  // namespace triglyph
