#pragma once
#include <utility>

#include "engines/triangle_rays.h"
#include "episodes/home/placed_object.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The greatest distance between the rays that test the surface under an object, meters: finer than
/// the columns.
inline constexpr float kRayDistance = 0.01F;

/// Casts rays down onto the triangles of a scene.
class SurfaceRays {
 public:
  /// Copies what it needs. Fails with kUnsupported if memory runs out.
  [[nodiscard]] static Result<SurfaceRays> build(const TriangleMesh& mesh);

  /// Whether rays down over the whole footprint, including its border, all meet a surface within
  /// `flatness` (meters) of the height `surface`. Thread-safe.
  [[nodiscard]] bool isEven(const Footprint& footprint, float surface, float flatness) const;

 private:
  explicit SurfaceRays(TriangleRays rays) : rays_(std::move(rays)) {}

  TriangleRays rays_;
};

}  // namespace galactic::bake
