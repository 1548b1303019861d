// Draws a scene by casting rays: Embree finds what a ray meets, in single precision relative to the
// scene's box. The same pixels for any number of threads.
#pragma once

#include <memory>

#include "render/camera.h"
#include "render/image.h"
#include "render/scene.h"

namespace triglyph {

class RayCaster {
 public:
  // Keeps a view of the scene, which must outlive it. O(triangles log triangles), parallel.
  explicit RayCaster(const Scene& scene);
  ~RayCaster();

  // Every pixel is the mean of so many samples; what no ray meets is transparent.
  // O(pixels * samples * log triangles).
  [[nodiscard]] Image draw(const Camera& camera, int width, int height, int samples) const;

 private:
  struct Tracer;
  std::unique_ptr<Tracer> tracer_;
};

}  // namespace triglyph
