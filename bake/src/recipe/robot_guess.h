#pragma once
#include <cstddef>
#include <vector>

#include "galactic/bake/source_robot.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// The contents of a recipe as far as the robot's names, tree and shapes suggest them. Links stand
/// for the joints above them; frames are Y up and X forward, in meters.
struct RobotGuess {
  /// The link below a stage of a telescope, and the link below the first stage, which it follows.
  struct Follower {
    std::size_t link = 0;
    std::size_t leader = 0;
  };

  static constexpr float kGraspRadius = 0.015F;

  /// Links that may be the end effector, the likeliest first; empty if no name suggests any.
  std::vector<std::size_t> grasping;
  std::size_t end_effector = 0;
  /// In the end effector's frame.
  Vec3 grasp_point{};
  /// Joints that actions move: those that lead to the end effector, from the root on.
  std::vector<std::size_t> joints;
  std::vector<Follower> followers;
  /// Joints that also lead to the end effector, but with limits so wide that they mean none.
  std::vector<std::size_t> unlimited;
  /// Joints that no action moves: a head, another arm, fingers.
  std::vector<std::size_t> resting;
  /// Joints whose lower and upper limits are the same.
  std::vector<std::size_t> locked;
  /// Links that may carry a camera, or a laser, the likeliest first.
  std::vector<std::size_t> cameras;
  std::vector<std::size_t> lasers;
  /// Whether the first camera's link is an optical frame: Z forward and Y down, as in robot files.
  bool camera_is_optical = false;
  /// The roll of that camera about its view direction, a multiple of 90 degrees, that makes its
  /// image upright at the start pose.
  int camera_roll_degrees = 0;
  double footprint_radius = 0;
  double root_height = 0;
};

/// The robot must have at least one link. Deterministic.
[[nodiscard]] RobotGuess guessRobot(const SourceRobot& robot);

}  // namespace galactic::bake
