// Ray casting of a scene with Embree, in single precision relative to the scene's bounding box. The
// pixels are the same for any number of threads.
#pragma once

#include <memory>

#include "render/camera.h"
#include "render/image.h"
#include "render/scene.h"

namespace triglyph {

class RayCaster {
 public:
  // `scene` must outlive the caster. O(triangles log triangles), parallel.
  explicit RayCaster(const Scene& scene);
  ~RayCaster();

  // Returns an image whose pixels are means of `samples` rays each; a ray that hits nothing is
  // transparent. O(pixels * samples * log triangles).
  [[nodiscard]] Image draw(const Camera& camera, int width, int height, int samples) const;

 private:
  struct Tracer;
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace triglyph
