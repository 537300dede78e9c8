#include <BulletDynamics/ConstraintSolver/btFixedConstraint.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

#include "dynamics/bullet/rig.h"

namespace galactic::dynamics {
namespace {

class KinematicRig final : public Rig {
 public:
  KinematicRig(btMultiBodyDynamicsWorld& world, const RobotSetup& setup,
               const WorldOptions& options)
      : world_(world),
        robot_(setup.robot),
        positions_(setup.positions.begin(), setup.positions.end()),
        world_from_link_(setup.robot.links().size()) {
    forwardKinematics(robot_.links(), setup.world_from_root, positions_, world_from_link_);
    for (const RobotBody& body : setup.bodies) {
      links_.push_back(body.link);
      shapes_.push_back(setup.shape->compound(body, btTransform::getIdentity()));
      btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shapes_.back().get());
      info.m_startWorldTransform = toBullet(world_from_link_[body.link]);
      info.m_friction = static_cast<btScalar>(options.friction);
      auto rigid = std::make_unique<btRigidBody>(info);
      rigid->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      rigid->setActivationState(DISABLE_DEACTIVATION);
      world_.addRigidBody(rigid.get(), kRobotBit, kObjectBit);
      bodies_.push_back(std::move(rigid));
    }
  }
  ~KinematicRig() override {
    letGo();
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  KinematicRig(const KinematicRig&) = delete;
  KinematicRig& operator=(const KinematicRig&) = delete;
  KinematicRig(KinematicRig&&) = delete;
  KinematicRig& operator=(KinematicRig&&) = delete;

  void drive(const Pose& world_from_root, std::span<const float> positions) override {
    std::ranges::copy(positions, positions_.begin());
    forwardKinematics(robot_.links(), world_from_root, positions_, world_from_link_);
    // Bullet computes the bodies' speeds from how far they moved.
    for (std::size_t n = 0; n < bodies_.size(); ++n) {
      bodies_[n]->setWorldTransform(toBullet(world_from_link_[links_[n]]));
    }
  }

  void read(std::span<float> positions) const override {
    std::ranges::copy(positions_, positions.begin());
  }
  [[nodiscard]] double energy(const btVector3& /*gravity*/) const override { return 0; }

  void hold(btRigidBody& object, std::size_t body) override {
    const btTransform body_from_object =
        bodies_[body]->getWorldTransform().inverse() * object.getWorldTransform();
    grip_ = std::make_unique<btFixedConstraint>(*bodies_[body], object, body_from_object,
                                                btTransform::getIdentity());
    world_.addConstraint(grip_.get(), true);
  }
  void letGo() override {
    if (!grip_) return;
    world_.removeConstraint(grip_.get());
    grip_.reset();
  }

 private:
  btMultiBodyDynamicsWorld& world_;
  const Robot& robot_;
  std::vector<float> positions_;
  std::vector<Pose> world_from_link_;
  /// The links that carry the bodies.
  std::vector<std::uint32_t> links_;
  std::vector<std::unique_ptr<btCompoundShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::unique_ptr<btFixedConstraint> grip_;
};

}  // namespace

std::unique_ptr<Rig> makeKinematicRig(btMultiBodyDynamicsWorld& world, const RobotSetup& setup,
                                      const WorldOptions& options) {
  return std::make_unique<KinematicRig>(world, setup, options);
}

}  // namespace galactic::dynamics
