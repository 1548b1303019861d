#include "engine/attack/attack_file.h"

#include <string>

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
  throw Error(ErrorCode::Unsupported, out, "",
              "a mesh's name ends in .obj, .off, .ply or .stl, not \"" + ending + "\"");
}

// Names the file in what the attack refuses.
Mesh applied_to_file(const Attack& attack, const std::filesystem::path& path, const Mesh& mesh,
                     std::uint64_t seed) try {
  return attack.applied(mesh, seed);
} catch (const Error& error) {
  throw Error(error.code(), path, "", error.message());
}

}  // namespace

AttackedFile attack_file(const std::filesystem::path& mesh, const std::filesystem::path& out,
                         const Attack& attack, std::uint64_t seed) {
  const MeshFile file = MeshFile::open(mesh);
  ExportFormat format;
  format.format = format_of(out, mesh, file.format());
  format.significant_digits = kDigitsOfAFloat;
  std::error_code ignored;
  if (std::filesystem::equivalent(mesh, out, ignored)) {
    throw Error(ErrorCode::Usage, out, "", "is the mesh itself, which is never overwritten");
  }
  const Mesh attacked = applied_to_file(attack, mesh, file.mesh(), seed);
  OutputFile output(out);
  output.write(export_mesh(attacked, format));
  output.commit();
  return {attacked.positions.size(), attacked.triangles.size()};
}

}  // namespace triglyph
