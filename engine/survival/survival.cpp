#include "engine/survival/survival.h"

#include <algorithm>
#include <optional>

#include "engine/attack/stored_mesh.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/metric/comparison.h"
#include "engine/metric/deformation.h"
#include "engine/metric/hausdorff.h"
#include "engine/survival/trial.h"

namespace triglyph {
namespace {

double value_of(const std::vector<NamedValue>& values, std::string_view name) {
  const auto found = std::find_if(values.begin(), values.end(),
                                  [&](const NamedValue& value) { return value.name == name; });
  check(found != values.end(), "a metric gives the values that its name stands for");
  return found->value;
}

double measured(const Mesh& before, const Mesh& after, std::string_view metric,
                std::string_view name) {
  return value_of(compare(before, after, metric, kHausdorffTolerance), name);
}

MarkDistortion distortion_of(const Mesh& before, const std::vector<TrialMark>& marks) {
  MarkDistortion result;
  double count = 0;
  for (const TrialMark& mark : marks) {
    if (!mark.is_marked()) continue;
    if (count == 0) {
      result.mrms_rel_diag = measured(before, mark.mesh, "mrms", "mrms_rel_diag");
      result.msdm2 = measured(before, mark.mesh, "msdm2", "msdm2");
    }
    count += 1;
    result.hausdorff_rel_diag = std::max(
        result.hausdorff_rel_diag, measured(before, mark.mesh, "hausdorff", "hausdorff_rel_diag"));
    const NormalDeviation turned =
        normal_deviation(before.triangles, before.positions, mark.mesh.positions);
    result.normal_mean_degrees += turned.mean;
    result.normal_max_degrees = std::max(result.normal_max_degrees, turned.max);
  }
  if (count > 0) result.normal_mean_degrees /= count;
  return result;
}

// Returns nothing if the mesh is too large for the attack.
std::optional<TrialReading> trial(const Attack& attack, std::uint64_t seed, const TrialMark& mark,
                                  const Key& key) {
  Mesh attacked;
  try {
    attacked = attack.applied(mark.mesh, seed);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Unsupported) throw;
    return std::nullopt;
  }
  return read_for_trial(stored(attacked), mark, key);
}

void count(const std::optional<TrialReading>& reading, AttackSurvival& into) {
  if (!reading) {
    ++into.not_applied;
    return;
  }
  into.wrong_bits.push_back(reading->wrong_bits);
  if (!reading->is_recovered) return;
  ++into.recovered;
  into.worst_false_alarm = std::max(into.worst_false_alarm, reading->false_alarm);
}

}  // namespace

double AttackSurvival::median_wrong_bits() const {
  if (wrong_bits.empty()) return 1;
  std::vector<double> sorted = wrong_bits;
  std::sort(sorted.begin(), sorted.end());
  return (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
}

double AttackSurvival::worst_wrong_bits() const {
  return wrong_bits.empty() ? 1 : *std::max_element(wrong_bits.begin(), wrong_bits.end());
}

SchemeSurvival survive(const Mesh& mesh, const MarkRequest& request,
                       std::span<const Attack> attacks, const SurvivalOptions& options) {
  const Mesh before = stored(mesh);
  const auto keys = static_cast<std::size_t>(options.keys);
  std::vector<TrialMark> marks(keys);
  parallel_for(keys, [&](std::size_t key) {
    marks[key] = mark_for_trial(before, request, Key::trial(key));
  });
  std::vector<std::optional<TrialReading>> readings(keys * attacks.size());
  parallel_for(readings.size(), [&](std::size_t i) {
    const std::size_t key = i % keys;
    if (!marks[key].is_marked()) return;
    const std::uint64_t seed = random_bits(options.seed, 0, key);
    readings[i] = trial(attacks[i / keys], seed, marks[key], Key::trial(key));
  });
  SchemeSurvival result;
  result.meshes_tried = static_cast<std::uint32_t>(keys);
  for (const TrialMark& mark : marks) {
    if (mark.is_marked()) ++result.marked;
    if (result.refusal.empty()) result.refusal = mark.refusal;
  }
  result.distortion = distortion_of(before, marks);
  for (std::size_t a = 0; a < attacks.size(); ++a) {
    AttackSurvival& survival = result.attacks.emplace_back();
    survival.attack = attacks[a].text();
    for (std::size_t key = 0; key < keys; ++key) {
      if (marks[key].is_marked()) count(readings[a * keys + key], survival);
    }
  }
  return result;
}

SchemeSurvival combined(std::span<const SchemeSurvival> parts) {
  SchemeSurvival all;
  double marked_parts = 0;
  for (const SchemeSurvival& part : parts) {
    all.meshes_tried += part.meshes_tried;
    all.marked += part.marked;
    if (all.refusal.empty()) all.refusal = part.refusal;
    all.attacks.resize(part.attacks.size());
    for (std::size_t a = 0; a < part.attacks.size(); ++a) {
      const AttackSurvival& from = part.attacks[a];
      AttackSurvival& into = all.attacks[a];
      into.attack = from.attack;
      into.wrong_bits.insert(into.wrong_bits.end(), from.wrong_bits.begin(), from.wrong_bits.end());
      into.recovered += from.recovered;
      into.worst_false_alarm = std::max(into.worst_false_alarm, from.worst_false_alarm);
      into.not_applied += from.not_applied;
    }
    if (part.marked == 0) continue;
    marked_parts += 1;
    MarkDistortion& sum = all.distortion;
    sum.mrms_rel_diag += part.distortion.mrms_rel_diag;
    sum.msdm2 += part.distortion.msdm2;
    sum.normal_mean_degrees += part.distortion.normal_mean_degrees;
    sum.hausdorff_rel_diag = std::max(sum.hausdorff_rel_diag, part.distortion.hausdorff_rel_diag);
    sum.normal_max_degrees = std::max(sum.normal_max_degrees, part.distortion.normal_max_degrees);
  }
  if (marked_parts > 0) {
    all.distortion.mrms_rel_diag /= marked_parts;
    all.distortion.msdm2 /= marked_parts;
    all.distortion.normal_mean_degrees /= marked_parts;
  }
  return all;
}

}  // namespace triglyph
