#pragma once
#include <vector>

#include "engines/triangle_rays.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/batch_renderer.h"

namespace galactic::test {

/// Depth images by rays: an oracle for rasterizers. Both sides of triangles are met.
class RayDepth {
 public:
  /// Copies the mesh.
  explicit RayDepth(const bake::TriangleMesh& mesh);

  /// How far along `direction`, in its lengths, the first triangle lies beyond `near`; 0: none.
  [[nodiscard]] float first(const Vec3& origin, const Vec3& direction, float near) const;

  /// Shape: height x width, rows from the top; meters along the camera's axis, 0 where nothing is.
  /// One ray through the middle of each pixel.
  [[nodiscard]] std::vector<float> image(const RenderCamera& camera,
                                         const RenderOptions& options) const;

 private:
  bake::TriangleRays rays_;
};

}  // namespace galactic::test
