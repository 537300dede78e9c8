#pragma once
#include <cstddef>
#include <vector>

#include "galactic/bake/source_robot.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// What a recipe could say about a robot, as its names, tree and shapes suggest. Links stand for
/// the joints above them; frames are Y up and X forward, meters.
struct RobotGuess {
  /// The link below a stage of a telescope, and that below the first stage, which it follows.
  struct Follower {
    std::size_t link = 0;
    std::size_t leader = 0;
  };

  static constexpr float kGraspRadius = 0.015F;

  /// Links that may be the end effector, the likeliest first; none where no name tells.
  std::vector<std::size_t> grasping;
  std::size_t end_effector = 0;
  /// In the end effector's frame.
  Vec3 grasp_point{};
  /// Joints that actions move: those that lead to the end effector, the root's side first.
  std::vector<std::size_t> joints;
  std::vector<Follower> followers;
  /// Joints that lead to the end effector, too, with limits that stand for none.
  std::vector<std::size_t> unlimited;
  /// Joints that no action moves: a head, another arm, fingers.
  std::vector<std::size_t> resting;
  /// Joints whose two limits are the same.
  std::vector<std::size_t> locked;
  /// Links that may carry a camera, or a laser, the likeliest first.
  std::vector<std::size_t> cameras;
  std::vector<std::size_t> lasers;
  /// Whether the first camera's link has an optical frame: Z forward and Y down, as robots' files
  /// have it.
  bool camera_is_optical = false;
  /// By how many degrees, a quarter or half of a turn, that camera is turned about its view for an
  /// image that is upright at the start pose.
  int camera_roll_degrees = 0;
  double footprint_radius = 0;
  double root_height = 0;
};

/// Of a robot with a link at least. Deterministic.
[[nodiscard]] RobotGuess guessRobot(const SourceRobot& robot);

}  // namespace galactic::bake
