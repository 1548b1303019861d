// A flux mark as a whole: which payload a mesh can hold, and the mesh that holds it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/flux/flux_embedding.h"
#include "engine/flux/flux_reading.h"
#include "engine/message/words.h"

namespace triglyph {

// Returns the payload of so many bits that stands for a message: the message itself if it has just
// as many, else its number.
[[nodiscard]] FluxPayload flux_payload(std::span<const std::uint8_t> message, const Key& key,
                                       int bits);

// Returns the message that a payload holds; nothing for a number.
[[nodiscard]] std::optional<Message> message_in(const FluxPayload& payload);

// Returns the bytes of a payload, the lowest first.
[[nodiscard]] std::vector<std::uint8_t> bytes_of(const FluxPayload& payload);

// Says whether a payload stands for a message: holds it, or is its number.
[[nodiscard]] bool stands_for(const FluxPayload& payload, std::span<const std::uint8_t> message,
                              const Key& key);

// Returns "message 0x.." or "number 3f2a" in hexadecimal digits, as many as the bits.
[[nodiscard]] std::string shown(const FluxPayload& payload);

struct FluxMark {
  FluxPayload payload;
  double step = 0;                // of the lattices, normalised
  double rms_percent = 0;         // of the moves, of the surface's diagonal
  double expected_evidence = 0;   // bits, after usual noise and quantisation
  std::uint32_t functionals = 0;  // that carry a bit
};

struct FluxMarking {
  FluxObstacle obstacle = FluxObstacle::None;
  FluxMark mark;  // of no meaning with an obstacle, as the positions
  std::vector<Vec3> positions;
};

// What a flux mark may do to a mesh.
struct FluxBounds {
  double rms_percent = 0.07;  // root mean square of the moves, of the surface's diagonal
  double max_percent = 0;     // farthest move, likewise; 0: no limit
  double visibility = 0;      // MSDM2 against the mesh before; 0: no limit
};

// Marks a surface with the largest payload that a reader will find after usual noise, at most as
// large as the message. `rounding` returns the nearest point that the output can hold. Does not
// read the mark back. Deterministic for any number of threads.
[[nodiscard]] FluxMarking mark_flux(const Surface& surface, std::span<const std::uint8_t> message,
                                    const Key& key, const FluxBounds& bounds,
                                    const std::function<Vec3(const Vec3&)>& rounding);

// Marks a surface with a word that says itself what it stands for, if a reader who knows the word
// will find it after little noise. The canvas is that of the surface; As mark_flux(), and may be
// called from several threads at a time.
[[nodiscard]] FluxMarking mark_flux_word(const Surface& surface, const FluxCanvas& canvas,
                                         const FluxPhases& word, const Key& key,
                                         const FluxBounds& bounds,
                                         const std::function<Vec3(const Vec3&)>& rounding);

}  // namespace triglyph
