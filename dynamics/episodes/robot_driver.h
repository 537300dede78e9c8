#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dynamics/world.h"
#include "galactic/robot.h"
#include "galactic/simulation_options.h"

namespace galactic::dynamics {

/// Smaller overlaps do not count, as models of surfaces differ by about this much; meters.
inline constexpr float kTolerance = 0.01F;

/// What a step did in the dynamics world.
struct DrivenStep {
  /// The base did not move, because there was no floor, or no way out of a contact.
  bool base_refused = false;
  std::optional<std::size_t> grasped;
  std::optional<std::size_t> released;
};

/// How a base moves: along its heading, clockwise as seen from above, and to its left; meters and
/// radians, or these per second.
struct BaseMotion {
  float forward = 0;
  float turn = 0;
  float left = 0;
};

/// Carries out the simulation's actions in a dynamics world.
///
/// The base drives and turns kinematically as in the simulation, or its speeds approach those that
/// the actions ask for (BaseDrive). It follows the floor. If its hulls would be deeper than
/// kTolerance in the scene, it is pushed out along the ground, up to SlideOptions::attempts times,
/// or stays where it is. Each joint action moves the target of its joint by its step, starting from
/// the previous target (like Habitat 2.0's arm action), within the limits. After the step, the hand
/// grasps the nearest object within the grasp sphere, or lets go.
class RobotDriver {
 public:
  /// All arguments but `options` must outlive the driver. The robot must have been added to the
  /// world.
  RobotDriver(const Robot& robot, DynamicsWorld& world, const SimulationOptions& options);

  /// `actions`: in the order of ActionLayout; clamped to [-1, 1], NaN counts as 0.
  DrivenStep step(std::span<const float> actions);

  /// The grip's pose: origin at the grasp point, axes of the end effector's link.
  [[nodiscard]] Pose worldFromGrip() const;
  /// The targets of the joints: one per position.
  [[nodiscard]] std::span<const float> targets() const { return targets_; }

 private:
  /// Where the base would be after the step if nothing were in the way.
  [[nodiscard]] Pose driveBase(std::span<const float> actions);
  [[nodiscard]] std::optional<Pose> clearOf(Pose world_from_root) const;
  [[nodiscard]] std::optional<Pose> onFloor(const Pose& world_from_root) const;
  void useHand(float value, DrivenStep& step);

  const Robot& robot_;
  DynamicsWorld& world_;
  SimulationOptions options_;
  std::vector<float> targets_;
  /// Speeds of the base with BaseDrive::kVelocity, per second.
  BaseMotion speed_;
};

/// The pose of the grip for a pose of the root and joint positions.
[[nodiscard]] Pose gripOf(const Robot& robot, const Pose& world_from_root,
                          std::span<const float> positions);

/// The part of applyActions() that moves the joints.
void moveJoints(const Robot& robot, std::span<const float> actions, std::span<float> positions);

/// Moves joints and root as the simulation does before it checks for contacts: clamps the actions,
/// moves joints within their limits, then turns, then drives. `positions`: one per position of the
/// robot.
void applyActions(const Robot& robot, std::span<const float> actions, Pose& world_from_root,
                  std::span<float> positions);

}  // namespace galactic::dynamics
