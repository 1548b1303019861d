#include "engine/flux/flux_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/flux/closed_mesh.h"
#include "engine/flux/curvature_flow.h"
#include "engine/mesh/edge_length.h"
#include "engine/mesh/uniform_flow.h"

namespace triglyph {
namespace {

// Axes and signs that a reader tries: which functional of the measurement is which of the mark.
struct AxesGuess {
  std::array<std::uint8_t, kFunctionals> source{};
  double price = 0;  // minus the binary logarithm of the prior
};

// The third moments that fix the signs, and the order of the spreads, mostly survive; a mirror
// image turns one axis. The priors add up to one.
double axes_prior(bool keeps_order, bool keeps_signs, bool mirrored) {
  if (keeps_order && keeps_signs) return 0.4;  // 1 guess
  if (keeps_order) return 0.05;                // 4 mirrored guesses and 3 others
  return mirrored ? 0.005 : 0.0075;            // 20 each
}

std::vector<AxesGuess> axes_guesses() {
  std::vector<AxesGuess> guesses;
  std::array<std::size_t, 3> order = {0, 1, 2};
  do {
    const bool keeps_order = std::is_sorted(order.begin(), order.end());
    const bool is_odd = ((order[0] > order[1]) + (order[0] > order[2]) + (order[1] > order[2])) % 2;
    for (std::size_t signs = 0; signs < kOctants; ++signs) {
      const bool odd_signs = ((signs & 1U) + (signs >> 1 & 1U) + (signs >> 2 & 1U)) % 2 != 0;
      AxesGuess guess;
      const double prior = axes_prior(keeps_order, signs == 0, is_odd != odd_signs);
      guess.price = -std::log2(prior);
      for (std::size_t octant = 0; octant < kOctants; ++octant) {
        std::size_t seen = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          seen |= (octant >> axis & 1U) << order[axis];
        }
        for (std::size_t shell = 0; shell < kShells; ++shell) {
          guess.source[shell * kOctants + octant] =
              static_cast<std::uint8_t>(shell * kOctants + (seen ^ signs));
        }
      }
      guesses.push_back(guess);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return guesses;
}

// A hypothesis of what was done to the mesh, undone.
struct Guess {
  Measurement measurement;
  double price = 0;  // minus the binary logarithm of the prior
  std::string undone;
};

// Probabilities that nothing was done that needs undoing, that the mark is of the first builds and
// nothing was done, that the mesh was smoothed, and so on.
constexpr double kPlainPrior = 0.45;
constexpr double kFirstPrior = 0.05;
constexpr double kUnsmoothedPrior = 0.2;
constexpr double kUniformPrior = 0.15;
constexpr double kCurvaturePrior = 0.15;

constexpr std::array<int, 9> kUnsmoothedSteps = {3, 5, 10, 15, 20, 30, 40, 50, 60};
constexpr int kUnsmoothedIterations = 20;

// A reader looks along the line from the surface through what it becomes after some smoothing.
struct Line {
  double from;
  double to;
  double step;
  [[nodiscard]] int count() const { return static_cast<int>(std::lround((to - from) / step)) + 1; }
};
constexpr int kUniformSteps = 10;
constexpr Line kUniformLine = {-1.5, 2.0, 0.1};
constexpr double kFlowTime = 1e-4;  // squared units of the frame's scale
constexpr Line kCurvatureLine = {-1.0, 6.0, 0.2};

// Meshes whose mean edge is shorter than this share of a shell's width are not unsmoothed: what
// they go through in a few dozen steps lies within the lines.
constexpr double kFineEdge = 1.0 / 40;

std::string amount(const char* what, double value) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%s %.3g", what, value);
  return text.data();
}

// The surface as it is read, and what it may have been before.
class Subject {
 public:
  explicit Subject(const Surface& surface, EdgeWeight weight = EdgeWeight::Length)
      : surface_(surface), closed_(surface, weight) {}

  [[nodiscard]] bool has_holes() const { return closed_.holes() > 0; }

  // Returns nothing for a surface without a frame.
  [[nodiscard]] std::optional<FluxValues> values(std::span<const Vec3> positions) const {
    for (const Vec3& p : positions) {
      if (!std::isfinite(p.sqrnorm())) return std::nullopt;
    }
    const std::vector<Vec3> all = closed_.with_centres(positions);
    const auto frame = closed_.frame(all);
    if (!frame) return std::nullopt;
    return flux_values(all, closed_.triangles(), *frame);
  }
  [[nodiscard]] std::optional<SolidFrame> frame() const {
    return closed_.frame(closed_.with_centres(surface_.mesh.positions));
  }
  [[nodiscard]] const Mesh& mesh() const { return surface_.mesh; }

 private:
  const Surface surface_;
  ClosedMesh closed_;
};

void add_line(const FluxValues& here, const std::optional<FluxValues>& there, const Line& line,
              double prior, const char* name, std::vector<Guess>& guesses) {
  if (!there) return;
  const Measurement measurement = measured(here);
  for (int i = 0; i < line.count(); ++i) {
    const double t = line.from + i * line.step;
    FluxVector fluxes = here.flux;
    for (std::size_t f = 0; f < kFunctionals; ++f) fluxes[f] -= t * (there->flux[f] - here.flux[f]);
    guesses.push_back(
        {with_fluxes(measurement, fluxes), -std::log2(prior / line.count()), amount(name, t)});
  }
}

// One hypothesis of everything but the payload.
struct Attempt {
  const Guess* guess;
  const AxesGuess* axes;
  std::size_t step;
  double promise;
};

// How far the values lie from the middle between the lattice's points, whatever the bits, in
// standard deviations of what chance gives.
double promise_of(const Measurement& measurement, const AxesGuess& axes, const Dither& dither,
                  double step) {
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    const Measured& m = measurement[axes.source[i]];
    const double weight = m.used * (1 - m.other_weight);
    if (weight < 0.1) continue;
    sum += weight * std::cos(4 * M_PI * (m.value / step - dither.of(i, m.rung)));
    squares += weight * weight / 2;
  }
  return squares > 0 ? sum / std::sqrt(squares) : 0;
}

// Likewise, how close the pilots lie to their phase.
double promise_of_pilots(const Measurement& measurement, const AxesGuess& axes,
                         const Dither& dither, double step) {
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    if (!is_pilot(i)) continue;
    const Measured& m = measurement[axes.source[i]];
    const double weight = m.used * (1 - m.other_weight);
    if (weight < 0.1) continue;
    sum += weight * std::cos(2 * M_PI * (m.value / step - dither.of(i, m.rung)));
    squares += weight * weight / 2;
  }
  return squares > 0 ? sum / std::sqrt(squares) : 0;
}

// Returns the binary logarithm of the likelihood of phases by the pilots.
double likelihood_of_pilots(const SoftPhases& phases, double sharpness) {
  const double log_mean = log_bessel(sharpness);
  double nats = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    if (!is_pilot(i) || phases[i].used == 0) continue;
    nats += phases[i].log_likelihood(0, sharpness, log_mean);
  }
  return nats / M_LN2;
}

// The attempts that are decoded, of all hypotheses: a mark that can be read is among the first few.
constexpr std::size_t kDecoded = 256;

// Bits of evidence, far above what the order of a sum changes.
constexpr double kRoundingOfEvidence = 1e-6;

class FluxReader {
 public:
  explicit FluxReader(const Key& key) : dither_(key), axes_(axes_guesses()) {
    for (const FluxContent content : kFluxContents) {
      for (const int bits : kPayloadBits) codes_.emplace_back(key, content, bits);
    }
    fixed_price_ = std::log2(static_cast<double>(codes_.size() * kSteps * kSharpness.size()));
  }

  // Returns the best payload of the guesses if it can be believed.
  [[nodiscard]] std::optional<FluxFound> read(std::span<const Guess> guesses) const {
    std::vector<Attempt> attempts = promising(guesses);
    std::vector<std::optional<FluxFound>> found(attempts.size());
    parallel_for(attempts.size(), [&](std::size_t i) { found[i] = decoded(attempts[i]); });
    std::optional<FluxFound> best;
    for (std::optional<FluxFound>& one : found) {
      if (one && (!best || one->evidence > best->evidence)) best = std::move(one);
    }
    return best;
  }

  // Adds the soft readings of the guesses of which the pilots say most.
  void add_soft_readings(std::span<const Guess> guesses,
                         std::vector<FluxSoftReading>& readings) const {
    for (const Attempt& attempt : promising(guesses, true)) {
      const SoftPhases phases = soft_phases(attempt.guess->measurement, attempt.axes->source,
                                            dither_, step_size(attempt.step));
      const double prior = -attempt.guess->price - attempt.axes->price -
                           std::log2(static_cast<double>(kSteps * kSharpness.size()));
      for (const double sharpness : kSharpness) {
        readings.push_back({phases, sharpness, prior, likelihood_of_pilots(phases, sharpness),
                            attempt.guess->undone});
      }
    }
  }

  // Returns the most that speaks for a word under any of the guesses.
  [[nodiscard]] FluxEvidence evidence(std::span<const Guess> guesses, const FluxBits& word) const {
    const std::size_t count = guesses.size() * axes_.size() * kSteps;
    std::vector<double> all(count);
    const auto guess_of = [&](std::size_t i) -> const Guess& {
      return guesses[i / (axes_.size() * kSteps)];
    };
    parallel_for(
        count,
        [&](std::size_t i) {
          const AxesGuess& axes = axes_[i / kSteps % axes_.size()];
          double most = -std::numeric_limits<double>::infinity();
          for (const double sharpness : kSharpness) {
            const SoftBits soft = soft_bits(guess_of(i).measurement, axes.source, dither_,
                                            step_size(i % kSteps), sharpness);
            most = std::max(most, soft.evidence(word));
          }
          all[i] = most - guess_of(i).price - axes.price -
                   std::log2(static_cast<double>(kSteps * kSharpness.size()));
        },
        kSteps);
    const auto best = std::max_element(all.begin(), all.end());
    return {*best, guess_of(static_cast<std::size_t>(best - all.begin())).undone};
  }

 private:
  [[nodiscard]] std::vector<Attempt> promising(std::span<const Guess> guesses,
                                               bool by_pilots = false) const {
    std::vector<Attempt> attempts;
    for (const Guess& guess : guesses) {
      for (const AxesGuess& axes : axes_) {
        for (std::size_t step = 0; step < kSteps; ++step)
          attempts.push_back({&guess, &axes, step, 0});
      }
    }
    parallel_for(
        attempts.size(),
        [&](std::size_t i) {
          Attempt& a = attempts[i];
          const auto promise = by_pilots ? promise_of_pilots : promise_of;
          a.promise = promise(a.guess->measurement, *a.axes, dither_, step_size(a.step));
        },
        kOctants * kSteps);
    std::stable_sort(attempts.begin(), attempts.end(),
                     [](const Attempt& a, const Attempt& b) { return a.promise > b.promise; });
    attempts.resize(std::min(attempts.size(), kDecoded));
    return attempts;
  }

  [[nodiscard]] std::optional<FluxFound> decoded(const Attempt& attempt) const {
    std::optional<FluxFound> best;
    for (const double sharpness : kSharpness) {
      const SoftBits soft = soft_bits(attempt.guess->measurement, attempt.axes->source, dither_,
                                      step_size(attempt.step), sharpness);
      const double price = fixed_price_ + attempt.guess->price + attempt.axes->price;
      std::optional<SoftOrder> order;
      for (const BlockCode& code : codes_) {
        // What no word of the code reaches need not be decoded.
        const double needed = std::max(kBelieved, best ? best->evidence : 0) + price + code.bits();
        if (soft.most_evidence() < needed - kRoundingOfEvidence) continue;
        if (!order) order.emplace(soft);
        const auto payload = code.decode(*order, needed - kRoundingOfEvidence);
        if (!payload) continue;
        const FluxBits word = code.encode(*payload);
        const double evidence = soft.evidence(word) - price - code.bits();
        if (evidence < kBelieved || (best && evidence <= best->evidence)) continue;
        best = FluxFound{{*payload, code.bits(), code.content()}, evidence, attempt.guess->undone};
      }
    }
    return best;
  }

  Dither dither_;
  std::vector<AxesGuess> axes_;
  std::vector<BlockCode> codes_;
  double fixed_price_ = 0;
};

// Calls try_all(guesses) with more and more hypotheses of what was done to the surface, the
// likeliest and quickest first, until it returns true.
template <typename TryAll>
void for_guesses(const Surface& surface, const TryAll& try_all) {
  const Subject subject(surface);
  const auto frame = subject.frame();
  if (!frame) return;
  const std::vector<Vec3>& positions = surface.mesh.positions;
  const std::optional<FluxValues> here = subject.values(positions);
  if (!here) return;
  std::vector<Guess> guesses = {{measured(*here), -std::log2(kPlainPrior), ""}};
  if (subject.has_holes()) {
    const auto first = Subject(surface, EdgeWeight::One).values(positions);
    if (first) guesses.push_back({measured(*first), -std::log2(kFirstPrior), ""});
  }
  if (try_all(guesses)) return;

  guesses.clear();
  const UniformFlow flow(surface.mesh);
  add_line(*here, subject.values(flow.smoothed(positions, kUniformSteps)), kUniformLine,
           kUniformPrior, "smoothing along a line", guesses);
  const double time = kFlowTime * frame->scale * frame->scale;
  add_line(*here, subject.values(curvature_flowed(surface.mesh, time)), kCurvatureLine,
           kCurvaturePrior, "curvature flow", guesses);
  if (try_all(guesses)) return;

  guesses.clear();
  if (mean_edge_length(surface.mesh) < kFineEdge * kShellWidth * frame->scale) return;
  const double price = -std::log2(kUnsmoothedPrior / double{kUnsmoothedSteps.size()});
  for (const int steps : kUnsmoothedSteps) {
    const auto before = subject.values(flow.unsmoothed(positions, steps, kUnsmoothedIterations));
    if (!before) break;
    guesses.push_back({measured(*before), price, amount("smoothing", steps)});
  }
  try_all(guesses);
}

// Hypotheses that are less likely than the best by so many bits add nothing. Where no hypothesis is
// likelier than that there is no mark, all are kept.
constexpr double kNegligibleWeight = 24;

// Steps by which a functional may be doubted and still tell something.
constexpr double kMostDoubt = 0.15;

// Names the pilots among the uses of random numbers.
constexpr std::uint64_t kPilots = 0x70696c6f74;  // "pilot"
constexpr std::uint64_t kOneInPilots = 4;

}  // namespace

bool is_pilot(std::size_t functional) {
  return random_bits(kPilots, 0, functional) % kOneInPilots == 0;
}

std::optional<FluxFound> read_flux(const Surface& surface, const Key& key, FluxEffort effort) {
  const FluxReader reader(key);
  std::optional<FluxFound> found;
  for_guesses(surface, [&](std::span<const Guess> guesses) {
    found = reader.read(guesses);
    return found.has_value() || effort == FluxEffort::AsItIs;
  });
  return found;
}

// The axes are those of the original, so that steps and sharpnesses are the only hypotheses.
std::vector<FluxSoftReading> read_flux_of_estimate(const FluxCanvas::Estimate& estimate,
                                                   const Key& key) {
  const Dither dither(key);
  std::array<std::uint8_t, kFunctionals> own{};
  std::iota(own.begin(), own.end(), std::uint8_t{0});
  std::vector<FluxSoftReading> readings;
  for (std::size_t step = 0; step < kSteps; ++step) {
    Measurement measurement = estimate.measurement;
    for (std::size_t i = 0; i < kFunctionals; ++i) {
      if (estimate.doubts[i] > kMostDoubt * step_size(step)) measurement[i].used = 0;
    }
    const SoftPhases phases = soft_phases(measurement, own, dither, step_size(step));
    for (const double sharpness : kSharpness) {
      FluxSoftReading& reading = readings.emplace_back();
      reading.phases = phases;
      reading.sharpness = sharpness;
      reading.prior = -std::log2(static_cast<double>(kSteps * kSharpness.size()));
      reading.likelihood = likelihood_of_pilots(phases, sharpness);
    }
  }
  return readings;
}

std::vector<FluxSoftReading> read_flux_softly(const Surface& surface, const Key& key,
                                              FluxEffort effort) {
  const FluxReader reader(key);
  std::vector<FluxSoftReading> readings;
  for_guesses(surface, [&](std::span<const Guess> guesses) {
    reader.add_soft_readings(guesses, readings);
    return effort == FluxEffort::AsItIs;
  });
  double most = 0;
  for (const FluxSoftReading& reading : readings)
    most = std::max(most, reading.prior + reading.likelihood);
  std::erase_if(readings, [&](const FluxSoftReading& reading) {
    return reading.prior + reading.likelihood < most - kNegligibleWeight;
  });
  return readings;
}

FluxEvidence flux_evidence(const Surface& surface, const Key& key, const FluxBits& word) {
  const FluxReader reader(key);
  FluxEvidence best{-std::numeric_limits<double>::infinity(), ""};
  for_guesses(surface, [&](std::span<const Guess> guesses) {
    FluxEvidence next = reader.evidence(guesses, word);
    if (next.evidence > best.evidence) best = std::move(next);
    return best.evidence >= kBelieved;
  });
  return best;
}

}  // namespace triglyph
