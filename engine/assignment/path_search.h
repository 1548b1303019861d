// The exact half of the transportation solver: shortest paths to a free unit.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "engine/assignment/transport_state.h"

namespace triglyph {

class PathSearch {
 public:
  // The state must outlive the search, and only be changed through it.
  explicit PathSearch(TransportState& state);

  // Finds a unit, or room in the reserve, for one copy of the word at the least rise of the total
  // cost. Precondition: the word lacks a copy and one side of the problem can be served, else
  // std::logic_error. O(words log words + pairs listed) and now and then O(units).
  void serve(std::uint32_t source);

  // Words visited by all searches so far.
  [[nodiscard]] std::size_t visits() const { return visits_; }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  // How the search came to a word: through a unit it holds, or through its copy in the reserve.
  struct Reach {
    double distance = kFar;
    std::uint32_t from = kNobody;
    std::uint32_t through = kNobody;  // unit; kNobody for the reserve
  };
  // What the search visits next. Words come before renewals at the same distance.
  struct Event {
    double distance;
    std::uint32_t code;  // word, or number of words + word to look beyond its list, or the reserve
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
  std::vector<std::uint32_t> open_units_;  // all that a visited word does not hold, and some more
  bool is_open_listed_ = false;
  std::size_t open_count_ = 0;  // units no visited word holds
  Reach reserve_reach_;
  bool is_reserve_visited_ = false;
  std::size_t visits_ = 0;
  Reach end_;  // nearest free unit, or room in the reserve
};

}  // namespace triglyph
