#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/planning_scene.h"
#include "galactic/pose.h"
#include "galactic/robot.h"
#include "simulation/queries/planner_env.h"
#include "simulation/queries/sphere_cloud.h"

namespace galactic::simulation {

/// Moves robots from one pose to another, place by place; see PlanningScene::isMotionFree().
class PlannerMotion {
 public:
  explicit PlannerMotion(const Robot& robot);

  /// Whether the motion is free. The poses must be finite and `env` loaded; it is left as it was.
  [[nodiscard]] bool isFree(PlannerEnv& env, const RobotPose& from, const RobotPose& to);

 private:
  [[nodiscard]] bool walk();
  /// The sum of all turns on the way, radians.
  [[nodiscard]] double wholeTurn() const;
  [[nodiscard]] float wayOf(std::size_t position) const;
  /// Puts the spheres, and the base except for its height, to a share of the way.
  void putTo(double share);
  /// Puts them to the place at `share`, or to a nearer one if that is too far. Stores in next_ how
  /// far the place after that may be. Returns false if rounding leaves no place that is near
  /// enough.
  [[nodiscard]] bool goTo(double share);
  /// Puts the base, which was at `before`, on the floor. Returns whether it may rise or drop that
  /// far.
  [[nodiscard]] bool followFloor(const Vec3& before);
  /// Whether the place is free; if so, spheres that are free there count from now on.
  [[nodiscard]] bool arrives();

  /// For each joint position, whether it moves the shorter way round.
  std::vector<bool> wraps_;

  // The current motion.
  PlannerEnv* env_ = nullptr;
  RobotPose from_;
  RobotPose to_;
  float turn_ = 0;
  /// The farthest that one place may be from the next, as a share of the way.
  double most_share_ = 1;
  double next_ = 1;
  /// The robot's current place.
  double share_ = 0;
  BasePlace base_;
  std::vector<float> joints_;
  /// Where the current step of the simulation would have begun.
  Vec3 climbed_from_;
  /// The spheres at the previous place.
  SphereCloud robot_before_;
  SphereCloud held_before_;
  /// The spheres that did not count when the motion began.
  std::vector<std::uint64_t> ignored_;
  std::vector<PlannerEnv::Left> left_;
};

}  // namespace galactic::simulation
