#pragma once
// Only for the files that use Bullet.
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <memory>
#include <span>
#include <vector>

#include "dynamics/bullet/shapes.h"
#include "dynamics/world.h"

namespace galactic::dynamics {

/// Collision groups, as bits.
enum CollisionBit : int { kSceneBit = 1, kObjectBit = 2, kRobotBit = 4, kHeldBit = 8 };

/// The robot in a Bullet world, and how it follows its targets.
class Rig {
 public:
  Rig() = default;
  virtual ~Rig() = default;
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;
  Rig(Rig&&) = delete;
  Rig& operator=(Rig&&) = delete;

  /// Sets the targets of base and joints for the end of the next substep.
  virtual void drive(const Pose& world_from_root, std::span<const float> positions) = 0;
  /// Reads the current positions of all joints.
  virtual void read(std::span<float> positions) const = 0;
  [[nodiscard]] virtual double energy(const btVector3& gravity) const = 0;

  virtual void hold(btRigidBody& object, std::size_t body) = 0;
  virtual void letGo() = 0;
};

/// The setup's bodies are connected by joints that motors drive.
[[nodiscard]] std::unique_ptr<Rig> makeMotorRig(btMultiBodyDynamicsWorld& world,
                                                const RobotSetup& setup,
                                                const WorldOptions& options);
/// Each body goes where forward kinematics puts it, whatever is in the way.
[[nodiscard]] std::unique_ptr<Rig> makeKinematicRig(btMultiBodyDynamicsWorld& world,
                                                    const RobotSetup& setup,
                                                    const WorldOptions& options);

}  // namespace galactic::dynamics
