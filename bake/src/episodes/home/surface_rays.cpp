#include "episodes/home/surface_rays.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace galactic::bake {
namespace {

/// Height above the surface at which rays begin, meters: below anything that may hang above an
/// object.
constexpr float kAbove = 0.025F;

}  // namespace

Result<SurfaceRays> SurfaceRays::build(const TriangleMesh& mesh) {
  auto rays = TriangleRays::build(mesh.vertices, mesh.triangles, /*threads=*/1);
  if (!rays) {
    return fail(ErrorCode::kUnsupported, "episodes",
                "could not build a scene for rays, for lack of memory; generate without geometry");
  }
  return SurfaceRays(*std::move(rays));
}

bool SurfaceRays::isEven(const Footprint& footprint, float surface, float flatness) const {
  const auto steps = [](float half) {
    return std::max(1, static_cast<int>(std::ceil(2 * half / kRayDistance)));
  };
  const int along = steps(footprint.half_length);
  const int across = steps(footprint.half_width);
  for (int a = 0; a <= along; ++a) {
    const float length =
        footprint.half_length * (2 * static_cast<float>(a) / static_cast<float>(along) - 1);
    for (int b = 0; b <= across; ++b) {
      const float width =
          footprint.half_width * (2 * static_cast<float>(b) / static_cast<float>(across) - 1);
      const float x = footprint.x + footprint.along_x * length - footprint.along_z * width;
      const float z = footprint.z + footprint.along_z * length + footprint.along_x * width;
      const auto distance = rays_.first({.origin = {x, surface + kAbove, z},
                                         .direction = {0, -1, 0},
                                         .farthest = kAbove + flatness});
      if (!distance || *distance < kAbove - flatness) return false;
    }
  }
  return true;
}

}  // namespace galactic::bake
