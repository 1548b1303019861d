// Shortest augmenting paths to a free unit, the exact part of the transportation solver.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/assignment/transport_state.h"

namespace triglyph {

class PathSearch {
 public:
  // `state` must outlive the search and may be changed only through it.
  explicit PathSearch(TransportState& state);

  // Places one copy of the word in a unit, or in the reserve, with the least increase of the total
  // cost. Precondition: the word has a copy to place, and one side of the problem can be served
  // completely, else std::logic_error. O(words log words + candidates), occasionally plus O(units).
  void serve(std::uint32_t source);

  // Returns the number of words visited by all searches so far.
  [[nodiscard]] std::size_t visits() const { return visits_; }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  // How the search reached a word: through a unit that it holds, or through its copy in the
  // reserve.
  struct Reach {
    double distance = kFar;
    std::uint32_t from = kNoIndex;
    std::uint32_t through = kNoIndex;  // unit; kNoIndex for the reserve
  };
  // An entry of the heap. At equal distance, words come before renewals of candidate lists.
  struct Event {
    double distance;
    std::uint32_t code;  // word; words + word: renewal of its list; 2 * words: the reserve
    bool operator<(const Event& other) const {
      return distance != other.distance ? distance > other.distance : code > other.code;
    }
  };

  void visit(std::uint32_t word);
  void visit_beyond_list(std::uint32_t word);
  void visit_reserve();
  void follow(std::uint32_t word, std::uint32_t unit, double distance);
  void reach(std::uint32_t word, double distance, std::uint32_t from, std::uint32_t through);
  void push(double distance, std::uint32_t code);
  void raise_values();
  void shift_along_path(std::uint32_t source);
  void forget();
  [[nodiscard]] bool is_closed(std::uint32_t unit) const;

  TransportState& state_;
  std::vector<Reach> reach_;
  std::vector<std::uint8_t> is_visited_;
  std::vector<std::uint32_t> reached_;  // words to forget afterwards
  std::vector<Event> heap_;
  std::vector<std::uint32_t> open_units_;  // superset of the units that no visited word holds
  bool is_open_listed_ = false;
  std::size_t open_count_ = 0;  // units that no visited word holds
  Reach reserve_reach_;
  bool is_reserve_visited_ = false;
  std::size_t visits_ = 0;
  Reach end_;  // nearest free unit, or room in the reserve
};

}  // namespace triglyph
