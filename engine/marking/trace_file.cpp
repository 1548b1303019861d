#include "engine/marking/trace_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <unordered_set>
#include <utility>

#include "engine/align/alignment.h"
#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/geometry/box.h"
#include "engine/marking/copies.h"
#include "engine/marking/kept_shape.h"
#include "engine/marking/readable.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/trace/displaced_points.h"

namespace triglyph {
namespace {

bool has_flux(std::span<const Encoding> encodings) {
  return std::any_of(encodings.begin(), encodings.end(),
                     [](const Encoding& encoding) { return encoding.scheme == kFluxScheme; });
}

// A suspect may be a piece of the original, or have been cut otherwise.
constexpr double kMostPointsMore = 2;

// Meshes with more points carry other layers, which need no original.
constexpr double kMostDisplaced = 20'000;

// The points that do not move are sought among so many, and so many ways are tried: a box has 48.
constexpr std::size_t kFewPoints = 64;
constexpr std::size_t kMostWays = 64;

// How far the mark and what happened to it may have moved the surface, as a share of the diagonal.
constexpr double kReachOfSurface = 0.005;
// Likewise a point, in relation to the farthest displacement, and at least.
constexpr double kReachOfPoints = 8;
constexpr double kLeastReachOfPoints = 0.002;

// Reads the flux layer of the original, or of its coarse surface, where it has the suspect's.
void add_flux_of_part(const Mesh& suspect, const Mesh& original, const FluxCanvas& canvas,
                      std::span<const Alignment> alignments, const Key& key, const char* what,
                      std::vector<ScoreTable>& tables) {
  const double reach = kReachOfSurface * box_diagonal(original.positions);
  if (canvas.obstacle() != FluxObstacle::None) return;
  for (const Alignment& alignment : alignments) {
    const auto places = places_on(original, suspect, alignment.motion, reach);
    for (const FluxSoftReading& reading : read_flux_of_estimate(canvas.estimated(places), key)) {
      ScoreTable& table = tables.emplace_back(score_flux(reading, 1));
      table.prior -= std::log2(static_cast<double>(alignments.size()));
      table.what = what;
    }
  }
}

// Reads the displacements of the original's points, with the suspect where it is, where it was
// brought, and where the points are that do not move. Which points these are is tried where there
// are few.
void add_points(const Mesh& suspect, const Mesh& original, std::span<const Alignment> alignments,
                double farthest, std::vector<ScoreTable>& tables) {
  const double reach =
      std::max(kReachOfPoints * farthest, kLeastReachOfPoints * box_diagonal(original.positions));
  std::vector<Similarity> ways = {Similarity()};
  std::vector<Vec3> fixed;
  for (const std::uint32_t point : fixed_points(original.positions)) {
    fixed.push_back(original.positions[point]);
  }
  for (const Alignment& alignment : alignments) {
    ways.push_back(alignment.motion);
    const auto seen = nearest_points({fixed, {}}, suspect, alignment.motion, reach);
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < fixed.size(); ++i) {
      if (seen[i]) pairs.push_back({*seen[i], fixed[i]});
    }
    if (const auto exact = fitted_similarity(pairs)) {
      ways.push_back(combined(alignment.motion, *exact));
    }
  }
  if (suspect.positions.size() <= kFewPoints) {
    for (const Similarity& way : ways_onto(suspect.positions, fixed, kMostWays)) {
      ways.push_back(way);
    }
  }
  for (const Similarity& way : ways) {
    for (ScoreTable& table :
         score_points(original.positions, nearest_points(original, suspect, way, reach), farthest,
                      static_cast<int>(ways.size()))) {
      tables.push_back(std::move(table));
    }
  }
}

// Returns what is read with an original; nothing if the suspect has nothing to do with it.
std::vector<ScoreTable> tables_with(const Mesh& suspect, const OriginalMesh& original,
                                    const Key& key, const SuspectGroup& group) {
  std::vector<ScoreTable> tables;
  const Mesh* mesh = nullptr;
  try {
    mesh = &original.mesh();
  } catch (const Error&) {
    return tables;
  }
  const auto count = static_cast<double>(suspect.positions.size());
  const bool points_alone = group.encodings.empty();
  const auto own = static_cast<double>(mesh->positions.size());
  if (points_alone && (count > kMostPointsMore * own || own > kMostPointsMore * count)) {
    return tables;
  }
  const std::vector<Alignment> alignments = align(suspect, *mesh);
  if (!alignments.empty() && has_flux(group.encodings)) {
    const Halfedges halfedges = build_halfedges(*mesh);
    add_flux_of_part(suspect, *mesh, FluxCanvas({*mesh, halfedges}), alignments, key,
                     "flux, with the original", tables);
  }
  // of large meshes no points are displaced
  if (points_alone || own <= kMostDisplaced) {
    add_points(suspect, *mesh, alignments,
               farthest_of_points(original.strength(), surface_diagonal(*mesh)), tables);
  }
  return tables;
}

// Landmarks that a suspect must share with a shape, if it does not lie in its box.
constexpr std::size_t kLeastLandmarks = 8;

// How far a suspect may reach out of the box of a shape, as a share of its diagonal.
constexpr double kOutOfBox = 0.02;

// Shapes that are tried at most, those that share the most landmarks first.
constexpr std::size_t kMostShapes = 16;

// Chooses among shapes those that the suspect may be a piece of.
class ShapeSearch {
 public:
  explicit ShapeSearch(const Mesh& suspect) : box_(bounding_box(suspect.positions)) {
    Mesh turned = suspect;
    for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
    for (const Mesh* mesh : {&suspect, &std::as_const(turned)}) {  // it may be a mirror image
      for (const std::uint64_t number : landmarks(*mesh)) {
        if (number != 0) landmarks_.insert(number);
      }
    }
  }

  [[nodiscard]] std::vector<KeptShape> chosen_of(const KeptShapes& shapes) const {
    std::vector<std::pair<std::size_t, KeptShape>> chosen;  // by what speaks for them
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      stop_point();
      std::optional<KeptShape> shape = KeptShape::from_bytes(shapes.bytes(i));
      if (!shape) continue;
      const std::size_t promise = promise_of(*shape);
      if (promise == 0) continue;
      chosen.emplace_back(promise, std::move(*shape));
      std::stable_sort(chosen.begin(), chosen.end(),
                       [](const auto& a, const auto& b) { return a.first > b.first; });
      if (chosen.size() > kMostShapes) chosen.pop_back();
    }
    std::vector<KeptShape> result;
    for (auto& [promise, shape] : chosen) result.push_back(std::move(shape));
    return result;
  }

 private:
  [[nodiscard]] std::size_t promise_of(const KeptShape& shape) const {
    std::size_t shared = 0;
    for (const std::uint64_t number : shape.landmarks) shared += landmarks_.count(number);
    if (shared >= kLeastLandmarks) return shared;
    const Box box = bounding_box(shape.coarse.positions);
    const double slack = kOutOfBox * box.size().norm();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (box_.low[axis] < box.low[axis] - slack || box_.high[axis] > box.high[axis] + slack) {
        return 0;
      }
    }
    return 1;
  }

  Box box_;
  std::unordered_set<std::uint64_t> landmarks_;
};

// Returns what is read with a shape; nothing if the suspect has nothing to do with it.
std::vector<ScoreTable> tables_with_shape(const Mesh& suspect, const KeptShape& shape,
                                          const Key& key) {
  std::vector<ScoreTable> tables;
  const std::vector<Alignment> alignments = align(suspect, shape.coarse, shape.landmarks);
  if (alignments.empty()) return tables;
  const Halfedges halfedges = build_halfedges(shape.coarse);
  add_flux_of_part(suspect, shape.coarse, FluxCanvas({shape.coarse, halfedges}, shape.solid),
                   alignments, key, "flux, with the shape in the ledger", tables);
  return tables;
}

// Puts tables of the same layer beside each other, each kind with half of the prior.
std::vector<ScoreTable> joined(std::vector<ScoreTable> blind, std::vector<ScoreTable> with) {
  for (ScoreTable& table : with) {
    table.prior -= 1;
    blind.push_back(std::move(table));
  }
  std::stable_sort(blind.begin(), blind.end(),
                   [](const ScoreTable& a, const ScoreTable& b) { return a.layer < b.layer; });
  return blind;
}

// Returns the best names of one group.
std::vector<Traced> trace_group(const Surface& surface, const Key& key,
                                const Suspects::Prepared& prepared, FluxEffort effort,
                                std::size_t most) {
  const SuspectGroup& group = prepared.group;
  const std::vector<ScoreTable> blind =
      read_fingerprints(surface, key, prepared.code, group.encodings, effort);
  std::map<std::size_t, NameEvidence> best;  // by name: the most that speaks for it
  const std::size_t shapes = group.shapes ? group.shapes->size() : 0;
  const double price = std::log2(1 + static_cast<double>(group.originals.size() + shapes));
  const auto add = [&](std::span<const ScoreTable> tables) {
    for (Scored& scored : best_of(tables, prepared.code, prepared.seeds, most)) {
      scored.evidence.bits -= price;
      const auto [known, is_new] = best.try_emplace(scored.name, scored.evidence);
      if (!is_new && known->second.bits < scored.evidence.bits) {
        known->second = std::move(scored.evidence);
      }
    }
  };
  if (!blind.empty()) add(blind);
  for (const auto& original : group.originals) {
    stop_point();
    std::vector<ScoreTable> with = tables_with(surface.mesh, *original, key, group);
    if (!with.empty()) add(joined(blind, std::move(with)));
  }
  // it takes its time, and what names somebody by then needs no more
  if (shapes > 0 && effort == FluxEffort::All && has_flux(group.encodings)) {
    for (const KeptShape& shape : ShapeSearch(surface.mesh).chosen_of(*group.shapes)) {
      stop_point();
      std::vector<ScoreTable> with = tables_with_shape(surface.mesh, shape, key);
      if (!with.empty()) add(joined(blind, std::move(with)));
    }
  }
  std::vector<Traced> traced;
  for (auto& [name, evidence] : best) {
    traced.push_back({group.names[name], 0, std::move(evidence), 0});
  }
  return traced;
}

}  // namespace

const Mesh& OriginalMesh::mesh() const {
  return mesh_.get([&] { return MeshFile::open(path_).mesh(); });
}

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
