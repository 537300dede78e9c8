#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/pose.h"
#include "galactic/scene.h"
#include "galactic/shapes.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic {

/// Where the base of a robot stands.
struct BasePlace {
  /// The point on the floor under the root, world frame, meters.
  Vec3 position;
  /// Angle about +Y, radians: 0 looks along +X, a positive one is a turn counter-clockwise, seen
  /// from above.
  float yaw = 0;
};

/// One pose of a robot.
struct RobotPose {
  BasePlace base;
  /// Joint positions, as PlanningScene::setJoints() takes them.
  std::span<const float> joints;
};

/// Many of them: two arrays.
struct RobotPoses {
  std::span<const BasePlace> bases;
  /// A row of Robot::positionCount() joint positions for each base. Shape: bases * positions.
  std::span<const float> joints;
};

/// The direction in which a base of this yaw drives forward: a unit vector of the world frame.
[[nodiscard]] Vec3 headingOf(float yaw);

/// Answers what a planner asks about one env: does a pose of the robot penetrate anything, where is
/// the hand then, what would it grasp, and where would a released object come to rest? The rules
/// are those of BatchSimulator: column grids of the static scene, boxes of the objects at rest,
/// spheres of the robot and of what it holds. The simulator itself is neither asked nor changed.
///
/// Take over an env with update(), choose joint positions with setJoints(), then ask about places
/// of the base. Every answer depends on these and on the arguments only. Memory is allocated by
/// the constructor, update(), hold(), copies and questions about many poses. Not safe to share
/// between threads; make a copy for each, or ask about many poses at once.
///
/// Calls that do not keep to what is said of them throw ErrorException with kInvalidInput and
/// change nothing: questions about an env before update(), those about links, hand or places before
/// setJoints(), and numbers of objects that there are not (objectCount()). Places with numbers that
/// are not finite are allowed where nothing else is said: the column grids do not know them.
class PlanningScene {
 public:
  /// Of `options` it takes TaskOptions::distractors, the ground, ActionOptions::grasp_shape and the
  /// placement of released objects. Throws ErrorException with kInvalidInput for options out of
  /// their ranges (checkOptions).
  PlanningScene(const World& world, const SimulationOptions& options);
  ~PlanningScene();
  /// Knows what the other one knows.
  PlanningScene(const PlanningScene& other);
  PlanningScene& operator=(const PlanningScene& other);
  PlanningScene(PlanningScene&&) noexcept;
  PlanningScene& operator=(PlanningScene&&) noexcept;

  /// Takes over an env's scene, its objects and what its robot holds. As the simulation has it
  /// after a grasp and after a release, spheres of the held object that penetrate something where
  /// the robot of `state` is do not count, nor do spheres of the robot against resting objects that
  /// they penetrate there, until countFree(). `state`: of the same world, and with the objects that
  /// TaskOptions::distractors says.
  /// Refused where the world has no such scene or episode, or the episode is in another scene,
  /// where the episode or the robot has another number of objects or positions, where
  /// EnvState::held is no index of an object nor -1, and where a number is not finite or a rotation
  /// is not of unit length.
  void update(const EnvState& state);
  /// The static scene of that env.
  [[nodiscard]] const Scene& scene() const;

  /// The joint positions of the questions that follow: one per position of the robot
  /// (Robot::positionCount()), radians or meters, finite. Limits are not enforced. They stay as
  /// they are when another env is taken over.
  void setJoints(std::span<const float> positions);
  /// root_from_link of all links for these joints (forward kinematics); valid until the next call
  /// of setJoints().
  [[nodiscard]] std::span<const Pose> rootFromLinks() const;
  /// Origin at the grasp point, axes of the end effector's link, as in EnvState::world_from_grip.
  [[nodiscard]] Pose rootFromGrip() const;
  /// How far spheres of the robot reach from its root's vertical axis, meters.
  [[nodiscard]] float reach() const;
  /// Whether the robot touches itself with these joints, or comes nearer to that than `margin`,
  /// meters, as SelfCollision has it. What is held plays no part.
  [[nodiscard]] bool touchesItself(float margin = 0) const;

  /// Where the base of the robot of `state` stands.
  [[nodiscard]] BasePlace baseOf(const EnvState& state) const;
  [[nodiscard]] Pose worldFromRoot(const BasePlace& base) const;
  /// Height of the floor under (x, z), meters, for a base that comes from the height `from`; none
  /// where the floor rises or drops too far (GroundOptions), or there is none, as where a number is
  /// not finite. Needs no joints.
  [[nodiscard]] std::optional<float> floorAt(float x, float z, float from) const;

  /// Whether neither the robot nor what it holds penetrates the static scene or an object at rest.
  /// A place that the column grids do not know counts as penetrated. Whether the robot touches
  /// itself is another question, touchesItself(): BatchSimulator does not ask it. What carries the
  /// base is another one, too, floorAt(): half a meter above the floor, a base is free.
  [[nodiscard]] bool isFree(const BasePlace& base);
  /// The two parts of isFree(), for planners that remember what they know of the static scene: the
  /// robot against the scene, and everything else. The robot meets nothing else at a place with
  /// numbers that are not finite: it is the first that says that this is no place.
  [[nodiscard]] bool isRobotFreeOfScene(const BasePlace& base);
  [[nodiscard]] bool isFreeOfAllElse(const BasePlace& base);

  /// Whether the robot gets from one pose to another on the straight way, both ends included: the
  /// base along a line, turning the shorter way round; joints evenly, those that wrap around the
  /// shorter way round. As with SimulationOptions::continuous_collision, places on the way are
  /// looked at that are so close to each other that no sphere, of the robot or of what it holds,
  /// moves further than its radius from one to the next. In each of them isFree() has to be true,
  /// and the base is on the floor, which carries it from one place to the next: the height of
  /// `from` says which floor, to which the base may rise or drop (GroundOptions), and that of `to`
  /// where the way has to end. What does not count at the beginning counts from where it is free on
  /// (countFree()). Limits of joints are not asked for, nor whether the robot touches itself. What
  /// setJoints(), ignorePenetrating() and countFree() have said stays.
  [[nodiscard]] bool isMotionFree(const RobotPose& from, const RobotPose& to);

  /// isFree() of many poses, whatever setJoints() has said. `free`: 1 or 0 for each, overwritten.
  /// Uses up to `threads` threads (0: as many as there are processors). Refused, before anything is
  /// written, where lengths differ or a joint position is not finite. Allocates.
  void areFree(const RobotPoses& poses, std::span<std::uint8_t> free,
               std::uint32_t threads = 1) const;
  /// isMotionFree() of many motions, in the same way.
  void areMotionsFree(const RobotPoses& from, const RobotPoses& to, std::span<std::uint8_t> free,
                      std::uint32_t threads = 1) const;

  /// Objects of the episode, in the order of EnvState::objects; without distractors the target
  /// alone.
  [[nodiscard]] std::size_t objectCount() const;
  /// The box of an object where it rests, or rested before it was held: world_from_box and half
  /// extents.
  [[nodiscard]] OrientedBox objectBox(std::size_t object) const;
  /// Squared distance from a point of the world to what the hand touches of an object
  /// (ActionOptions::grasp_shape), square meters; 0 inside.
  [[nodiscard]] float squaredGraspDistance(std::size_t object, const Vec3& point) const;
  /// Which object a hand that closes here grasps: of those that are nearer to the grasp point than
  /// EndEffector::grasp_radius, as squaredGraspDistance() measures, the nearest. None when there is
  /// no such object.
  [[nodiscard]] std::optional<std::uint32_t> graspedAt(const BasePlace& base) const;

  /// Holds an object that rests, as if it were grasped here, a place of finite numbers: spheres of
  /// it that penetrate something do not count, see ignorePenetrating(). The hand must be empty.
  void hold(std::uint32_t object, const BasePlace& base);
  /// Puts what hold() holds back to where it rested. Refused where hold() has taken nothing since
  /// the last update() or putBack(): what the robot of the env holds rests nowhere.
  void putBack();
  /// False before update().
  [[nodiscard]] bool isHolding() const;
  /// Of the held object; refused where the hand is empty.
  [[nodiscard]] const Pose& gripFromObject() const;

  /// Of the held object, those spheres do not count from now on that penetrate something here, and
  /// all others do. The simulation does the same when an object is grasped: its spheres reach
  /// further than the box as which it rested. update() and hold() have done so where the robot of
  /// the env is, or where the object was grasped. Without a held object nothing happens.
  void ignorePenetrating(const BasePlace& base);
  /// Spheres that do not count, of the held object and of the robot, and that are free here count
  /// again. The simulation does the same in each place that a robot comes to, so call this along a
  /// way from where an object was grasped or released.
  void countFree(const BasePlace& base);

  /// world_from_object of the held object after a release here: where it comes to rest, placed as
  /// the simulation does but without random jitters. None when it finds no place. Refused where the
  /// hand is empty.
  [[nodiscard]] std::optional<Pose> landing(const BasePlace& base);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic
