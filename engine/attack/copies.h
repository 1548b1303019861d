// Copies of one mesh, read from files and numbered alike.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "engine/io/mesh_file.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

struct Copies {
  FileFormat format = FileFormat::Obj;  // of the first file
  std::vector<Mesh> meshes;             // in the order of the files, with the first one's triangles
};

// Reads copies of a mesh, in one format or several, such that point i of each is the point i of the
// first. Readers number points as they meet them, so what is matched are the vertices of the files,
// one to one, or, where their numbers or faces differ, the corners of the triangles: one file may
// store a point once and another at every triangle, as long as faces stand in the same order.
// Polygons are cut in all copies as in the first, but only matched vertex by vertex.
//
// Throws Error as MeshFile::open() does, and Usage for a file that has other numbers of points or
// triangles than the first, or other ones: it names the first that cannot match, from 1; also where
// vertices lie at one place in one copy and apart in another, since then the points are not the
// same. O(bytes). Nothing is said about how far apart the copies are.
[[nodiscard]] Copies read_copies(std::span<const std::filesystem::path> paths);

}  // namespace triglyph
