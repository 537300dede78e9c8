#pragma once
// Only for the files that use Bullet.
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include <memory>
#include <optional>
#include <vector>

#include "bullet_mesh.h"
#include "dynamics/world.h"
#include "galactic/pose.h"

namespace galactic::dynamics {

inline btVector3 toBullet(const Vec3& v) { return {v.x, v.y, v.z}; }
inline btTransform toBullet(const Pose& pose) {
  const Quat& q = pose.rotation;
  return btTransform(btQuaternion(q.x, q.y, q.z, q.w), toBullet(pose.translation));
}
inline Vec3 fromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Pose fromBullet(const btTransform& transform) {
  const btQuaternion q = transform.getRotation();
  return {fromBullet(transform.getOrigin()), {q.x(), q.y(), q.z(), q.w()}};
}

/// Immutable once built.
class SceneShape : public bake::BulletMesh {
 public:
  using BulletMesh::BulletMesh;
};

/// The hull of `points`, without margin, and without corners that change it by at most half a
/// millimeter.
[[nodiscard]] std::unique_ptr<btConvexHullShape> makeHull(const HullPoints& points);

/// A mass in Bullet's terms: about the center of mass, along the principal axes.
struct PrincipalInertia {
  btScalar mass = 0;
  btVector3 moments{0, 0, 0};
  /// The frame of the center of mass and the principal axes.
  btTransform body_from_inertia;
};
[[nodiscard]] PrincipalInertia principalInertia(const Inertia& inertia);

/// The shape of an object in the frame of its center of mass and principal axes.
class ObjectShape {
 public:
  explicit ObjectShape(const ObjectSource& source);
  [[nodiscard]] btCompoundShape* get() const { return compound_.get(); }
  [[nodiscard]] const PrincipalInertia& inertia() const { return inertia_; }
  [[nodiscard]] std::optional<double> friction() const { return friction_; }

 private:
  std::optional<double> friction_;
  std::vector<std::unique_ptr<btConvexHullShape>> hulls_;
  std::unique_ptr<btCompoundShape> compound_;
  PrincipalInertia inertia_;
};

class RobotShape {
 public:
  explicit RobotShape(const RobotParts& parts);
  /// The hulls of a body in the frame `body_from_frame`. linksOfChildren() returns the links to
  /// which they belong.
  [[nodiscard]] std::unique_ptr<btCompoundShape> compound(const RobotBody& body,
                                                          const btTransform& body_from_frame) const;
  [[nodiscard]] std::vector<std::uint32_t> linksOfChildren(const RobotBody& body) const;

 private:
  std::vector<std::vector<std::unique_ptr<btConvexHullShape>>> hulls_of_link_;
};

}  // namespace galactic::dynamics
