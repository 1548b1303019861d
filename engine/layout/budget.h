// The time limit of an anytime layout solver.
#pragma once

#include <chrono>
#include <cstdint>

#include "engine/layout/layout.h"

namespace triglyph {

// Counts from its construction, by passes or by the clock as the options say.
class Budget {
 public:
  explicit Budget(const LayoutOptions& options) : options_(options), start_(Clock::now()) {}

  [[nodiscard]] bool is_timed() const { return options_.seconds > 0; }
  [[nodiscard]] double elapsed_seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

  // Returns whether the solver may continue after `done` passes over the candidates.
  [[nodiscard]] bool allows(std::uint64_t done) const {
    return is_timed() ? elapsed_seconds() < options_.seconds : done < options_.iterations;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const LayoutOptions& options_;
  Clock::time_point start_;
};

}  // namespace triglyph
