// The only file in this folder that uses Bullet.
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engines/bullet_mesh.h"
#include "episodes/trial/settling.h"

namespace galactic::bake {
namespace {

constexpr btScalar kGravity = -9.81F;
constexpr btScalar kStep = 1.0F / 120;
/// An object is at rest if during this many steps it moves less far than this (meters) and leans
/// over less than this (radians). Speeds say little: contacts without margins come and go, so that
/// objects tremble.
constexpr int kWindow = 24;
constexpr float kQuietWay = 5e-4F;
constexpr float kQuietLean = 0.01F;
constexpr int kMostWindows = 8;
/// The object is let go this high above where it is put, meters, so that it begins outside the
/// triangles: rounding of a grid's heights is smaller.
constexpr float kDrop = 0.0005F;
constexpr btScalar kFriction = 0.8F;
/// Keeps nearly round objects from rolling away, as a carpet does, or the dents of a real apple.
constexpr btScalar kRollingFriction = 0.002F;
constexpr btScalar kMass = 0.5F;
/// A box without thickness has no inertia: this is the least half extent, meters.
constexpr float kThinnest = 5e-4F;

btVector3 toBullet(const Vec3& v) { return {v.x, v.y, v.z}; }

btTransform toBullet(const Pose& pose) {
  const Quat& q = pose.rotation;
  return btTransform(btQuaternion(q.x, q.y, q.z, q.w), toBullet(pose.translation));
}

Pose fromBullet(const btTransform& transform) {
  const btQuaternion q = transform.getRotation();
  const btVector3& at = transform.getOrigin();
  return {{static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())},
          {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
           static_cast<float>(q.w())}};
}

/// Pools for a single pair of objects; Bullet's defaults take megabytes.
btDefaultCollisionConstructionInfo smallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 64;
  return info;
}

std::unique_ptr<btPolyhedralConvexShape> shapeOf(const SettlingBody& body) {
  std::unique_ptr<btPolyhedralConvexShape> shape;
  if (body.corners.empty()) {
    const Vec3& half = body.half_extents;
    shape = std::make_unique<btBoxShape>(btVector3(
        std::max(half.x, kThinnest), std::max(half.y, kThinnest), std::max(half.z, kThinnest)));
  } else {
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& corner : body.corners) hull->addPoint(toBullet(corner), false);
    hull->recalcLocalAabb();
    shape = std::move(hull);
  }
  // Bullet's default of 4 cm would enlarge all shapes.
  shape->setMargin(0);
  // Finds the contacts of whole faces at once, rather than one corner per step.
  shape->initializePolyhedralFeatures();
  return shape;
}

btRigidBody::btRigidBodyConstructionInfo bodyInfo(btScalar mass, btCollisionShape& shape,
                                                  const btTransform& start) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0) shape.calculateLocalInertia(mass, inertia);
  btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
  info.m_startWorldTransform = start;
  info.m_friction = kFriction;
  info.m_rollingFriction = kRollingFriction;
  info.m_spinningFriction = kRollingFriction;
  return info;
}

/// The angle by which the object's up axis has turned, radians.
float leanBetween(const Quat& before, const Quat& after) {
  const Vec3 up = rotate(after * conjugate(before), {0, 1, 0});
  return std::acos(std::clamp(up.y, -1.0F, 1.0F));
}

float wayBetween(const Pose& before, const Pose& after) {
  const Vec3 way = after.translation - before.translation;
  return std::sqrt(dot(way, way));
}

SettlingEnd judge(const Pose& before, const Pose& now) {
  // Every comparison is false for NaN.
  if (!(leanBetween(before.rotation, now.rotation) <= kSettlingLean)) return SettlingEnd::kTipped;
  return wayBetween(before, now) <= kSettlingWay ? SettlingEnd::kRests : SettlingEnd::kMoved;
}

bool isQuiet(const Pose& before, const Pose& now) {
  return wayBetween(before, now) <= kQuietWay &&
         leanBetween(before.rotation, now.rotation) <= kQuietLean;
}

/// One object above the scene, and all of Bullet's state for it.
class Drop {
 public:
  Drop(btBvhTriangleMeshShape& mesh, const SettlingBody& body, const Pose& world_from_body)
      : configuration_(smallPools()),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        shape_(shapeOf(body)),
        ground_(bodyInfo(0, mesh, btTransform::getIdentity())),
        object_(bodyInfo(kMass, *shape_, toBullet(world_from_body))) {
    object_.setActivationState(DISABLE_DEACTIVATION);
    world_.setGravity(btVector3(0, kGravity, 0));
    world_.addRigidBody(&ground_);
    world_.addRigidBody(&object_);
  }
  ~Drop() {
    world_.removeRigidBody(&object_);
    world_.removeRigidBody(&ground_);
  }
  Drop(const Drop&) = delete;
  Drop& operator=(const Drop&) = delete;

  void step() {
    constexpr int kOneStepOfThisLength = 0;
    world_.stepSimulation(kStep, kOneStepOfThisLength);
  }
  [[nodiscard]] Pose pose() const { return fromBullet(object_.getWorldTransform()); }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btSimpleBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::unique_ptr<btPolyhedralConvexShape> shape_;
  btRigidBody ground_;
  btRigidBody object_;
};

}  // namespace

class SettlingScene::Impl {
 public:
  explicit Impl(const TriangleMesh& mesh) : mesh_(mesh) {}

  [[nodiscard]] btBvhTriangleMeshShape& shape() const { return *mesh_.get(); }

 private:
  BulletMesh mesh_;
};

SettlingScene::SettlingScene(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
SettlingScene::~SettlingScene() = default;
SettlingScene::SettlingScene(SettlingScene&&) noexcept = default;
SettlingScene& SettlingScene::operator=(SettlingScene&&) noexcept = default;

Settled SettlingScene::settle(const SettlingBody& body, const Pose& world_from_object) const {
  Pose start = world_from_object * body.object_from_body;
  const Pose put = start;
  start.translation.y += kDrop;
  Drop drop(impl_->shape(), body, start);
  const Pose body_from_object = inverse(body.object_from_body);
  for (int window = 0; window < kMostWindows; ++window) {
    const Pose before = drop.pose();
    for (int n = 0; n < kWindow; ++n) drop.step();
    const Pose now = drop.pose();
    const SettlingEnd end = judge(put, now);
    // In the first window the object drops.
    const bool is_quiet = window > 0 && isQuiet(before, now);
    if (is_quiet || end != SettlingEnd::kRests) return {end, now * body_from_object};
  }
  return {SettlingEnd::kMoved, drop.pose() * body_from_object};
}

}  // namespace galactic::bake
