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

/// An overlap that is not counted as one: models of surfaces differ by this, meters.
inline constexpr float kTolerance = 0.01F;

/// What a step did in the dynamics world.
struct DrivenStep {
  /// The base stayed where it was: there was no floor, or no way out of what it met.
  bool base_refused = false;
  std::optional<std::size_t> grasped;
  std::optional<std::size_t> released;
};

/// How a base moves: along its heading, clockwise seen from above, and to its left; meters and
/// radians, or these by the second.
struct BaseMotion {
  float forward = 0;
  float turn = 0;
  float left = 0;
};

/// Carries out the simulation's actions in a dynamics world.
///
/// The base drives and turns as in the simulation, kinematically, or its speeds follow those that
/// the actions ask for (BaseDrive): it follows the floor under it, and where its hulls would be
/// deeper than kTolerance in the scene it is pushed out along the ground, up to
/// SlideOptions::attempts times, or stays. Each joint action moves the target of its joint by its
/// step, from the target before (as Habitat 2.0's arm action does), within its limits. After the
/// step the hand grasps the object that is nearest within the grasp sphere, or lets go.
class RobotDriver {
 public:
  /// All but `options` must outlive it. The robot stands in the world.
  RobotDriver(const Robot& robot, DynamicsWorld& world, const SimulationOptions& options);

  /// `actions`: as ActionLayout says; clamped to [-1, 1], NaN counts as 0.
  DrivenStep step(std::span<const float> actions);

  /// Origin at the grasp point, axes of the end effector's link.
  [[nodiscard]] Pose worldFromGrip() const;
  /// What the joints are asked to be: one per position.
  [[nodiscard]] std::span<const float> targets() const { return targets_; }

 private:
  /// Where the base is to be after the step, before it looks what is in the way.
  [[nodiscard]] Pose driveBase(std::span<const float> actions);
  [[nodiscard]] std::optional<Pose> clearOf(Pose world_from_root) const;
  [[nodiscard]] std::optional<Pose> onFloor(const Pose& world_from_root) const;
  void useHand(float value, DrivenStep& step);

  const Robot& robot_;
  DynamicsWorld& world_;
  SimulationOptions options_;
  std::vector<float> targets_;
  /// Of the base with BaseDrive::kVelocity, by the second.
  BaseMotion speed_;
};

/// The pose of the grip for a pose of the root and joint positions.
[[nodiscard]] Pose gripOf(const Robot& robot, const Pose& world_from_root,
                          std::span<const float> positions);

/// The joints' part of applyActions().
void moveJoints(const Robot& robot, std::span<const float> actions, std::span<float> positions);

/// Moves joints and root as the simulation does before it looks at what is in the way: clamped
/// actions, joints within their limits, then the turn, then the drive. `positions`: one per
/// position of the robot.
void applyActions(const Robot& robot, std::span<const float> actions, Pose& world_from_root,
                  std::span<float> positions);

}  // namespace galactic::dynamics
