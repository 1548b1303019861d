// Valid glTF files of every layout, written at random by code that shares nothing with the engine's
// reader and that remembers where each position went.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace triglyph::test {

struct RandomGltf {
  bool is_binary = true;
  std::string bytes;
  nlohmann::ordered_json json;
  std::string data;                   // the buffer
  std::size_t component = 4;          // bytes of a coordinate: 4 float, 2 short, 1 byte
  std::vector<std::size_t> places;    // of each vertex in the buffer
  std::vector<std::size_t> accessor;  // of each vertex
  std::vector<std::array<std::uint32_t, 3>> faces;  // vertices
};

[[nodiscard]] RandomGltf random_gltf(std::uint64_t seed, bool is_binary);

// Returns JSON and buffer of a file that random_gltf() or the engine wrote, or throws
// std::runtime_error where its lengths disagree.
struct GltfParts {
  nlohmann::ordered_json json;
  std::string data;
  std::string rest;  // chunks of other kinds
};
[[nodiscard]] GltfParts parts_of_gltf(const std::string& bytes, bool is_binary);

// Returns a GLB with this JSON and buffer.
[[nodiscard]] std::string glb_of(const std::string& json, const std::string& data);

// Returns the coordinate of a vertex as stored in the buffer.
[[nodiscard]] double stored_in(const std::string& data, std::size_t place, std::size_t axis,
                               std::size_t component);

}  // namespace triglyph::test
