// The stages of marking one mesh, the paper's figure 2, for mark() and for trials of what would
// help a mesh that cannot be marked.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/marking/extract.h"
#include "engine/marking/marking.h"
#include "engine/marking/options.h"
#include "engine/marking/plan_words.h"
#include "engine/marking/select_units.h"
#include "engine/message/key.h"

namespace triglyph {

// Share of a cell's width from which on the distance between the output's numbers explains that
// most units were lost: rounding moves each of a unit's points by up to half that distance, which
// leaves no margin.
inline constexpr double kCoarseStep = 0.05;

// What the output can hold.
struct OutputLimits {
  const Rounding& round;
  double step = 0;  // between neighbouring numbers, model units
  const Recut& recut;
};

// What is to be marked, with what. All must outlive what refers to it.
struct MarkTask {
  const Surface& surface;
  const Payload& payload;
  const Key& key;
  const MarkOptions& options;
  OutputLimits output;
};

// The stages, to be run in this order. A message and fill differ in the words, in the limit of
// moves and in the number of rounds.
class MarkStages {
 public:
  explicit MarkStages(const MarkTask& task);

  // Reads the mesh as it is, not turned over, as blindly as any reader does; with a scheme that
  // takes long to read, only if a sample of the mesh looks marked. O(triangles).
  [[nodiscard]] Extraction read() const;

  // Step 1 of the paper: finds the units that do not interfere.
  void select_units();

  // Makes the words. Returns false if there are fewer units than parts.
  [[nodiscard]] bool make_words();

  // Step 2 of the paper: assigns words to units and embeds them, again where too many were lost.
  void embed_words() { embed(limits(), capacity_, marking_); }

  // Says whether moves are limited, by the user or by default.
  [[nodiscard]] bool is_limited() const { return limits().cap > 0 || limits().aim > 0; }
  [[nodiscard]] Marking& marking() { return marking_; }
  [[nodiscard]] MarkStatus status_of(const Marking& marking) const;

  // Return what marking within another limit of moves, in percent, or with another message comes
  // to; for trials after the stages. A message of more parts than units is TooSmall.
  [[nodiscard]] Marking marked_within(double max_move_percent);
  [[nodiscard]] Marking marked_with(std::span<const std::uint8_t> message);

  // Returns the least move, in percent, without which some part or, with fill, every unit is left
  // out: a lower bound of the limit of moves that does.
  [[nodiscard]] double least_move_percent();

 private:
  // A scheme for words of one format, bound to the surface.
  struct Binding {
    Binding(const MarkTask& task, const WordFormat& format, CostFunction cost);
    WordCode code;
    std::unique_ptr<Scheme> scheme;
    std::unique_ptr<BoundScheme> bound;
  };

  [[nodiscard]] bool is_fill() const { return message_ == nullptr; }
  [[nodiscard]] bool is_spread() const { return !is_fill() && task_.options.format.is_spread; }
  // Makes the words of a message for so many units, of which it may need more.
  void set_message(std::span<const std::uint8_t> message, std::size_t units,
                   Marking& marking) const;
  [[nodiscard]] MoveLimits limits() const;
  [[nodiscard]] const BoundScheme& moves();
  void embed(const MoveLimits& limits, const Capacity& capacity, Marking& marking);
  void embed_once(const MoveLimits& limits, const Capacity& capacity, Marking& marking);
  // Says whether a reader of the marked mesh finds the words of a spread message.
  [[nodiscard]] bool reads_back(const Marking& marking) const;

  MarkTask task_;
  const Message* message_;  // null: fill
  double diagonal_;         // model units
  std::optional<Binding> binding_;
  std::optional<Binding> moves_;  // the same, but costs are moves; made when it is needed
  Capacity capacity_;
  Marking marking_;
};

}  // namespace triglyph
