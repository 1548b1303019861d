#include "engine/metric/comparison.h"

#include <algorithm>
#include <array>

#include "engine/base/error.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/deformation.h"
#include "engine/metric/roughness.h"
#include "engine/metric/sampled_distance.h"
#include "engine/metric/structural_distortion.h"

namespace triglyph {
namespace {

using Values = std::vector<NamedValue>;

Values hausdorff_values(const Mesh& first, const Mesh& second, double tolerance) {
  const double diagonal = surface_diagonal(first);
  const HausdorffDistance distance = have_same_triangles(first, second)
                                         ? hausdorff_of_move(first.triangles, first.positions,
                                                             second.positions, tolerance * diagonal)
                                         : hausdorff(first, second, tolerance * diagonal);
  return {{"hausdorff_forward", distance.forward.distance},
          {"hausdorff_backward", distance.backward.distance},
          {"hausdorff", distance.symmetric()},
          {"hausdorff_error", distance.error()},
          {"hausdorff_rel_diag", diagonal > 0 ? distance.symmetric() / diagonal : 0}};
}

Values displacement_values(const Mesh& first, const Mesh& second, double) {
  const Displacement moved = displacement(first.positions, second.positions);
  return {{"displacement_max", moved.max},
          {"displacement_mean", moved.mean},
          {"displacement_rms", moved.rms}};
}

Values two_way_values(const std::string& name, const TwoWayStatistics& statistics) {
  const auto& [forward, backward] = statistics;
  return {{name + "_max_forward", forward.max},     {name + "_mean_forward", forward.mean},
          {name + "_rms_forward", forward.rms},     {name + "_max_backward", backward.max},
          {name + "_mean_backward", backward.mean}, {name + "_rms_backward", backward.rms}};
}

Values metro_values(const Mesh& first, const Mesh& second, double) {
  const TwoWayStatistics statistics = metro(first, second);
  Values values = two_way_values("metro", statistics);
  values.push_back({"metro_hausdorff", std::max(statistics.forward.max, statistics.backward.max)});
  values.push_back({"metro_samples",
                    static_cast<double>(statistics.forward.samples + statistics.backward.samples)});
  return values;
}

Values mrms_values(const Mesh& first, const Mesh& second, double) {
  const double diagonal = surface_diagonal(first);
  const double greater = std::max(diagonal, surface_diagonal(second));
  const TwoWayStatistics statistics = mesh_distance(first, second, kMeshStep * greater);
  Values values = two_way_values("mesh", statistics);
  const double mrms = std::max(statistics.forward.rms, statistics.backward.rms);
  values.push_back({"mrms", mrms});
  values.push_back({"mrms_rel_diag", diagonal > 0 ? mrms / diagonal : 0});
  return values;
}

Values msdm_values(const Mesh& first, const Mesh& second, double) {
  return {{"msdm", msdm(first, second)}};
}
Values msdm2_values(const Mesh& first, const Mesh& second, double) {
  return {{"msdm2", msdm2(first, second)}};
}
Values roughness_values(const Mesh& first, const Mesh& second, double) {
  const double before = roughness(first);
  const double after = roughness(second);
  return {{"roughness_first", before},
          {"roughness_second", after},
          {"roughness_increase", roughness_increase(before, after)}};
}
Values strain_values(const Mesh& first, const Mesh& second, double) {
  return {{"strain", strain(first.triangles, first.positions, second.positions)}};
}
Values normal_values(const Mesh& first, const Mesh& second, double) {
  const NormalDeviation angles =
      normal_deviation(first.triangles, first.positions, second.positions);
  return {{"normal_deviation_max_degrees", angles.max},
          {"normal_deviation_mean_degrees", angles.mean}};
}
Values snr_values(const Mesh& first, const Mesh& second, double) {
  return {{"snr_db", signal_to_noise(first.positions, second.positions)}};
}

struct Metric {
  std::string_view name;
  bool needs_same_triangles;
  Values (*values)(const Mesh& first, const Mesh& second, double tolerance);
};

constexpr std::array<Metric, 10> kMetrics = {{{"hausdorff", false, hausdorff_values},
                                              {"displacement", true, displacement_values},
                                              {"metro", false, metro_values},
                                              {"mrms", false, mrms_values},
                                              {"msdm", true, msdm_values},
                                              {"msdm2", false, msdm2_values},
                                              {"roughness", false, roughness_values},
                                              {"strain", true, strain_values},
                                              {"normal", true, normal_values},
                                              {"snr", true, snr_values}}};

const Metric& metric_named(std::string_view name) {
  const auto found = std::find_if(kMetrics.begin(), kMetrics.end(),
                                  [&](const Metric& metric) { return metric.name == name; });
  if (found == kMetrics.end()) {
    throw Error(ErrorCode::Usage, {}, "", "no metric named " + std::string(name));
  }
  return *found;
}

}  // namespace

std::span<const std::string_view> metric_names() {
  static const std::array<std::string_view, kMetrics.size()> names = [] {
    std::array<std::string_view, kMetrics.size()> all;
    std::transform(kMetrics.begin(), kMetrics.end(), all.begin(),
                   [](const Metric& metric) { return metric.name; });
    return all;
  }();
  return names;
}

bool needs_same_triangles(std::string_view metric) {
  return metric_named(metric).needs_same_triangles;
}

bool have_same_triangles(const Mesh& first, const Mesh& second) {
  return first.positions.size() == second.positions.size() && first.triangles == second.triangles;
}

std::vector<NamedValue> compare(const Mesh& first, const Mesh& second, std::string_view metric,
                                double hausdorff_tolerance) {
  const Metric& chosen = metric_named(metric);
  if (first.triangles.empty() || second.triangles.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "a mesh without faces cannot be compared");
  }
  if (chosen.needs_same_triangles && !have_same_triangles(first, second)) {
    throw Error(ErrorCode::Usage, {}, "",
                std::string(metric) + " compares two positions of the same triangles, but " +
                    "these meshes have different ones");
  }
  return chosen.values(first, second, hausdorff_tolerance);
}

}  // namespace triglyph
