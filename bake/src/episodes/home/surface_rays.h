#pragma once
#include <utility>

#include "engines/triangle_rays.h"
#include "episodes/home/placed_object.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"

namespace galactic::bake {

/// How far apart rays meet the surface under an object at most, meters: finer than the columns.
inline constexpr float kRayDistance = 0.01F;

/// The triangles of a scene, asked from above.
class SurfaceRays {
 public:
  /// Copies what it needs. Fails with kUnsupported when memory is lacking.
  [[nodiscard]] static Result<SurfaceRays> build(const TriangleMesh& mesh);

  /// Whether rays down over the whole footprint, its border included, all meet a surface within
  /// `flatness` (meters) of the height `surface`. Thread-safe.
  [[nodiscard]] bool isEven(const Footprint& footprint, float surface, float flatness) const;

 private:
  explicit SurfaceRays(TriangleRays rays) : rays_(std::move(rays)) {}

  TriangleRays rays_;
};

}  // namespace galactic::bake
