#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// Part of a straight line: from `nearest` to `farthest`, both in lengths of `direction`.
struct Ray {
  Vec3 origin;
  Vec3 direction;
  float nearest = 0;
  float farthest = std::numeric_limits<float>::infinity();
};

/// Triangles that rays are sent through; both sides are met. The answers are the same on all
/// processors of one architecture. Implemented with Embree, in embree_rays.cpp.
class TriangleRays {
 public:
  /// `threads`: threads that build. None where memory runs out.
  [[nodiscard]] static std::optional<TriangleRays> build(std::vector<Vec3> positions,
                                                         std::vector<Triangle> triangles,
                                                         unsigned threads);

  ~TriangleRays();
  TriangleRays(TriangleRays&& other) noexcept;
  TriangleRays& operator=(TriangleRays&& other) noexcept;
  TriangleRays(const TriangleRays&) = delete;
  TriangleRays& operator=(const TriangleRays&) = delete;

  /// How far away the ray meets a triangle first, in lengths of its direction; none where it meets
  /// nothing. Thread-safe.
  [[nodiscard]] std::optional<float> first(const Ray& ray) const;

  /// Whether the ray meets nothing. Thread-safe.
  [[nodiscard]] bool isOpen(const Ray& ray) const;

 private:
  struct Scene;
  explicit TriangleRays(std::unique_ptr<Scene> scene);

  std::unique_ptr<Scene> scene_;
};

}  // namespace galactic::bake
