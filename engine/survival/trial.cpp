#include "engine/survival/trial.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/attack/stored_mesh.h"
#include "engine/base/error.h"
#include "engine/marking/extract.h"
#include "engine/marking/mark.h"
#include "engine/marking/refusal.h"
#include "engine/message/votes.h"

namespace triglyph {
namespace {

// The distance between neighbouring floats at the largest coordinate that occurs.
double float_step(const Mesh& mesh) {
  double most = 0;
  for (const Vec3& p : mesh.positions) most = std::max(most, p.max_abs());
  const auto largest = static_cast<float>(most);
  return std::nextafter(largest, std::numeric_limits<float>::infinity()) - largest;
}

double wrong_share(std::span<const Reading> readings, const Message& message,
                   const WordCode& code) {
  Votes votes(code);
  for (const Reading& reading : readings) votes.add(reading);
  const std::vector<std::optional<std::uint32_t>> read = votes.parts();
  const std::vector<Word> words = code.words_of(message);
  const int bits = code.format().part_bits;
  int wrong = 0;
  for (const Word& word : words) {
    const auto& part = read[code.part_index(word.subscript)];
    wrong += part ? std::popcount(*part ^ word.part) : bits;
  }
  return wrong / (static_cast<double>(bits) * static_cast<double>(words.size()));
}

// A payload of another kind has no bit that is right.
double wrong_share(const FluxPayload& found, const FluxPayload& hidden) {
  if (found.bits != hidden.bits || found.content != hidden.content) return 1;
  return std::popcount(found.value ^ hidden.value) / static_cast<double>(hidden.bits);
}

}  // namespace

TrialMark mark_for_trial(const Mesh& mesh, const MarkRequest& request, const Key& key) {
  if (request.is_fill()) {
    throw Error(ErrorCode::Usage, {}, "", "fill carries no message that could survive");
  }
  const Halfedges halfedges = build_halfedges(mesh);
  const double step = float_step(mesh);
  Marking marking = mark({mesh, halfedges}, request.payload, key, request.options, as_float, step);
  TrialMark result;
  if (marking.status != MarkStatus::Marked) {
    result.refusal = refusal(marking, request, step);
    return result;
  }
  result.mesh = {std::move(marking.positions), mesh.triangles};
  result.encoding = request.options.encoding();
  result.encoding.format = marking.format;
  if (!marking.scheme_options.empty()) result.encoding.scheme_options = marking.scheme_options;
  result.message = request.message();
  result.flux = marking.flux;
  result.has_units = !marking.words.empty();
  return result;
}

TrialReading read_for_trial(const Mesh& mesh, const TrialMark& mark, const Key& key) {
  TrialReading result;
  if (mesh.triangles.empty()) return result;  // nothing is left to be read
  const Halfedges halfedges = build_halfedges(mesh);
  if (mark.flux) {
    if (const auto flux = read_flux({mesh, halfedges}, key)) {
      result.is_recovered = flux->payload == mark.flux->payload;
      result.wrong_bits = wrong_share(flux->payload, mark.flux->payload);
      result.false_alarm = std::exp2(-flux->evidence);
      if (result.is_recovered) return result;
    }
  }
  if (!mark.has_units) return result;
  const Extraction found = extract({mesh, halfedges}, mark.encoding, key);
  result.is_recovered = found.message == mark.message;
  result.wrong_bits =
      wrong_share(found.readings, mark.message, WordCode(key, mark.encoding.format));
  result.false_alarm = found.false_alarm;
  return result;
}

}  // namespace triglyph
