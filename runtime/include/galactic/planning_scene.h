#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/pose.h"
#include "galactic/ray_caster.h"
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

/// How far a sphere of the robot, or of what it holds, is from what surrounds it.
struct SphereClearance {
  /// Meters from surface to surface; negative: how far it has to move to be free.
  float distance = 0;
  /// kScene, kObject, or kNothing where nothing is nearer than was asked for.
  CastEnd nearest = CastEnd::kNothing;
  /// kObject: index into EnvState::objects; else -1.
  std::int32_t index = -1;
  /// The unit vector of the world in which the sphere gets away fastest: how the distance changes
  /// with the sphere's center. Zero where nothing is near, where the scene is penetrated deeper
  /// than was asked for, and in touch with it to rounding.
  Vec3 direction;

  friend bool operator==(const SphereClearance&, const SphereClearance&) = default;
};

/// Where derivatives of the distances of spheres go: how these change with the base and with the
/// joints (the transposed Jacobian of the sphere's center, applied to the direction). Both may be
/// empty when they are not wanted.
struct ClearanceGradients {
  /// With the base's x, y and z, meters per meter, and its yaw, meters per radian. Shape:
  /// poses * spheres * 4.
  std::span<float> bases{};
  /// With each joint position, meters per radian or meter. Shape: poses * spheres * positions.
  std::span<float> joints{};
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
/// the constructor, update(), hold(), copies, the first clearances() and questions about many
/// poses. Not safe to share between threads; make a copy for each, or ask about many poses at once.
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
  /// (countFree()). Where numbers are so large that their rounding moves a sphere further than its
  /// radius, no motion is free. Limits of joints are not asked for, nor whether the robot touches
  /// itself. What setJoints(), ignorePenetrating() and countFree() have said stays.
  [[nodiscard]] bool isMotionFree(const RobotPose& from, const RobotPose& to);

  /// isFree() of many poses, whatever setJoints() has said. `free`: 1 or 0 for each, overwritten.
  /// Uses up to `threads` threads (0: as many as there are processors). Refused, before anything is
  /// written, where lengths differ or a joint position is not finite. Allocates.
  void areFree(const RobotPoses& poses, std::span<std::uint8_t> free,
               std::uint32_t threads = 1) const;
  /// isMotionFree() of many motions, in the same way.
  void areMotionsFree(const RobotPoses& from, const RobotPoses& to, std::span<std::uint8_t> free,
                      std::uint32_t threads = 1) const;

  /// Spheres of the robot and of what it holds: those of Robot::spheres(), then those of the held
  /// ObjectModel.
  [[nodiscard]] std::size_t sphereCount() const;

  /// How far each of these spheres is from the static scene and from the objects at rest, whichever
  /// is nearer (scene before object, lower indices first); valid until the next call. The least of
  /// them is how far the robot is. It is negative where isFree() says false, and only there, to a
  /// rounding of 0.1 mm. `base`: finite. `most`, meters, > 0: what is farther is not looked for,
  /// and the distance is `most`; where the scene is penetrated deeper, or nothing is free so near,
  /// it is -`most`.
  ///
  /// Objects are exact: a sphere against an oriented box. Of the scene, it is the exact distance
  /// to where queries of the sphere's column grid no longer say free, or say so again: to edges of
  /// cells, and to ends of spans. The grid itself is off by up to half a cell's diagonal (2.1 cm
  /// with cells of 3 cm): nowhere more does the distance say too little, nor too much where the
  /// radius is at least that; smaller spheres may miss what stands between two columns, as isFree()
  /// does. With `--coverage cell` it is never too much, and up to a whole diagonal too little. What
  /// the grid does not know counts as scene, as do places where a bake found no room.
  ///
  /// Spheres that no controlled joint moves against the base keep their height on the floor. Their
  /// distance to the scene is the one in the horizontal plane: else the floor, on which the robot
  /// stands, would be nearest to them everywhere. Spheres that do not count (ignorePenetrating(),
  /// countFree()) are `most` away.
  [[nodiscard]] std::span<const SphereClearance> clearances(const BasePlace& base, float most);
  /// The same of many poses, whatever setJoints() has said. `clearances`: sphereCount() for each
  /// pose, overwritten, as are the gradients. Uses up to `threads` threads (0: as many as there are
  /// processors); answers do not depend on that. Refused, before anything is written, where lengths
  /// differ, a number is not finite or `most` is not above 0. The first question about a scene
  /// makes what speeds up the search, once for all copies of this: some milliseconds, and 60 kB for
  /// each radius in an apartment.
  void clearances(const RobotPoses& poses, float most, std::span<SphereClearance> clearances,
                  const ClearanceGradients& gradients = {}, std::uint32_t threads = 1) const;

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
