#pragma once
#include <memory>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/pose.h"

namespace galactic::test {

/// A mesh as Bullet's collision detection sees it, exact, without margin. For one thread.
class BulletScene {
 public:
  explicit BulletScene(const bake::TriangleMesh& mesh);
  ~BulletScene();
  BulletScene(const BulletScene&) = delete;
  BulletScene& operator=(const BulletScene&) = delete;

  /// Bullet counts contacts at edges that are seen askew up to so many radii away: its threshold is
  /// 2 % of half the diagonal of the ball's box, which is the root of 3 times the radius (measured:
  /// 1.03464). At faces it is 1.
  static constexpr float kReach = 1.03465F;

  /// Whether a ball touches the mesh, or comes within kReach radii of it.
  [[nodiscard]] bool touches(const Vec3& center, float radius);

  /// Whether a ball that moves along a line, or a point for a radius of 0, meets the mesh between
  /// the line's ends, at neither of which it may touch the mesh.
  [[nodiscard]] bool crosses(const Vec3& from, const Vec3& to, float radius);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic::test
