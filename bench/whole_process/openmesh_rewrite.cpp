// The peer of the whole-process benchmark: opens a mesh with OpenMesh and saves it, nothing else.
#include <cstdio>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: openmesh_rewrite INPUT OUTPUT\n");
    return 2;
  }
  OpenMesh::TriMesh_ArrayKernelT<> mesh;
  return OpenMesh::IO::read_mesh(mesh, argv[1]) && OpenMesh::IO::write_mesh(mesh, argv[2]) ? 0 : 1;
}
