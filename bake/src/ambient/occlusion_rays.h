#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"
#include "galactic/vec3.h"

namespace galactic::bake {

/// A segment from `origin` along the unit vector `direction`.
struct OcclusionRay {
  Vec3 origin;
  Vec3 direction;
};

/// Triangles in the world that rays may meet. Implemented with Embree, in embree_occlusion.cpp.
class Occluders {
 public:
  /// Fails with kInternal when memory runs out.
  [[nodiscard]] static Result<Occluders> build(std::vector<Vec3> positions,
                                               std::vector<Triangle> triangles, unsigned jobs);

  ~Occluders();
  Occluders(Occluders&& other) noexcept;
  Occluders& operator=(Occluders&& other) noexcept;
  Occluders(const Occluders&) = delete;
  Occluders& operator=(const Occluders&) = delete;

  /// How many of `rays` meet nothing within `distance` metres. Thread-safe.
  [[nodiscard]] std::size_t countOpen(std::span<const OcclusionRay> rays, float distance) const;

 private:
  struct Scene;
  explicit Occluders(std::unique_ptr<Scene> scene);

  std::unique_ptr<Scene> scene_;
};

}  // namespace galactic::bake
