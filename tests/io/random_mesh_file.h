// Valid mesh files of every format and variant, written at random by code that shares nothing with
// the engine's readers and that remembers where each coordinate went.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace triglyph::test {

struct ByteSpan {
  std::size_t begin = 0;
  std::size_t size = 0;
};

enum class NumberKind { Text, Int16, Int32, Float32, Float64 };

struct RandomMeshFile {
  std::string name;  // "random.obj"
  std::string bytes;
  bool is_text = true;
  bool is_big_endian = false;
  std::array<NumberKind, 3> kind = {NumberKind::Text, NumberKind::Text, NumberKind::Text};
  std::vector<std::array<ByteSpan, 3>> spans;     // of each file vertex
  std::vector<std::array<double, 3>> values;      // what those bytes say
  std::vector<std::vector<std::uint32_t>> faces;  // file vertices
};

enum class Kind { Obj, Off, PlyAscii, PlyLittle, PlyBig, StlAscii, StlBinary };
inline constexpr int kKinds = 7;

[[nodiscard]] RandomMeshFile random_mesh_file(Kind kind, std::uint64_t seed);

// The value at a span: strtod for text, plain shifts for binary.
[[nodiscard]] double decode(const std::string& bytes, ByteSpan span, NumberKind kind,
                            bool is_big_endian);

}  // namespace triglyph::test
