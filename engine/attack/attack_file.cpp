#include "engine/attack/attack_file.h"

#include <string>

#include "engine/attack/copies.h"
#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/io/export_mesh.h"
#include "engine/io/mesh_file.h"

namespace triglyph {
namespace {

constexpr int kDigitsOfAFloat = 9;  // enough to read any float back exactly

FileFormat format_of(const std::filesystem::path& out, const std::filesystem::path& mesh,
                     FileFormat format) {
  const std::string ending = lower_case_ending(out);
  if (ending == lower_case_ending(mesh)) return format;
  if (ending == ".obj") return FileFormat::Obj;
  if (ending == ".off") return FileFormat::Off;
  if (ending == ".ply") return FileFormat::PlyLittle;
  if (ending == ".stl") return FileFormat::StlBinary;
  if (ending == ".glb") return FileFormat::Glb;
  if (ending == ".gltf") return FileFormat::Gltf;
  throw Error(
      ErrorCode::Unsupported, out, "",
      "a mesh's name ends in .obj, .off, .ply, .stl, .glb or .gltf, not \"" + ending + "\"");
}

// Names the file in what the attack refuses.
Mesh applied_to_file(const Attack& attack, const std::filesystem::path& path, const Mesh& mesh,
                     std::uint64_t seed) try {
  return attack.applied(mesh, seed);
} catch (const Error& error) {
  throw Error(error.code(), path, "", error.message());
}

void check_not_overwritten(const std::filesystem::path& mesh, const std::filesystem::path& out,
                           const std::string& what) {
  std::error_code ignored;
  if (std::filesystem::equivalent(mesh, out, ignored)) {
    throw Error(ErrorCode::Usage, out, "", "is " + what + " itself, which is never overwritten");
  }
}

AttackedFile write_attacked(const Mesh& mesh, const std::filesystem::path& out, FileFormat format) {
  OutputFile output(out);
  output.write(export_mesh(mesh, {.format = format, .significant_digits = kDigitsOfAFloat}));
  output.commit();
  return {mesh.positions.size(), mesh.triangles.size()};
}

}  // namespace

AttackedFile attack_file(const std::filesystem::path& mesh, const std::filesystem::path& out,
                         const Attack& attack, std::uint64_t seed) {
  const MeshFile file = MeshFile::open(mesh);
  const FileFormat format = format_of(out, mesh, file.format());
  check_not_overwritten(mesh, out, "the mesh");
  return write_attacked(applied_to_file(attack, mesh, file.mesh(), seed), out, format);
}

AttackedFile collude_files(std::span<const std::filesystem::path> copies,
                           const std::filesystem::path& out, Collusion collusion,
                           const Attack& attack, std::uint64_t seed) {
  for (const std::filesystem::path& copy : copies) check_not_overwritten(copy, out, "a copy");
  const Copies read = read_copies(copies);
  const Mesh mesh = colluded(read.meshes, collusion, seed);
  const FileFormat format = format_of(out, copies.front(), read.format);
  return write_attacked(applied_to_file(attack, copies.front(), mesh, seed), out, format);
}

}  // namespace triglyph
