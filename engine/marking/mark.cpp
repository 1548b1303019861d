#include "engine/marking/mark.h"

#include <array>
#include <utility>
#include <variant>

#include "engine/flux/flux_mark.h"
#include "engine/marking/copies.h"
#include "engine/marking/mark_stages.h"
#include "engine/marking/way_out.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/deformation.h"
#include "engine/metric/structural_distortion.h"

namespace triglyph {
namespace {

// The root mean square of the flux layer's moves by Strength, percent of the diagonal. MSDM2 stays
// below 0.05, 0.2 and 0.35 with them on most meshes.
constexpr std::array<double, 3> kFluxMoves = {0.02, 0.07, 0.12};

// The share of the user's limits of moves and visibility that is left to the flux layer where units
// follow.
constexpr double kFluxShareOfLimits = 0.75;

// A mark that is seen is tried again with so many times fewer units; MSDM2 falls by less.
constexpr std::size_t kFewerUnits = 3;

Marking already_marked(Marking& marking, FoundMessage found) {
  marking.status = MarkStatus::AlreadyMarked;
  marking.found = std::move(found);
  return std::move(marking);
}

// Returns the mark of this key that the surface carries in one of the layers of the task.
std::optional<FoundMessage> mark_before(const MarkTask& task, const MarkStages& stages) {
  if (task.options.units != LayerUse::No) {
    Extraction before = stages.read();
    if (before.message) return FoundMessage{std::move(*before.message), before.agreeing, {}};
  }
  if (task.options.flux != LayerUse::No) {
    if (auto found = read_flux(task.surface, task.key, FluxEffort::AsItIs)) {
      return FoundMessage{message_in(found->payload).value_or(Message{}), 0, std::move(found)};
    }
  }
  return std::nullopt;
}

// `seeks_way_out` tries what would help a mesh that is refused.
void mark_units(const MarkTask& task, MarkStages& stages, bool seeks_way_out) {
  stages.select_units();
  Marking& marking = stages.marking();
  marking.status = MarkStatus::TooSmall;
  if (stages.make_words()) {
    stages.embed_words();
    marking.status = stages.status_of(marking);
  }
  if (!seeks_way_out) return;
  if (marking.status == MarkStatus::TooCoarse) {
    marking.way_out = way_out_of_too_coarse(task);
  } else if (marking.status == MarkStatus::TooSmall) {
    marking.way_out = way_out_of_too_small(task, stages);
    const bool has_cap = task.options.max_move_percent.value_or(0) > 0;
    if (has_cap && marking.way_out.max_move_percent > 0) marking.status = MarkStatus::TooVisible;
  }
}

// Returns the options with the cells and words of a normal mark, if they are those of a strong one.
std::optional<MarkOptions> with_usual_cells(const MarkOptions& options) {
  const MarkOptions strong = default_mark_options(options.scheme, false, Strength::Strong);
  const MarkOptions usual = default_mark_options(options.scheme, false);
  if (options.strength != Strength::Strong || options.encoding() != strong.encoding() ||
      strong.encoding() == usual.encoding()) {
    return std::nullopt;
  }
  MarkOptions changed = options;
  changed.format = usual.format;
  changed.scheme_options = usual.scheme_options;
  return changed;
}

// Marks units; those of a strong mark with the cells of a normal one where wide ones would move
// points too far.
Marking mark_units_somehow(const MarkTask& task, MarkStages& stages, bool seeks_way_out) {
  const auto usual = with_usual_cells(task.options);
  mark_units(task, stages, seeks_way_out && !usual);
  if (!usual || stages.marking().status != MarkStatus::TooSmall) {
    return std::move(stages.marking());
  }
  const MarkTask again{task.surface, task.payload, task.key, *usual, task.output};
  MarkStages with_usual(again);
  mark_units(again, with_usual, seeks_way_out);
  with_usual.marking().scheme_options = usual->scheme_options;
  return std::move(with_usual.marking());
}

// Marks the units of a surface within the budget of visibility, measured against the mesh as it was
// before any layer: with fewer units a part where the mark would be seen.
Marking mark_units_unseen(const MarkTask& task, MarkStages& stages, const Mesh& before,
                          bool seeks_way_out) {
  Marking marking = mark_units_somehow(task, stages, seeks_way_out);
  const double budget = task.options.max_visibility;
  const bool has_redundancy = marking.parts_needed > 0 && !task.options.format.is_spread;
  while (budget > 0 && marking.status == MarkStatus::Marked) {
    marking.visibility = msdm2(before, {marking.positions, before.triangles}, kWindowsSeen);
    if (marking.visibility <= budget) break;
    MarkOptions fewer = task.options;
    const std::size_t carried = has_redundancy ? marking.carriers.size() / marking.parts_needed : 0;
    fewer.redundancy = static_cast<std::uint32_t>(carried / kFewerUnits);
    if (fewer.redundancy == 0) {
      marking.status = MarkStatus::TooVisible;
      break;
    }
    const MarkTask again{task.surface, task.payload, task.key, fewer, task.output};
    MarkStages fewer_units(again);
    marking = mark_units_somehow(again, fewer_units, false);
  }
  return marking;
}

// A mesh with the positions of its layers so far, as a reader cuts its faces into triangles.
class MovedMesh {
 public:
  MovedMesh(const MarkTask& task, std::span<const Vec3> positions)
      : mesh_{{positions.begin(), positions.end()}, task.surface.mesh.triangles} {
    if (task.output.recut) {
      mesh_.triangles = task.output.recut(positions);
      if (mesh_.triangles != task.surface.mesh.triangles) own_ = build_halfedges(mesh_);
    }
    halfedges_ = own_ ? &*own_ : &task.surface.halfedges;
  }
  MovedMesh(const MovedMesh&) = delete;
  MovedMesh& operator=(const MovedMesh&) = delete;

  [[nodiscard]] Surface surface() const { return {mesh_, *halfedges_}; }

 private:
  Mesh mesh_;
  std::optional<Halfedges> own_;
  const Halfedges* halfedges_;
};

// Says whether a reader finds the flux layer on the surface with other positions.
bool reads(const FluxMark& mark, std::span<const Vec3> positions, const MarkTask& task) {
  const MovedMesh moved(task, positions);
  const auto found = read_flux(moved.surface(), task.key, FluxEffort::AsItIs);
  return found && found->payload == mark.payload;
}

// Marks the units of a surface that has its flux layer. What they cannot carry is in the flux layer
// anyway if they are marked only where possible.
Marking with_units(const MarkTask& task, Marking flux_alone) {
  const MarkOptions& options = task.options;
  if (options.units == LayerUse::No) return flux_alone;
  const MovedMesh with_flux(task, flux_alone.positions);
  const Surface surface = with_flux.surface();
  MarkOptions rest = options;
  double moved_percent = 0;  // by the flux layer; the limit is for both
  if (options.max_move_percent.value_or(0) > 0) {
    const Displacement moves = displacement(task.surface.mesh.positions, surface.mesh.positions);
    moved_percent = 100 * moves.max / surface_diagonal(task.surface.mesh);
    rest.max_move_percent = *options.max_move_percent - moved_percent;
  }
  const MarkTask moved{surface, task.payload, task.key, rest, task.output};
  MarkStages stages(moved);
  Marking marking =
      mark_units_unseen(moved, stages, task.surface.mesh, options.units == LayerUse::Yes);
  if (marking.way_out.max_move_percent > 0) {
    marking.way_out.max_move_percent += moved_percent;
    marking.way_out.move_needed_percent += moved_percent;
  }
  if (options.units == LayerUse::IfPossible && marking.status != MarkStatus::Marked) {
    return flux_alone;
  }
  marking.flux = flux_alone.flux;
  const bool keeps_flux = reads(*marking.flux, marking.positions, task);
  if (!keeps_flux && options.units == LayerUse::IfPossible) return flux_alone;
  return marking;
}

// Marks the task's message itself in its layers.
Marking mark_message(const MarkTask& task, bool seeks_way_out) {
  const auto* message = std::get_if<Message>(&task.payload);
  const MarkOptions& options = task.options;
  MarkStages stages(task);
  if (message != nullptr && !options.remark) {
    if (auto found = mark_before(task, stages)) {
      return already_marked(stages.marking(), std::move(*found));
    }
  }
  FluxObstacle obstacle = FluxObstacle::None;
  if (message != nullptr && options.flux != LayerUse::No) {
    const double share = options.units == LayerUse::No ? 1 : kFluxShareOfLimits;
    const FluxBounds bounds{kFluxMoves.at(static_cast<std::size_t>(options.strength)),
                            share * options.max_move_percent.value_or(0),
                            share * options.max_visibility};
    FluxMarking flux = mark_flux(task.surface, *message, task.key, bounds, task.output.round);
    obstacle = flux.obstacle;
    if (obstacle == FluxObstacle::None && !reads(flux.mark, flux.positions, task)) {
      obstacle = FluxObstacle::TooFaint;  // by the output's numbers
    }
    if (obstacle == FluxObstacle::None) {
      Marking alone;
      alone.format = options.format;
      alone.positions = std::move(flux.positions);
      alone.flux = flux.mark;
      return with_units(task, std::move(alone));
    }
  }
  Marking marking;
  if (obstacle != FluxObstacle::None && options.flux == LayerUse::Yes) {
    marking = std::move(stages.marking());
    marking.status = MarkStatus::NoFlux;
  } else {
    marking = mark_units_unseen(task, stages, task.surface.mesh, seeks_way_out);
  }
  marking.flux_obstacle = obstacle;
  return marking;
}

}  // namespace

std::optional<FoundMessage> mark_before(const MarkTask& task) {
  if (task.options.remark) return std::nullopt;
  return mark_before(task, MarkStages(task));
}

Marking mark(const Surface& surface, const Payload& payload, const Key& key,
             const MarkOptions& options, const Rounding& rounding, double number_step,
             const Recut& recut) {
  validate(options.format);
  const auto* message = std::get_if<Message>(&payload);
  const bool is_copy = message != nullptr && options.carry == Carry::Fingerprint;
  if (message != nullptr && !is_copy) check_message(options.format, message->size());
  const MarkTask task{surface, payload, key, options, {rounding, number_step, recut}};
  if (is_copy) return CopyPlan(task).copy(*message);
  const bool has_choice = message != nullptr && options.carry == Carry::Any;
  Marking marking = mark_message(task, !has_choice);
  const bool is_refused =
      marking.status != MarkStatus::Marked && marking.status != MarkStatus::AlreadyMarked;
  if (!has_choice || !is_refused) return marking;
  Marking copy = CopyPlan(task).copy(*message);
  const bool is_copy_of_use =
      copy.status == MarkStatus::Marked || copy.status == MarkStatus::TooCoarse;
  return is_copy_of_use ? copy : mark_message(task, true);
}

}  // namespace triglyph
