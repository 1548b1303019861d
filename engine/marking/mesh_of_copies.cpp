#include "engine/marking/mesh_of_copies.h"

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/marking/copies.h"

namespace triglyph {

std::shared_ptr<LoadedMesh> LoadedMesh::open(const std::filesystem::path& path) {
  auto loaded = std::make_shared<LoadedMesh>(LoadedMesh{MeshFile::open(path), {}, {}});
  parallel_pair([&] { loaded->hash = content_hash(loaded->file.bytes()); },
                [&] { loaded->halfedges = build_halfedges(loaded->file.mesh()); });
  return loaded;
}

Rounding LoadedMesh::rounding() const {
  return [this](const Vec3& point) { return file.round(point); };
}

Recut LoadedMesh::recut() const {
  if (!file.has_polygons()) return {};
  return [this](std::span<const Vec3> positions) { return file.triangles_at(positions); };
}

// All that the plan refers to.
struct MeshOfCopies::Planned {
  Planned(LoadedMesh& mesh, const MarkOptions& wanted, const Key& owner)
      : options(wanted), key(owner) {
    if (mesh.file.is_decimal()) {
      digits = options.digits.value_or(0);
      mesh.file.set_more_digits(digits);
    }
    plan.emplace(task_on(mesh));
    // as a single mesh that is too coarse gets digits more
    while (mesh.file.is_decimal() && !options.digits && plan->is_too_coarse() &&
           digits < (plan->displaces_points() ? kMostDigits : 1)) {
      mesh.file.set_more_digits(++digits);
      plan.emplace(task_on(mesh));
    }
  }

  [[nodiscard]] MarkTask task_on(const LoadedMesh& mesh) {
    rounding = mesh.rounding();
    recut = mesh.recut();
    surface.emplace(mesh.surface());
    return {*surface, payload, key, options, {rounding, mesh.file.number_step(), recut}};
  }

  MarkOptions options;
  Key key;
  Payload payload = Message();
  Rounding rounding;
  Recut recut;
  std::optional<Surface> surface;
  std::optional<CopyPlan> plan;
  int digits = 0;
};

MeshOfCopies::MeshOfCopies() = default;
MeshOfCopies::~MeshOfCopies() = default;

std::shared_ptr<LoadedMesh> MeshOfCopies::loaded(const std::filesystem::path& path) const {
  return loaded_.get([&] { return LoadedMesh::open(path); });
}

Marking MeshOfCopies::copy(const Message& name, const MarkOptions& options, const Key& key) const {
  const auto& mesh = loaded_.get([]() -> std::shared_ptr<LoadedMesh> {
    throw std::logic_error("the mesh of copies is loaded first");
  });
  return planned_.get([&] { return std::make_unique<Planned>(*mesh, options, key); })
      ->plan->copy(name);
}

int MeshOfCopies::digits() const {
  return planned_
      .get([]() -> std::unique_ptr<Planned> { throw std::logic_error("a copy is marked first"); })
      ->digits;
}

}  // namespace triglyph
