#pragma once
// For the files that name Bullet alone.
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <memory>
#include <span>
#include <vector>

#include "dynamics/bullet/shapes.h"
#include "dynamics/world.h"

namespace galactic::dynamics {

/// What collides with what, as bits.
enum CollisionBit : int { kSceneBit = 1, kObjectBit = 2, kRobotBit = 4, kHeldBit = 8 };

/// The robot in a Bullet world: how it follows where it is told to be.
class Rig {
 public:
  Rig() = default;
  virtual ~Rig() = default;
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;
  Rig(Rig&&) = delete;
  Rig& operator=(Rig&&) = delete;

  /// Where base and joints are to be at the end of the next substep.
  virtual void drive(const Pose& world_from_root, std::span<const float> positions) = 0;
  /// The positions of all joints now.
  virtual void read(std::span<float> positions) const = 0;
  [[nodiscard]] virtual double energy(const btVector3& gravity) const = 0;

  virtual void hold(btRigidBody& object, std::size_t body) = 0;
  virtual void letGo() = 0;
};

/// The setup's bodies hang from each other by joints that motors drive.
[[nodiscard]] std::unique_ptr<Rig> makeMotorRig(btMultiBodyDynamicsWorld& world,
                                                const RobotSetup& setup,
                                                const WorldOptions& options);
/// Each body goes where forward kinematics has it, whatever is in the way.
[[nodiscard]] std::unique_ptr<Rig> makeKinematicRig(btMultiBodyDynamicsWorld& world,
                                                    const RobotSetup& setup,
                                                    const WorldOptions& options);

}  // namespace galactic::dynamics
