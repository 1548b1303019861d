#include "engine/attack/attack.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "engine/attack/coordinates.h"
#include "engine/attack/indexing.h"
#include "engine/attack/isotropic_remesh.h"
#include "engine/attack/motions.h"
#include "engine/attack/parts.h"
#include "engine/attack/simplification.h"
#include "engine/attack/subdivision.h"
#include "engine/attack/voxel_remesh.h"
#include "engine/base/error.h"
#include "engine/base/options.h"
#include "engine/base/random.h"
#include "engine/base/text.h"
#include "engine/mesh/edge_length.h"

namespace triglyph {
namespace {

using Seed = std::uint64_t;

template <Mesh (*Refine)(const Mesh&)>
Mesh refined(const Mesh& mesh, double levels, Seed) {
  Mesh result = mesh;
  for (int level = 0; level < static_cast<int>(levels); ++level) result = Refine(result);
  return result;
}

constexpr AttackParameter percent_removed(std::string_view meaning, double most) {
  return {meaning, 0, most, false, std::nullopt};
}
constexpr AttackParameter bits(double most) {
  return {"bits a coordinate", 1, most, true, std::nullopt};
}
constexpr AttackParameter levels(double most) {
  return {"levels", 1, most, true, 1};
}

constexpr auto kKinds = std::to_array<AttackKind>(
    {{"none",
      "only store the mesh, as every attack does in the end",
      {},
      false,
      [](const Mesh& mesh, double, Seed) { return mesh; }},
     {"reorder",
      "list points and triangles in another order, each triangle from any corner",
      {},
      true,
      [](const Mesh& mesh, double, Seed seed) { return reordered(mesh, seed); }},
     {"similarity",
      "rotate, scale by 0.001 to 1000, and shift by up to a diagonal",
      {},
      true,
      [](const Mesh& mesh, double, Seed seed) { return similarly_mapped(mesh, seed); }},
     {"affine", "map affinely, in directions drawn by lot",
      AttackParameter{"greatest stretch in terms of the least", 1, 100, false, std::nullopt}, true,
      [](const Mesh& mesh, double number, Seed seed) {
        return affinely_mapped(mesh, number, seed);
      }},
     {"mirror",
      "make the mirror image, wound so that outside stays outside",
      {},
      false,
      [](const Mesh& mesh, double, Seed) { return mirrored(mesh); }},
     {"flip",
      "wind every triangle the other way",
      {},
      false,
      [](const Mesh& mesh, double, Seed) { return flipped(mesh); }},
     {"noise", "shift every coordinate at random, uniformly",
      AttackParameter{"percent of the points' mean distance from their centroid, at most", 0, 100,
                      false, std::nullopt},
      true,
      [](const Mesh& mesh, double number, Seed seed) {
        return with_uniform_noise(mesh, number / 100, seed);
      }},
     {"smooth", "move each point a tenth of the way to the mean of its neighbours, in rounds",
      AttackParameter{"rounds", 1, 10000, true, std::nullopt}, false,
      [](const Mesh& mesh, double number, Seed) {
        return smoothed(mesh, static_cast<int>(number));
      }},
     {"quantise", "round coordinates to 2^bits intervals of the box, an axis at a time", bits(24),
      false,
      [](const Mesh& mesh, double number, Seed) {
        return quantised(mesh, static_cast<int>(number));
      }},
     {"draco", "round coordinates to cubes, 2^bits - 1 along the box's longest side", bits(24),
      false,
      [](const Mesh& mesh, double number, Seed) {
        return quantised_to_cubes(mesh, static_cast<int>(number));
      }},
     {"digits", "write coordinates with few digits",
      AttackParameter{"significant digits", 1, 17, true, std::nullopt}, false,
      [](const Mesh& mesh, double number, Seed) {
        return with_significant_digits(mesh, static_cast<int>(number));
      }},
     {"half",
      "store coordinates as half floats, from -1 to 1",
      {},
      false,
      [](const Mesh& mesh, double, Seed) { return as_half_floats(mesh); }},
     {"weld", "join points that are close to each other",
      AttackParameter{"percent of the box's diagonal, below which they are", 0, 10, false, 0.01},
      false, [](const Mesh& mesh, double number, Seed) { return welded(mesh, number / 100); }},
     {"soup",
      "give every triangle points of its own",
      {},
      false,
      [](const Mesh& mesh, double, Seed) { return as_soup(mesh); }},
     {"midpoint", "cut each triangle into four and keep the shape", levels(4), false,
      refined<subdivided_at_midpoints>},
     {"loop", "subdivide after Loop", levels(4), false, refined<subdivided_by_loop>},
     {"sqrt3", "subdivide after Kobbelt", levels(5), false, refined<subdivided_by_sqrt3>},
     {"simplify", "collapse edges in the order of the quadric error",
      percent_removed("percent of the triangles to remove", 99.9), false,
      [](const Mesh& mesh, double number, Seed) { return simplified(mesh, number / 100); }},
     {"crop", "cut off a piece by a plane drawn by lot",
      percent_removed("percent of the triangles to remove", 99.9), true,
      [](const Mesh& mesh, double number, Seed seed) { return cropped(mesh, number / 100, seed); }},
     {"parts", "add a ball beside the mesh, with edges as long",
      AttackParameter{"triangles of the ball in percent of the mesh's", 0.1, 100, false, 20}, true,
      [](const Mesh& mesh, double number, Seed seed) {
        return with_added_ball(mesh, number / 100, seed);
      }},
     {"remesh", "triangulate the surface anew with edges of one length",
      AttackParameter{"edge length in percent of the mean", 25, 1000, false, 100}, false,
      [](const Mesh& mesh, double number, Seed) {
        return remeshed_isotropically(mesh, number / 100 * mean_edge_length(mesh));
      }},
     {"voxel", "make the surface anew from voxels",
      AttackParameter{"voxels along the box's longest side", 2, 512, true, std::nullopt}, false,
      [](const Mesh& mesh, double number, Seed) {
        return remeshed_by_voxels(mesh, static_cast<int>(number));
      }}});

[[noreturn]] void refuse(std::string_view step, const std::string& reason) {
  throw Error(ErrorCode::Usage, {}, "", "attack \"" + std::string(step) + "\": " + reason);
}

const AttackKind& kind_named(std::string_view name, std::string_view step) {
  std::vector<std::string> names;
  for (const AttackKind& kind : kKinds) {
    if (kind.name == name) return kind;
    names.emplace_back(kind.name);
  }
  std::string reason = "there is no attack of that name";
  if (const auto closest = closest_word(name, names)) {
    refuse(step, reason + "; did you mean " + *closest + "?");
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    reason += (i == 0 ? "; it is one of " : ", ") + names[i];
  refuse(step, reason);
}

// "percent of the triangles to remove, 0 to 99.9".
std::string domain_of(const AttackParameter& parameter) {
  return (parameter.is_whole ? "a whole number, " : "a number, ") + std::string(parameter.meaning) +
         ", " + to_text(OptionValue(parameter.least)) + " to " +
         to_text(OptionValue(parameter.most));
}

double number_of(const AttackKind& kind, std::optional<std::string_view> text,
                 std::string_view step) {
  if (!kind.parameter) {
    if (text) refuse(step, std::string(kind.name) + " takes no number");
    return 0;
  }
  const AttackParameter& parameter = *kind.parameter;
  if (!text) {
    if (parameter.usual) return *parameter.usual;
    refuse(step, std::string(kind.name) + ":N needs " + domain_of(parameter));
  }
  double number = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), number);
  const bool is_number = error == std::errc() && end == text->data() + text->size();
  const bool is_valid = is_number && number >= parameter.least && number <= parameter.most &&
                        (!parameter.is_whole || number == std::floor(number));
  if (!is_valid) refuse(step, std::string(kind.name) + ":N takes " + domain_of(parameter));
  return number;
}

constexpr std::array<std::string_view, 3> kProtocolNames = {"benchmark", "leaks", "all"};

constexpr std::array<std::string_view, 28> kBenchmark = {
    "none",        "reorder",     "similarity",  "noise:0.05",  "noise:0.1",   "noise:0.3",
    "noise:0.5",   "smooth:5",    "smooth:10",   "smooth:30",   "smooth:50",   "quantise:11",
    "quantise:10", "quantise:9",  "quantise:8",  "quantise:7",  "midpoint",    "loop",
    "sqrt3",       "simplify:10", "simplify:30", "simplify:50", "simplify:70", "simplify:90",
    "simplify:95", "crop:10",     "crop:30",     "crop:50"};

// note: what happens to copies, in our judgement: converters, compression, printing, repair, games,
// sale as an own model. No study of leaked meshes is known to us.
constexpr std::array<std::string_view, 25> kLeaks = {"none",
                                                     "soup",
                                                     "flip",
                                                     "mirror",
                                                     "digits:6",
                                                     "digits:4",
                                                     "similarity+digits:6",
                                                     "half",
                                                     "weld:0.01",
                                                     "draco:14",
                                                     "draco:11",
                                                     "similarity+quantise:12",
                                                     "affine:2",
                                                     "parts:20",
                                                     "crop:10+reorder",
                                                     "smooth:1",
                                                     "noise:0.01",
                                                     "simplify:50+draco:14",
                                                     "simplify:50+noise:0.1",
                                                     "smooth:5+simplify:50",
                                                     "remesh",
                                                     "remesh+noise:0.05",
                                                     "voxel:128",
                                                     "voxel:256",
                                                     "loop+simplify:75"};

void append(std::span<const std::string_view> texts, std::vector<Attack>& attacks) {
  for (const std::string_view text : texts) {
    Attack attack = Attack::parsed(text);
    const bool is_known = std::any_of(attacks.begin(), attacks.end(), [&](const Attack& other) {
      return other.text() == attack.text();
    });
    if (!is_known) attacks.push_back(std::move(attack));
  }
}

}  // namespace

std::span<const AttackKind> attack_kinds() {
  return kKinds;
}

Attack Attack::parsed(std::string_view text) {
  Attack attack;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('+', begin), text.size());
    const std::string_view step = text.substr(begin, end - begin);
    if (step.empty()) refuse(text, "an empty name; attacks are joined as in simplify:50+noise:0.1");
    const std::size_t colon = step.find(':');
    const AttackKind& kind = kind_named(step.substr(0, colon), step);
    const auto number = colon == step.npos ? std::nullopt : std::optional(step.substr(colon + 1));
    attack.steps_.push_back({&kind, number_of(kind, number, step)});
    begin = end + 1;
  }
  return attack;
}

std::string Attack::text() const {
  std::string text;
  for (const auto& [kind, number] : steps_) {
    if (!text.empty()) text += '+';
    text += kind->name;
    if (!kind->parameter || kind->parameter->usual == number) continue;
    text += ':';
    text += to_text(OptionValue(number));
  }
  return text;
}

bool Attack::draws_lots() const {
  return std::any_of(steps_.begin(), steps_.end(),
                     [](const Step& step) { return step.kind->draws_lots; });
}

Mesh Attack::applied(const Mesh& mesh, std::uint64_t seed) const {
  Mesh result = mesh;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    // the first step has the seed itself, so that it does the same in a row as alone
    const std::uint64_t own = i == 0 ? seed : random_bits(seed, i, 0);
    result = steps_[i].kind->apply(result, steps_[i].number, own);
  }
  return result;
}

std::span<const std::string_view> protocol_names() {
  return kProtocolNames;
}

std::vector<Attack> protocol(std::string_view name) {
  if (std::find(kProtocolNames.begin(), kProtocolNames.end(), name) == kProtocolNames.end()) {
    throw Error(ErrorCode::Usage, {}, "",
                "no protocol named " + std::string(name) + "; there are benchmark, leaks and all");
  }
  std::vector<Attack> attacks;
  if (name != "leaks") append(kBenchmark, attacks);
  if (name != "benchmark") append(kLeaks, attacks);
  return attacks;
}

}  // namespace triglyph
