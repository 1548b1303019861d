#include "engine/layout/random_order.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/base/stop.h"

namespace triglyph {

std::vector<std::uint32_t> degrees_of(const Conflicts& conflicts) {
  std::vector<std::uint32_t> degrees(conflicts.size(), 0);
  parallel_for(
      conflicts.size(),
      [&](std::size_t i) {
        conflicts.for_each_list(static_cast<std::uint32_t>(i), [&](std::uint32_t list) {
          degrees[i] += static_cast<std::uint32_t>(conflicts.units_on(list).size());
        });
      },
      kBlock);
  return degrees;
}

std::vector<std::uint32_t> fit_in_order(const Conflicts& conflicts,
                                        std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> chosen;
  std::vector<char> blocked(conflicts.size(), 0);
  for (const std::uint32_t unit : order) {
    if (blocked[unit] != 0) continue;
    stop_point();
    chosen.push_back(unit);
    conflicts.for_each_neighbour(unit, [&](std::uint32_t other) { blocked[other] = 1; });
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<std::uint32_t> draw_order(std::span<const double> attraction, std::uint64_t seed,
                                      std::uint64_t index) {
  struct Ticket {
    double key;
    std::uint32_t unit;
  };
  std::vector<Ticket> tickets(attraction.size());
  for (std::uint32_t unit = 0; unit < tickets.size(); ++unit) {
    tickets[unit] = {-std::log1p(-random_unit(seed, index, unit)) / attraction[unit], unit};
  }
  std::sort(tickets.begin(), tickets.end(), [](const Ticket& a, const Ticket& b) {
    return a.key != b.key ? a.key < b.key : a.unit < b.unit;
  });
  std::vector<std::uint32_t> order(tickets.size());
  std::transform(tickets.begin(), tickets.end(), order.begin(),
                 [](const Ticket& ticket) { return ticket.unit; });
  return order;
}

}  // namespace triglyph
