#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// A segment of a line, from `nearest` to `farthest`, both in multiples of `direction`.
struct Ray {
  Vec3 origin;
  Vec3 direction;
  float nearest = 0;
  float farthest = std::numeric_limits<float>::infinity();
};

/// Casts rays against triangles, which are hit from both sides. Results are the same on all
/// processors of one architecture. Implemented with Embree, in embree_rays.cpp.
class TriangleRays {
 public:
  /// `threads`: number of threads that build. None if memory runs out.
  [[nodiscard]] static std::optional<TriangleRays> build(std::vector<Vec3> positions,
                                                         std::vector<Triangle> triangles,
                                                         unsigned threads);

  ~TriangleRays();
  TriangleRays(TriangleRays&& other) noexcept;
  TriangleRays& operator=(TriangleRays&& other) noexcept;
  TriangleRays(const TriangleRays&) = delete;
  TriangleRays& operator=(const TriangleRays&) = delete;

  /// Distance of the ray's first hit, in multiples of its direction; none if it hits nothing.
  /// Thread-safe.
  [[nodiscard]] std::optional<float> first(const Ray& ray) const;

  /// Whether the ray hits nothing. Thread-safe.
  [[nodiscard]] bool isOpen(const Ray& ray) const;

 private:
  struct Scene;
  explicit TriangleRays(std::unique_ptr<Scene> scene);

  std::unique_ptr<Scene> scene_;
};

}  // namespace galactic::bake
