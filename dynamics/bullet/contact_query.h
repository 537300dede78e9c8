#pragma once
// Only for the files that use Bullet.
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <functional>

namespace galactic::dynamics {

/// One point at which a queried object touches another.
struct QueryContact {
  const btCollisionObject* other = nullptr;
  /// Index of the child in the queried object's compound.
  int child = 0;
  /// Meters, > 0 where they overlap.
  btScalar depth = 0;
  btVector3 point;
  /// Unit vector pointing out of the other object.
  btVector3 away;
  /// The deepest point of the queried object in the other.
  btVector3 on_object;
};

/// Calls `visit` for each contact of `object`.
class ContactQuery final : public btCollisionWorld::ContactResultCallback {
 public:
  ContactQuery(const btCollisionObject& object, int meets,
               std::function<void(const QueryContact&)> visit)
      : object_(object), visit_(std::move(visit)) {
    m_collisionFilterGroup = -1;
    m_collisionFilterMask = meets;
  }

  bool needsCollision(btBroadphaseProxy* proxy) const override {
    return (proxy->m_collisionFilterGroup & m_collisionFilterMask) != 0;
  }
  // NOLINTNEXTLINE(readability-function-size): Bullet's.
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* first, int,
                           int first_index, const btCollisionObjectWrapper* second, int,
                           int second_index) override {
    const bool is_first = first->getCollisionObject() == &object_;
    visit_({.other = (is_first ? second : first)->getCollisionObject(),
            .child = is_first ? first_index : second_index,
            .depth = -point.getDistance(),
            .point = point.getPositionWorldOnB(),
            .away = is_first ? point.m_normalWorldOnB : -point.m_normalWorldOnB,
            .on_object = is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB()});
    return 0;
  }

 private:
  const btCollisionObject& object_;
  std::function<void(const QueryContact&)> visit_;
};

}  // namespace galactic::dynamics
