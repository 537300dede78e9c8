#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>

#include "dynamics/bullet/rig.h"

namespace galactic::dynamics {
namespace {

/// The largest impulse of the constraint that holds an object, N s, as in Habitat 2.0.
constexpr btScalar kMostHoldImpulse = 1000;

class MotorRig final : public Rig {
 public:
  MotorRig(btMultiBodyDynamicsWorld& world, const RobotSetup& setup, const WorldOptions& options)
      : world_(world), robot_(setup.robot) {
    for (const RobotBody& body : setup.bodies) {
      links_.push_back(body.link);
      inertias_.push_back(principalInertia(body.inertia));
    }
    const PrincipalInertia& base = inertias_.front();
    constexpr bool kFixedBase = true;
    constexpr bool kMaySleep = false;
    const int jointed = static_cast<int>(setup.bodies.size()) - 1;
    body_ = std::make_unique<btMultiBody>(jointed, base.mass, base.moments, kFixedBase, kMaySleep);
    for (int n = 0; n < jointed; ++n) addJoint(setup.bodies, n);
    body_->finalizeMultiDof();
    body_->setLinearDamping(0);
    body_->setAngularDamping(0);
    body_->setHasSelfCollision(false);
    place(setup.world_from_root, setup.positions);
    for (std::size_t n = 0; n < setup.bodies.size(); ++n) addCollider(setup, options, n);
    world_.addMultiBody(body_.get());
    for (int n = 0; n < jointed; ++n) addMotor(options, n, setup.positions);
  }

  ~MotorRig() override {
    letGo();
    for (const auto& motor : motors_) world_.removeMultiBodyConstraint(motor.get());
    for (const auto& collider : colliders_) world_.removeCollisionObject(collider.get());
    world_.removeMultiBody(body_.get());
  }
  MotorRig(const MotorRig&) = delete;
  MotorRig& operator=(const MotorRig&) = delete;
  MotorRig(MotorRig&&) = delete;
  MotorRig& operator=(MotorRig&&) = delete;

  void drive(const Pose& world_from_root, std::span<const float> positions) override {
    const btTransform before = body_->getBaseWorldTransform();
    setBase(world_from_root);
    if (held_ != nullptr) carry(body_->getBaseWorldTransform() * before.inverse());
    for (std::size_t n = 0; n < motors_.size(); ++n) {
      motors_[n]->setPositionTarget(valueOf(n, positions), position_gain_);
    }
  }

  void read(std::span<float> positions) const override {
    for (int n = 0; n < body_->getNumLinks(); ++n) {
      const LinkFrame& frame = robot_.links()[links_[static_cast<std::size_t>(n) + 1]];
      if (frame.multiplier != 1 || frame.offset != 0) continue;
      positions[static_cast<std::size_t>(frame.position)] = body_->getJointPos(n);
    }
  }

  [[nodiscard]] double energy(const btVector3& gravity) const override {
    const auto count = static_cast<std::size_t>(body_->getNumLinks()) + 1;
    std::vector<btVector3> turns(count);
    std::vector<btVector3> speeds(count);
    body_->compTreeLinkVelocities(turns.data(), speeds.data());
    btScalar energy = 0;
    for (int n = 0; n < body_->getNumLinks(); ++n) {
      const btVector3& turn = turns[static_cast<std::size_t>(n) + 1];
      const btVector3& speed = speeds[static_cast<std::size_t>(n) + 1];
      const btVector3& at = body_->getLink(n).m_cachedWorldTransform.getOrigin();
      energy += body_->getLinkMass(n) * (speed.length2() / 2 - gravity.dot(at)) +
                turn.dot(body_->getLinkInertia(n) * turn) / 2;
    }
    return static_cast<double>(energy);
  }

  void hold(btRigidBody& object, std::size_t body) override {
    const int link = static_cast<int>(body) - 1;
    const btTransform world_from_link =
        link < 0 ? body_->getBaseWorldTransform() : body_->getLink(link).m_cachedWorldTransform;
    const btTransform link_from_object = world_from_link.inverse() * object.getWorldTransform();
    grip_ = std::make_unique<btMultiBodyFixedConstraint>(
        body_.get(), link, &object, link_from_object.getOrigin(), btVector3(0, 0, 0),
        link_from_object.getBasis(), btMatrix3x3::getIdentity());
    held_ = &object;
    grip_->setMaxAppliedImpulse(kMostHoldImpulse);
    grip_->finalizeMultiDof();
    world_.addMultiBodyConstraint(grip_.get());
  }

  void letGo() override {
    if (!grip_) return;
    world_.removeMultiBodyConstraint(grip_.get());
    grip_.reset();
    held_ = nullptr;
  }

 private:
  /// Moves the held object with the base, as in Habitat 2.0: the base has no speed, so the
  /// constraint would react to its motion too late.
  void carry(const btTransform& way) {
    const btTransform there = way * held_->getWorldTransform();
    held_->setWorldTransform(there);
    held_->setInterpolationWorldTransform(there);
    held_->setLinearVelocity(way.getBasis() * held_->getLinearVelocity());
    held_->setAngularVelocity(way.getBasis() * held_->getAngularVelocity());
  }

  void addJoint(std::span<const RobotBody> bodies, int n) {
    const std::size_t number = static_cast<std::size_t>(n) + 1;
    const RobotBody& body = bodies[number];
    const LinkFrame& frame = robot_.links()[body.link];
    const PrincipalInertia& own = inertias_[number];
    const btTransform& parent_from_parent_inertia =
        inertias_[static_cast<std::size_t>(body.parent)].body_from_inertia;
    const btTransform parent_inertia_from_joint =
        parent_from_parent_inertia.inverse() * toBullet(body.parent_from_joint);
    const btTransform inertia_from_joint = own.body_from_inertia.inverse();
    const btQuaternion own_from_parent =
        inertia_from_joint.getRotation() * parent_inertia_from_joint.inverse().getRotation();
    const btVector3 axis = quatRotate(inertia_from_joint.getRotation(), toBullet(frame.axis));
    constexpr bool kNoCollisionWithParent = true;
    if (frame.type == JointType::kPrismatic) {
      body_->setupPrismatic(n, own.mass, own.moments, body.parent - 1, own_from_parent, axis,
                            parent_inertia_from_joint.getOrigin(), -inertia_from_joint.getOrigin(),
                            kNoCollisionWithParent);
    } else {
      body_->setupRevolute(n, own.mass, own.moments, body.parent - 1, own_from_parent, axis,
                           parent_inertia_from_joint.getOrigin(), -inertia_from_joint.getOrigin(),
                           kNoCollisionWithParent);
    }
  }

  void addCollider(const RobotSetup& setup, const WorldOptions& options, std::size_t n) {
    shapes_.push_back(setup.shape->compound(setup.bodies[n], inertias_[n].body_from_inertia));
    const int link = static_cast<int>(n) - 1;
    auto collider = std::make_unique<btMultiBodyLinkCollider>(body_.get(), link);
    collider->setCollisionShape(shapes_.back().get());
    collider->setFriction(static_cast<btScalar>(options.friction));
    collider->setActivationState(DISABLE_DEACTIVATION);
    collider->setWorldTransform(link < 0 ? body_->getBaseWorldTransform()
                                         : body_->getLink(link).m_cachedWorldTransform);
    // The scene does not stop the base: its driver does.
    world_.addCollisionObject(collider.get(), kRobotBit,
                              n == 0 ? kObjectBit : kObjectBit | kSceneBit);
    if (link < 0) {
      body_->setBaseCollider(collider.get());
    } else {
      body_->getLink(link).m_collider = collider.get();
    }
    colliders_.push_back(std::move(collider));
  }

  void addMotor(const WorldOptions& options, int n, std::span<const float> positions) {
    position_gain_ = static_cast<btScalar>(options.position_gain);
    auto motor = std::make_unique<btMultiBodyJointMotor>(
        body_.get(), n, 0, static_cast<btScalar>(options.most_impulse));
    motor->setVelocityTarget(0, static_cast<btScalar>(options.velocity_gain));
    motor->setPositionTarget(valueOf(static_cast<std::size_t>(n), positions), position_gain_);
    motor->finalizeMultiDof();
    world_.addMultiBodyConstraint(motor.get());
    motors_.push_back(std::move(motor));
  }

  /// The target for the joint of jointed body `n`.
  [[nodiscard]] btScalar valueOf(std::size_t n, std::span<const float> positions) const {
    const LinkFrame& frame = robot_.links()[links_[n + 1]];
    return frame.multiplier * positions[static_cast<std::size_t>(frame.position)] + frame.offset;
  }

  void setBase(const Pose& world_from_root) {
    body_->setBaseWorldTransform(toBullet(world_from_root) * inertias_.front().body_from_inertia);
  }

  void place(const Pose& world_from_root, std::span<const float> positions) {
    setBase(world_from_root);
    for (int n = 0; n < body_->getNumLinks(); ++n) {
      body_->setJointPos(n, valueOf(static_cast<std::size_t>(n), positions));
    }
    btAlignedObjectArray<btQuaternion> rotations;
    btAlignedObjectArray<btVector3> origins;
    body_->forwardKinematics(rotations, origins);
  }

  btMultiBodyDynamicsWorld& world_;
  const Robot& robot_;
  /// The links that carry the bodies.
  std::vector<std::uint32_t> links_;
  std::vector<PrincipalInertia> inertias_;
  std::unique_ptr<btMultiBody> body_;
  std::vector<std::unique_ptr<btCompoundShape>> shapes_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btMultiBodyJointMotor>> motors_;
  std::unique_ptr<btMultiBodyFixedConstraint> grip_;
  btRigidBody* held_ = nullptr;
  btScalar position_gain_ = 0;
};

}  // namespace

std::unique_ptr<Rig> makeMotorRig(btMultiBodyDynamicsWorld& world, const RobotSetup& setup,
                                  const WorldOptions& options) {
  return std::make_unique<MotorRig>(world, setup, options);
}

}  // namespace galactic::dynamics
