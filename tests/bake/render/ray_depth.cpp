#include "bake/render/ray_depth.h"

#include <cmath>

namespace galactic::test {

RayDepth::RayDepth(const bake::TriangleMesh& mesh)
    : rays_(bake::TriangleRays::build(mesh.vertices, mesh.triangles, /*threads=*/1).value()) {}

float RayDepth::first(const Vec3& origin, const Vec3& direction, float near) const {
  return rays_.first({.origin = origin, .direction = direction, .nearest = near}).value_or(0);
}

std::vector<float> RayDepth::image(const RenderCamera& camera, const RenderOptions& options) const {
  const RigidTransform& frame = camera.world_from_camera;
  const float up = std::tan(camera.vertical_fov / 2);
  const float side = up * static_cast<float>(options.width) / static_cast<float>(options.height);
  std::vector<float> depths;
  depths.reserve(std::size_t{options.width} * options.height);
  for (std::uint32_t row = 0; row < options.height; ++row) {
    for (std::uint32_t column = 0; column < options.width; ++column) {
      const float right =
          side * (2 * (static_cast<float>(column) + 0.5F) / static_cast<float>(options.width) - 1);
      const float above =
          up * (1 - 2 * (static_cast<float>(row) + 0.5F) / static_cast<float>(options.height));
      // One meter along the axis, so that distances along the ray are depths.
      const Vec3 direction = frame.x_axis + frame.y_axis * above + frame.z_axis * right;
      depths.push_back(first(frame.origin, direction, options.near));
    }
  }
  return depths;
}

}  // namespace galactic::test
