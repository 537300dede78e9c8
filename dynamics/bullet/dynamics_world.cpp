#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

#include <algorithm>
#include <utility>

#include "dynamics/bullet/contact_query.h"
#include "dynamics/bullet/rig.h"
#include "dynamics/bullet/shapes.h"

namespace galactic::dynamics {
namespace {

/// Slower objects may fall asleep, m/s and rad/s.
constexpr btScalar kSleepSpeed = 0.05F;
constexpr btScalar kSleepTurn = 0.1F;
/// Keeps round objects from rolling away, like a carpet, or the dents of a real apple.
constexpr btScalar kRollingFriction = 0.002F;

/// Iterations of the solver in each substep, as in PyBullet. With Bullet's default of 10, a box
/// slides half as far down a slope as it should.
constexpr int kIterations = 50;

/// Pools of one home; Bullet's defaults are megabytes.
btDefaultCollisionConstructionInfo smallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 256;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 256;
  return info;
}

std::unique_ptr<btRigidBody> makeBody(const PlacedObject& object, const WorldOptions& options) {
  const PrincipalInertia& inertia = object.shape->inertia();
  btRigidBody::btRigidBodyConstructionInfo info(inertia.mass, nullptr, object.shape->get(),
                                                inertia.moments);
  info.m_startWorldTransform = toBullet(object.world_from_object) * inertia.body_from_inertia;
  info.m_friction = static_cast<btScalar>(object.shape->friction().value_or(options.friction));
  info.m_rollingFriction = kRollingFriction;
  info.m_spinningFriction = kRollingFriction;
  info.m_linearSleepingThreshold = kSleepSpeed;
  info.m_angularSleepingThreshold = kSleepTurn;
  return std::make_unique<btRigidBody>(info);
}

/// The distance of a point from the hulls of a compound, 0 inside. Bullet's contact query with a
/// sphere would be off by up to 10 mm: for shapes that are apart, such as a sphere's center and a
/// hull, it returns only a bound.
btScalar distanceTo(const btCompoundShape& hulls, const btTransform& world_from_hulls,
                    const btVector3& point) {
  const btSphereShape sphere(1e-3F);
  const btTransform at(btQuaternion::getIdentity(), point);
  btScalar least = BT_LARGE_FLOAT;
  for (int n = 0; n < hulls.getNumChildShapes(); ++n) {
    const auto* hull = static_cast<const btConvexShape*>(hulls.getChildShape(n));
    const btTransform there = world_from_hulls * hulls.getChildTransform(n);
    btGjkEpaSolver2::sResults result;
    // Without margins, so from the center of the sphere.
    const bool is_apart =
        btGjkEpaSolver2::Distance(hull, there, &sphere, at, there.getOrigin() - point, result);
    least = std::min(least, is_apart ? result.distance : 0);
  }
  return least;
}

}  // namespace

Pose between(const Pose& from, const Pose& to, float share) {
  const btTransform a = toBullet(from);
  const btTransform b = toBullet(to);
  return fromBullet(btTransform(a.getRotation().slerp(b.getRotation(), share),
                                a.getOrigin().lerp(b.getOrigin(), share)));
}

class DynamicsWorld::Impl {
 public:
  Impl(std::shared_ptr<const SceneShape> scene, std::span<const PlacedObject> objects,
       const WorldOptions& options)
      : options_(options),
        scene_(std::move(scene)),
        configuration_(smallPools()),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        ground_(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, scene_->get())) {
    world_.setGravity(btVector3(0, static_cast<btScalar>(-options.gravity), 0));
    world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
    world_.getSolverInfo().m_numIterations = kIterations;
    ground_.setFriction(static_cast<btScalar>(options.friction));
    world_.addRigidBody(&ground_, kSceneBit, kObjectBit | kRobotBit | kHeldBit);
    for (const PlacedObject& object : objects) {
      shapes_.push_back(object.shape);
      objects_.push_back(makeBody(object, options));
      world_.addRigidBody(objects_.back().get(), kObjectBit, kMeetsAll);
    }
  }

  ~Impl() {
    rig_.reset();
    for (const auto& object : objects_) world_.removeRigidBody(object.get());
    world_.removeRigidBody(&ground_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  Impl(Impl&&) = delete;
  Impl& operator=(Impl&&) = delete;

  void addRobot(const RobotSetup& setup) {
    rig_ = options_.arm == ArmDrive::kMotors ? makeMotorRig(world_, setup, options_)
                                             : makeKinematicRig(world_, setup, options_);
    world_from_root_ = wanted_root_ = setup.world_from_root;
    positions_.assign(setup.positions.begin(), setup.positions.end());
    wanted_ = positions_;
    body_of_link_.resize(setup.robot.links().size());
    for (std::size_t n = 0; n < setup.bodies.size(); ++n) {
      for (const BodyLink& link : setup.bodies[n].links) body_of_link_[link.link] = n;
    }
    base_shape_ = setup.shape->compound(setup.bodies.front(), btTransform::getIdentity());
    base_.setCollisionShape(base_shape_.get());
  }

  void drive(const Pose& world_from_root, std::span<const float> positions) {
    wanted_root_ = world_from_root;
    std::ranges::copy(positions, wanted_.begin());
  }

  void step() {
    const Pose from = world_from_root_;
    const std::vector<float> before = positions_;
    for (std::uint32_t n = 1; n <= options_.substeps; ++n) {
      if (rig_) rig_->drive(rootAfter(from, n), targetsAfter(before, n));
      constexpr int kOneStepOfThisLength = 0;
      world_.stepSimulation(static_cast<btScalar>(options_.substep), kOneStepOfThisLength);
    }
    world_from_root_ = wanted_root_;
    if (!rig_) return;
    rig_->read(positions_);
    meetAgain();
  }

  [[nodiscard]] const WorldOptions& options() const { return options_; }
  [[nodiscard]] const Pose& worldFromRoot() const { return world_from_root_; }
  [[nodiscard]] const std::vector<float>& positions() const { return positions_; }
  [[nodiscard]] const btRigidBody& object(std::size_t n) const { return *objects_[n]; }
  [[nodiscard]] Pose objectPose(std::size_t n) const {
    return fromBullet(objects_[n]->getWorldTransform() *
                      shapes_[n]->inertia().body_from_inertia.inverse());
  }
  [[nodiscard]] double robotEnergy() const { return rig_->energy(world_.getGravity()); }

  [[nodiscard]] std::optional<std::size_t> objectWithin(const Vec3& center, float radius) const {
    std::optional<std::size_t> nearest;
    btScalar least = radius;
    for (std::size_t n = 0; n < objects_.size(); ++n) {
      const btScalar distance =
          distanceTo(*shapes_[n]->get(), objects_[n]->getWorldTransform(), toBullet(center));
      if (!(distance < least)) continue;
      least = distance;
      nearest = n;
    }
    return nearest;
  }

  void grasp(std::size_t object, std::uint32_t link) {
    held_ = object;
    std::erase(leaving_, object);
    objects_[object]->setActivationState(DISABLE_DEACTIVATION);
    meet(object, kHeldBit, kObjectBit | kSceneBit);
    rig_->hold(*objects_[object], body_of_link_[link]);
  }

  void release() {
    rig_->letGo();
    objects_[*held_]->forceActivationState(ACTIVE_TAG);
    objects_[*held_]->setDeactivationTime(0);
    leaving_.push_back(*held_);
    held_.reset();
    meetAgain();
  }

  [[nodiscard]] std::optional<std::size_t> held() const { return held_; }

  void sleep(std::size_t object) { objects_[object]->forceActivationState(ISLAND_SLEEPING); }

  [[nodiscard]] BaseContact baseContact(const Pose& world_from_root, float ground_height) {
    base_.setWorldTransform(toBullet(world_from_root));
    BaseContact result;
    ContactQuery query(base_, kSceneBit, [&](const QueryContact& contact) {
      if (isGround(fromBullet(contact.point), fromBullet(contact.away), ground_height)) return;
      result.depth = std::max(result.depth, contact.depth);
      if (contact.depth > 0) result.away = result.away + fromBullet(contact.away * contact.depth);
    });
    world_.contactPairTest(&base_, &ground_, query);
    result.away.y = 0;
    return result;
  }

  [[nodiscard]] std::optional<float> floorBelow(const Vec3& from, float depth) const {
    const btVector3 start = toBullet(from);
    const btVector3 end = start - btVector3(0, depth, 0);
    btCollisionWorld::ClosestRayResultCallback hit(start, end);
    hit.m_collisionFilterGroup = kMeetsAll;
    hit.m_collisionFilterMask = kSceneBit;
    world_.rayTest(start, end, hit);
    if (!hit.hasHit()) return std::nullopt;
    return hit.m_hitPointWorld.y();
  }

 private:
  static constexpr int kMeetsAll = kObjectBit | kSceneBit | kRobotBit | kHeldBit;

  [[nodiscard]] Pose rootAfter(const Pose& from, std::uint32_t n) const {
    if (n == options_.substeps) return wanted_root_;
    return between(from, wanted_root_,
                   static_cast<float>(n) / static_cast<float>(options_.substeps));
  }
  /// Motors get their final target in the first substep.
  [[nodiscard]] std::vector<float> targetsAfter(std::span<const float> before,
                                                std::uint32_t n) const {
    if (options_.arm == ArmDrive::kMotors || n == options_.substeps) return wanted_;
    const float share = static_cast<float>(n) / static_cast<float>(options_.substeps);
    std::vector<float> targets(wanted_.size());
    for (std::size_t k = 0; k < targets.size(); ++k) {
      targets[k] = before[k] + share * (wanted_[k] - before[k]);
    }
    return targets;
  }

  void meet(std::size_t object, int is, int meets) {
    btBroadphaseProxy* proxy = objects_[object]->getBroadphaseHandle();
    proxy->m_collisionFilterGroup = is;
    proxy->m_collisionFilterMask = meets;
    world_.refreshBroadphaseProxy(objects_[object].get());
  }

  /// Released objects collide with the robot again when they no longer overlap it.
  void meetAgain() {
    std::erase_if(leaving_, [this](std::size_t object) {
      bool overlaps = false;
      ContactQuery query(*objects_[object], kRobotBit,
                         [&](const QueryContact& contact) { overlaps |= contact.depth > 0; });
      world_.contactTest(objects_[object].get(), query);
      if (!overlaps) meet(object, kObjectBit, kMeetsAll);
      return !overlaps;
    });
  }

  WorldOptions options_;
  std::shared_ptr<const SceneShape> scene_;
  std::vector<std::shared_ptr<const ObjectShape>> shapes_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_;
  btRigidBody ground_;
  std::vector<std::unique_ptr<btRigidBody>> objects_;
  std::unique_ptr<Rig> rig_;
  std::vector<std::size_t> body_of_link_;
  /// For queries about the base; not in the world.
  std::unique_ptr<btCompoundShape> base_shape_;
  btCollisionObject base_;
  Pose world_from_root_;
  Pose wanted_root_;
  std::vector<float> positions_;
  std::vector<float> wanted_;
  std::optional<std::size_t> held_;
  /// Released objects that still overlap the robot.
  std::vector<std::size_t> leaving_;
};

DynamicsWorld::DynamicsWorld(std::shared_ptr<const SceneShape> scene,
                             std::span<const PlacedObject> objects, const WorldOptions& options)
    : impl_(std::make_unique<Impl>(std::move(scene), objects, options)) {}
DynamicsWorld::~DynamicsWorld() = default;
DynamicsWorld::DynamicsWorld(DynamicsWorld&&) noexcept = default;

void DynamicsWorld::addRobot(const RobotSetup& setup) { impl_->addRobot(setup); }
void DynamicsWorld::drive(const Pose& world_from_root, std::span<const float> positions) {
  impl_->drive(world_from_root, positions);
}
void DynamicsWorld::step() { impl_->step(); }
const WorldOptions& DynamicsWorld::options() const { return impl_->options(); }
Pose DynamicsWorld::worldFromRoot() const { return impl_->worldFromRoot(); }
std::vector<float> DynamicsWorld::positions() const { return impl_->positions(); }
Pose DynamicsWorld::objectPose(std::size_t object) const { return impl_->objectPose(object); }
Vec3 DynamicsWorld::objectVelocity(std::size_t object) const {
  return fromBullet(impl_->object(object).getLinearVelocity());
}
double DynamicsWorld::robotEnergy() const { return impl_->robotEnergy(); }
std::optional<std::size_t> DynamicsWorld::objectWithin(const Vec3& center, float radius) const {
  return impl_->objectWithin(center, radius);
}
void DynamicsWorld::grasp(std::size_t object, std::uint32_t link) { impl_->grasp(object, link); }
void DynamicsWorld::release() { impl_->release(); }
std::optional<std::size_t> DynamicsWorld::held() const { return impl_->held(); }
void DynamicsWorld::sleep(std::size_t object) { impl_->sleep(object); }
DynamicsWorld::BaseContact DynamicsWorld::baseContact(const Pose& world_from_root,
                                                      float ground_height) const {
  return impl_->baseContact(world_from_root, ground_height);
}
std::optional<float> DynamicsWorld::floorBelow(const Vec3& from, float depth) const {
  return impl_->floorBelow(from, depth);
}

}  // namespace galactic::dynamics
