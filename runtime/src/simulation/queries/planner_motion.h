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

/// Takes robots from one pose to another, place by place; see PlanningScene::isMotionFree().
class PlannerMotion {
 public:
  explicit PlannerMotion(const Robot& robot);

  /// Poses of finite numbers, in an env that is there and is afterwards what it was.
  [[nodiscard]] bool isFree(PlannerEnv& env, const RobotPose& from, const RobotPose& to);

 private:
  [[nodiscard]] bool walk();
  /// All that turns on the way, radians.
  [[nodiscard]] double wholeTurn() const;
  [[nodiscard]] float wayOf(std::size_t position) const;
  /// Puts the spheres to a share of the way, and the base but for its height.
  void putTo(double share);
  /// Puts them to the next place, or to a nearer one where that is too far. Says in next_ how far
  /// the one after may be. False where rounding leaves no place that is near enough.
  [[nodiscard]] bool goTo(double share);
  /// From where the base was.
  [[nodiscard]] bool followFloor(const Vec3& before);
  /// Whether the place is free; then, what is free there counts.
  [[nodiscard]] bool arrives();

  /// Of each position, whether its joint moves the shorter way round.
  std::vector<bool> wraps_;

  // Of the motion under way.
  PlannerEnv* env_ = nullptr;
  RobotPose from_;
  RobotPose to_;
  float turn_ = 0;
  /// The farthest from one place to the next, as a share of the way.
  double most_share_ = 1;
  double next_ = 1;
  /// Where the robot is.
  double share_ = 0;
  BasePlace base_;
  std::vector<float> joints_;
  /// Where a step of the simulation would have begun.
  Vec3 climbed_from_;
  /// As the spheres were at the place before.
  SphereCloud robot_before_;
  SphereCloud held_before_;
  /// What did not count when it began.
  std::vector<std::uint64_t> ignored_;
  std::vector<PlannerEnv::Left> left_;
};

}  // namespace galactic::simulation
