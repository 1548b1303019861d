#include "engine/io/gltf_compression.h"

#include <cstdint>
#include <exception>
#include <memory>
#include <utility>

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

namespace triglyph {

bool decode_meshopt(const MeshoptView& view, std::span<const char> bytes, std::vector<char>& out) {
  // A byte of the codec stands for at most 64 bytes of an attribute, and for one triangle or index:
  // a claim of more is wrong, and not worth any memory.
  constexpr std::uint64_t kMostRatio = 64, kSlack = 4096, kMostStride = 256;
  const std::uint64_t most = bytes.size() * kMostRatio + kSlack;
  if (view.stride == 0 || view.stride > kMostStride || view.count > most / view.stride)
    return false;
  const std::size_t size = view.count * view.stride, first = out.size();
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  out.resize(first + size);
  char* target = out.data() + first;
  int error = -1;
  const bool is_index = view.stride == 2 || view.stride == 4;
  if (view.mode == "ATTRIBUTES" && view.stride % 4 == 0) {
    error = meshopt_decodeVertexBuffer(target, view.count, view.stride, data, bytes.size());
  } else if (view.mode == "TRIANGLES" && is_index && view.count % 3 == 0) {
    error = meshopt_decodeIndexBuffer(target, view.count, view.stride, data, bytes.size());
  } else if (view.mode == "INDICES" && is_index) {
    error = meshopt_decodeIndexSequence(target, view.count, view.stride, data, bytes.size());
  }
  // The filters work in place on strides of their own; those of normals and of rotations are not of
  // positions, but a buffer view is decoded as a whole.
  if (error == 0 && view.mode == "ATTRIBUTES") {
    if (view.filter == "EXPONENTIAL") {
      meshopt_decodeFilterExp(target, view.count, view.stride);
    } else if (view.filter == "OCTAHEDRAL" && (view.stride == 4 || view.stride == 8)) {
      meshopt_decodeFilterOct(target, view.count, view.stride);
    } else if (view.filter == "QUATERNION" && view.stride == 8) {
      meshopt_decodeFilterQuat(target, view.count, view.stride);
    } else if (!view.filter.empty() && view.filter != "NONE") {
      error = -1;
    }
  }
  if (error != 0) out.resize(first);
  return error == 0;
}

bool decode_draco(std::span<const char> bytes, std::uint64_t position, DracoMesh& out) try {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return false;
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  const draco::PointAttribute* attribute =
      mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(position));
  if (attribute == nullptr || attribute->num_components() != 3) return false;
  out.points.reserve(mesh->num_points());
  for (draco::PointIndex p(0); p < mesh->num_points(); ++p) {
    float value[3];
    if (!attribute->ConvertValue<float, 3>(attribute->mapped_index(p), value)) return false;
    out.points.emplace_back(value[0], value[1], value[2]);
  }
  out.triangles.reserve(mesh->num_faces());
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh->face(f);
    for (int corner = 0; corner < 3; ++corner) {
      if (face[static_cast<std::size_t>(corner)] >= mesh->num_points()) return false;
    }
    out.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return true;
} catch (const std::exception&) {  // of memory that a wrong count asks for
  return false;
}

}  // namespace triglyph
