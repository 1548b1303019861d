// The files that a mesh file names: material libraries and textures.
#pragma once

#include <filesystem>
#include <vector>

namespace triglyph {

// Returns the companions of a mesh file that exist, as names relative to its folder: the material
// libraries of an OBJ file and the textures that they name, the textures of a PLY file's comments
// ("comment TextureFile"). Names that are absolute or lead out of the folder are left out. Throws
// Error Unreadable. O(bytes).
[[nodiscard]] std::vector<std::filesystem::path> companions_of(const std::filesystem::path& mesh);

// Copies the companions of a mesh to the same places beside its output. A file that is there
// already with the same content is left as it is. Throws Error Usage if one with another content is
// there, Unreadable and Unwritable.
void copy_companions(const std::filesystem::path& mesh, const std::filesystem::path& out);

}  // namespace triglyph
