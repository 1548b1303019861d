#include "engine/marking/copies.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/assignment/assignment.h"
#include "engine/marking/mark.h"
#include "engine/marking/settle.h"
#include "engine/marking/way_out.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/deformation.h"
#include "engine/metric/structural_distortion.h"
#include "engine/scheme/registry.h"
#include "engine/trace/displaced_points.h"
#include "engine/trace/fingerprint_reading.h"

namespace triglyph {
namespace {

// The root mean square of the flux layer's moves by Strength, as for messages, percent of the
// diagonal.
constexpr std::array<double, 3> kFluxMovesOfCopies = {0.02, 0.07, 0.12};

// The scheme of marks that take what layer the mesh can carry.
constexpr std::string_view kAnyLayer = "auto";

// Evidence, in bits, that units must be able to leave, or else points are displaced: units are lost
// when they are rounded, and what is left must be enough.
constexpr double kPointsBelow = 2 * kTraceable;

// Numbers that are so far apart, in relation to the farthest displacement, blur it.
constexpr double kCoarseDisplacement = 1.0 / 16;

// The share of the user's limit of moves that is left to the flux layer where units follow.
constexpr double kFluxShareOfCopies = 0.75;

// Evidence, in bits, at which the usual encoding is taken: several times what is needed, since
// units are lost in what meshes go through.
constexpr double kPlenty = 8 * kTraceable;

// Share of what bits can tell of colluders that is told where they average or mix: of 1,024 bits of
// the bunny, 0.83 for two and 1.05 for three were measured.
constexpr double kToldOfColluders = 0.8;

// Evidence, in bits, that is left for the weakest of colluders, whose luck differs.
constexpr double kSurelyTraceable = kTraceable + 10;

// Units for each that a part of a message would get: about as many as a message of eight bytes has
// parts, so that copies change as much of a mesh as messages do.
constexpr std::size_t kUnitsPerRedundancy = 12;

// Colluders mix the bits of every symbol, so that all symbols are needed, and units to spare.
constexpr std::size_t kUnitsPerSymbol = 8;

// Units that are weighed against each other for each that is used.
constexpr std::size_t kChoicesPerUnit = 4;

// Names that stand for all: a unit's cost is the most over them.
constexpr std::size_t kProbeNames = 3;

// A mark that is seen is tried again with so many times fewer units.
constexpr std::size_t kFewerUnitsOfCopies = 3;

std::vector<Word> words_of_name(const FingerprintCode& code, FingerprintSeed seed,
                                const WordFormat& format) {
  std::vector<Word> words(std::size_t{1} << format.subscript_bits);
  for (std::uint32_t symbol = 0; symbol < words.size(); ++symbol) {
    words[symbol] = {symbol, code.symbol(seed, FingerprintLayer::Units, symbol, format.part_bits)};
  }
  return words;
}

// Returns the units that lie evenly among the valid ones, about `most` of them.
std::vector<std::uint32_t> spread_over(std::span<const std::uint32_t> valid, std::size_t most) {
  std::vector<std::uint32_t> chosen;
  const std::size_t step = std::max<std::size_t>(1, valid.size() / std::max<std::size_t>(1, most));
  for (std::size_t i = 0; i < valid.size(); i += step) chosen.push_back(valid[i]);
  return chosen;
}

// Returns the encoding for meshes with few units, most of which would have to move farther than may
// be seen for a marker and a subscript of so many bits in so wide cells. Of 13 meshes of 24 to
// 1,098 points, 11 carry a fingerprint so, 3 in the usual encoding.
Encoding of_small_meshes(Encoding encoding) {
  constexpr int kBitsOfSmall = 4;
  constexpr double kStepOfSmall = 0.5;  // in relation to the usual
  encoding.format.marker_bits = std::min(encoding.format.marker_bits, kBitsOfSmall);
  encoding.format.subscript_bits = std::min(encoding.format.subscript_bits, kBitsOfSmall);
  const auto step = encoding.scheme_options.find("step");
  if (step != encoding.scheme_options.end()) {
    step->second = kStepOfSmall * std::get<double>(step->second);
  }
  return encoding;
}

}  // namespace

FingerprintCode fingerprint_code(const Key& key, const MarkOptions& options) {
  return FingerprintCode(key, static_cast<int>(options.collusion));
}

std::vector<Encoding> fingerprint_encodings(const MarkOptions& options) {
  std::vector<Encoding> encodings;
  if (options.units != LayerUse::No) {
    Encoding units = options.encoding();
    const WordFormat asked = units.format;
    if (options.collusion > 1) {
      units.format = fingerprint_format(asked, static_cast<int>(options.collusion));
      encodings.push_back(units);
    }
    units.format = fingerprint_format(asked, 1);
    encodings.push_back(units);
    if (!asked.is_spread) encodings.push_back(of_small_meshes(std::move(units)));
  }
  if (options.flux != LayerUse::No) encodings.push_back({std::string(kFluxScheme), {}, {}});
  return encodings;
}

int colluders_resisted(std::size_t bits) {
  int most = 1;
  for (int colluders = 2; colluders <= kMostColluders; ++colluders) {
    // of one of them, if each bit is that of any
    const double right = (1 + 1.0 / colluders) / 2;
    const double told = 1 + right * std::log2(right) + (1 - right) * std::log2(1 - right);
    if (kToldOfColluders * static_cast<double>(bits) * told < kSurelyTraceable) break;
    most = colluders;
  }
  return most;
}

// The layer of units: which unit carries which symbol.
struct CopyPlan::Units {
  Units(const MarkTask& task, const Encoding& with)
      : encoding(with),
        words(task.key, with.format),
        scheme(make_scheme(with.scheme, words, with.scheme_options, task.options.cost)),
        bound(scheme->bind(task.surface)) {}
  // Returns how many bits of evidence the placements can leave.
  [[nodiscard]] double bits() const {
    const std::size_t symbols = std::min<std::size_t>(placements.size(), words.capacity());
    return static_cast<double>(symbols) * encoding.format.part_bits;
  }

  Encoding encoding;
  WordCode words;
  std::unique_ptr<Scheme> scheme;
  std::unique_ptr<BoundScheme> bound;
  Capacity capacity;
  std::vector<Placement> placements;  // by ascending unit; a word's number is its symbol
  double cost_max = 0;                // model units
  double cost_sum = 0;
  double farthest = 0;  // limit of moves, model units; 0: none
};

CopyPlan::CopyPlan(const MarkTask& task)
    : task_(task),
      code_(fingerprint_code(task.key, task.options)),
      diagonal_(surface_diagonal(task.surface.mesh)) {
  found_ = mark_before(task_);
  if (found_) return;
  if (task_.options.flux != LayerUse::No) canvas_.emplace(task_.surface);
  if (task_.options.units != LayerUse::No) plan_units();
  const bool is_auto = task_.options.scheme_name() == kAnyLayer;
  if (!is_auto || task_.surface.mesh.triangles.empty() || units_->bits() >= kPlenty) return;
  // any name tells about what others will leave
  displaces_points_ = copy_with(0, 1).expected_bits < kPointsBelow;
}

double farthest_of_points(Strength strength, double diagonal) {
  return kFluxMovesOfCopies.at(static_cast<std::size_t>(strength)) / 100 * diagonal;
}

bool CopyPlan::is_too_coarse() const {
  if (displaces_points_) {
    return task_.output.step >
           kCoarseDisplacement * farthest_of_points(task_.options.strength, diagonal_);
  }
  return units_ != nullptr && task_.output.step > kCoarseStep * units_->bound->cell_size();
}

void CopyPlan::plan_units() {
  for (const Encoding& encoding : fingerprint_encodings(task_.options)) {
    if (encoding.scheme == kFluxScheme) continue;
    if (units_ != nullptr && units_->bits() >= kPlenty) break;
    auto units = planned_units(encoding);
    if (units_ == nullptr || units->bits() > units_->bits()) units_ = std::move(units);
  }
}

std::shared_ptr<const CopyPlan::Units> CopyPlan::planned_units(const Encoding& encoding) const {
  const MarkOptions& options = task_.options;
  const WordFormat& format = encoding.format;
  auto units = std::make_shared<Units>(task_, encoding);
  std::vector<std::vector<Word>> probes;
  for (std::uint64_t i = 0; i < kProbeNames; ++i) {
    probes.push_back(words_of_name(code_, i, format));
  }
  units->capacity = find_capacity(task_.surface, *units->bound, probes[0], options);
  const std::size_t symbols = probes[0].size();
  std::size_t wanted =
      options.collusion > 1 ? kUnitsPerSymbol * symbols : kUnitsPerRedundancy * options.redundancy;
  if (wanted == 0) wanted = kUnitsPerSymbol * symbols;
  const std::vector<std::uint32_t> chosen =
      spread_over(units->capacity.valid, kChoicesPerUnit * wanted);
  wanted = std::min(wanted, chosen.size());
  // the farthest move that any part of a message is given
  const double cap = options.max_move_percent.value_or(0);
  units->farthest = (cap > 0 ? cap : kVisibleMove * kUsualMove) / 100 * diagonal_;
  CostMatrix costs = units->bound->costs(units->capacity.units, chosen, probes[0]);
  for (std::size_t probe = 1; probe < kProbeNames; ++probe) {
    const CostMatrix others = units->bound->costs(units->capacity.units, chosen, probes[probe]);
    for (std::size_t i = 0; i < costs.values.size(); ++i) {
      costs.values[i] = std::max(costs.values[i], others.values[i]);
    }
  }
  const bool costs_are_moves = options.cost == CostFunction::Displacement;
  for (float& cost : costs.values) {
    if (costs_are_moves && double{cost} > units->farthest) cost = kInfeasible;
  }
  std::vector<std::uint32_t> demand(symbols);
  for (std::size_t i = 0; i < symbols; ++i) {
    demand[i] = static_cast<std::uint32_t>((wanted + symbols - 1 - i) / symbols);
  }
  // fewer units than symbols: any symbol does
  if (wanted < symbols) std::fill(demand.begin(), demand.end(), 1);
  const Assignment assignment = assign_least_sum(costs, demand);
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < chosen.size(); ++row) {
    if (assignment.word_of_unit[row] != kNoWord) rows.push_back(row);
  }
  if (rows.size() > wanted) {
    std::stable_sort(rows.begin(), rows.end(), [&](std::uint32_t a, std::uint32_t b) {
      return costs.at(a, assignment.word_of_unit[a]) < costs.at(b, assignment.word_of_unit[b]);
    });
    rows.resize(wanted);
    std::sort(rows.begin(), rows.end());
  }
  for (const std::uint32_t row : rows) {
    units->placements.push_back({chosen[row], assignment.word_of_unit[row]});
  }
  units->cost_max = assignment.max_cost;
  units->cost_sum = assignment.sum_cost;
  return units;
}

void CopyPlan::embed_units(FingerprintSeed seed, std::size_t one_in, Marking& marking) const {
  const Units& units = *units_;
  const Mesh before{marking.positions, task_.surface.mesh.triangles};
  const Surface surface{before, task_.surface.halfedges};
  const auto bound = units.bound->moved_to(surface);
  std::vector<Placement> placements;
  for (std::size_t i = 0; i < units.placements.size(); i += one_in) {
    placements.push_back(units.placements[i]);
  }
  marking.format = units.encoding.format;
  marking.colluders = 1;
  if (marking.format == fingerprint_format(task_.options.format, 2)) {
    marking.colluders = colluders_resisted(static_cast<std::size_t>(units.bits()));
  }
  marking.words = words_of_name(code_, seed, marking.format);
  settle(surface, *bound, units.capacity.units, placements,
         {task_.output.round, units.farthest, task_.output.recut}, marking);
  marking.candidates = static_cast<std::uint32_t>(units.capacity.units.size());
  marking.units_valid = static_cast<std::uint32_t>(units.capacity.valid.size());
  marking.units_bound = units.capacity.bound;
  marking.units_assigned = static_cast<std::uint32_t>(placements.size());
  marking.cost_max = units.cost_max;
  marking.cost_sum = units.cost_sum;
}

Marking CopyPlan::copy_with(FingerprintSeed seed, std::size_t one_in) const {
  const MarkOptions& options = task_.options;
  Marking marking;
  marking.is_fingerprint = true;
  marking.status = MarkStatus::Marked;
  marking.format = options.format;
  marking.positions = task_.surface.mesh.positions;
  if (canvas_) {
    const FluxPhases word = phases_of_name(code_, seed);
    const double share = options.units == LayerUse::No ? 1 : kFluxShareOfCopies;
    const FluxBounds bounds{kFluxMovesOfCopies.at(static_cast<std::size_t>(options.strength)),
                            share * options.max_move_percent.value_or(0),
                            share * options.max_visibility};
    FluxMarking flux =
        mark_flux_word(task_.surface, *canvas_, word, task_.key, bounds, task_.output.round);
    marking.flux_obstacle = flux.obstacle;
    if (flux.obstacle == FluxObstacle::None) {
      marking.flux = flux.mark;
      marking.positions = std::move(flux.positions);
    } else if (options.flux == LayerUse::Yes) {
      marking.status = MarkStatus::NoFlux;
      return marking;
    }
  }
  if (units_ != nullptr) embed_units(seed, one_in, marking);
  marking.expected_bits = static_cast<double>(marking.carriers.size()) * marking.format.part_bits +
                          (marking.flux ? marking.flux->expected_evidence : 0);
  if (marking.expected_bits < kTraceable) marking.status = MarkStatus::TooSmall;
  return marking;
}

Marking CopyPlan::displaced_copy(FingerprintSeed seed) const {
  const Mesh& mesh = task_.surface.mesh;
  const MarkOptions& options = task_.options;
  Marking marking;
  marking.is_fingerprint = true;
  marking.needs_original = true;
  marking.format = options.format;
  const double farthest = farthest_of_points(options.strength, diagonal_);
  marking.positions = displaced(mesh.positions, farthest, code_, seed);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (marking.positions[i] != mesh.positions[i]) {
      marking.positions[i] = task_.output.round(marking.positions[i]);
    }
  }
  for (;;) {
    const auto flipped = flipped_triangles(mesh.triangles, mesh.positions, marking.positions);
    if (flipped.empty()) break;
    for (const std::uint32_t triangle : flipped) {
      for (const std::uint32_t point : mesh.triangles[triangle]) {
        marking.positions[point] = mesh.positions[point];
      }
    }
  }
  std::size_t moved = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (marking.positions[i] != mesh.positions[i]) ++moved;
  }
  marking.expected_bits = static_cast<double>(3 * moved) * kPointBits;
  const double most = options.max_move_percent.value_or(0) / 100 * diagonal_;
  if (is_too_coarse()) {
    marking.status = MarkStatus::TooCoarse;
  } else if (marking.expected_bits < kTraceable) {
    marking.status = MarkStatus::TooSmall;
  } else if (most > 0 && std::sqrt(3.0) * farthest > most) {
    marking.status = MarkStatus::TooVisible;
    marking.way_out.move_needed_percent = 100 * std::sqrt(3.0) * farthest / diagonal_;
    marking.way_out.max_move_percent = rounded_up(marking.way_out.move_needed_percent);
  }
  return marking;
}

Marking CopyPlan::copy(std::span<const std::uint8_t> name) const {
  if (found_) {
    Marking marking;
    marking.status = MarkStatus::AlreadyMarked;
    marking.found.emplace(*found_);
    return marking;
  }
  const FingerprintSeed seed = code_.seed_of(name);
  if (displaces_points_) return displaced_copy(seed);
  const double budget = task_.options.max_visibility;
  for (std::size_t one_in = 1;; one_in *= kFewerUnitsOfCopies) {
    Marking marking = copy_with(seed, one_in);
    if (budget == 0) return marking;
    if (marking.status != MarkStatus::Marked) {
      if (one_in > 1) marking.status = MarkStatus::TooVisible;
      return marking;
    }
    marking.visibility =
        msdm2(task_.surface.mesh, {marking.positions, task_.surface.mesh.triangles}, kWindowsSeen);
    if (marking.visibility <= budget) return marking;
  }
}

}  // namespace triglyph
