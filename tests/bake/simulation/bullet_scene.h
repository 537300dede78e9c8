#pragma once
#include <memory>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/vec3.h"

namespace galactic::test {

/// A mesh as Bullet's collision detection sees it, exact, without margin. For one thread.
class BulletScene {
 public:
  explicit BulletScene(const bake::TriangleMesh& mesh);
  ~BulletScene();
  BulletScene(const BulletScene&) = delete;
  BulletScene& operator=(const BulletScene&) = delete;

  /// Whether a ball touches the mesh. Bullet counts contacts up to 2 % of the radius away.
  [[nodiscard]] bool touches(const Vec3& centre, float radius);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic::test
