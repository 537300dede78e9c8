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
  /// Point on the floor under the root, world frame, meters.
  Vec3 position;
  /// Angle about +Y, radians: 0 faces +X; positive angles turn counter-clockwise, seen from above.
  float yaw = 0;
};

/// One pose of a robot.
struct RobotPose {
  BasePlace base;
  /// Joint positions, as PlanningScene::setJoints() takes them.
  std::span<const float> joints;
};

/// Many poses of a robot, as two arrays.
struct RobotPoses {
  std::span<const BasePlace> bases;
  /// A row of Robot::positionCount() joint positions for each base. Shape: bases * positions.
  std::span<const float> joints;
};

/// How far a sphere of the robot, or of what it holds, is from what surrounds it.
struct SphereClearance {
  /// Meters from surface to surface; negative: how far it has to move to be free.
  float distance = 0;
  /// kScene, kObject, or kNothing if nothing is within the distance that was asked for.
  CastEnd nearest = CastEnd::kNothing;
  /// For kObject, index into EnvState::objects; otherwise -1.
  std::int32_t index = -1;
  /// Unit vector, world frame, along which the sphere gets away fastest: the gradient of the
  /// distance with respect to the sphere's center. Zero if nothing is near, if the sphere
  /// penetrates the scene deeper than the distance that was asked for, or if it touches the scene
  /// exactly, up to rounding.
  Vec3 direction;

  friend bool operator==(const SphereClearance&, const SphereClearance&) = default;
};

/// Arrays for the derivatives of the spheres' distances with respect to the base and the joints
/// (the transposed Jacobian of the sphere's center, applied to the direction). Leave an array empty
/// if you do not need it.
struct ClearanceGradients {
  /// With respect to the base's x, y and z, meters per meter, and its yaw, meters per radian.
  /// Shape: poses * spheres * 4.
  std::span<float> bases{};
  /// With respect to each joint position, meters per radian or meter. Shape: poses * spheres *
  /// positions.
  std::span<float> joints{};
};

/// The direction in which a base of this yaw drives forward: a unit vector of the world frame.
[[nodiscard]] Vec3 headingOf(float yaw);

/// Answers a planner's questions about one env: does a pose of the robot penetrate anything, where
/// is the hand in that pose, what would it grasp, and where would a released object come to rest?
/// The rules are those of BatchSimulator: column grids of the static scene, boxes of the objects at
/// rest, spheres of the robot and of what it holds. The simulator itself is neither used nor
/// changed.
///
/// Load an env with update(), choose joint positions with setJoints(), then ask about places of the
/// base. Every answer depends only on these and on the arguments. The constructor, update(),
/// hold(), copies, the first call of clearances() and questions about many poses allocate memory.
/// Not safe to share between threads: make a copy for each, or ask about many poses at once.
///
/// Calls that break the rules stated here throw ErrorException with kInvalidInput and change
/// nothing: questions about an env before update(); questions about links, hand or places before
/// setJoints(); and object indices out of range (objectCount()). Places with numbers that are not
/// finite are allowed unless stated otherwise: they lie outside the column grids.
class PlanningScene {
 public:
  /// Uses these of `options`: TaskOptions::distractors, the ground, ActionOptions::grasp_shape and
  /// the placement of released objects. Throws ErrorException with kInvalidInput if an option is
  /// out of range (checkOptions).
  PlanningScene(const World& world, const SimulationOptions& options);
  ~PlanningScene();
  /// Copies include the env, the joints and what is held.
  PlanningScene(const PlanningScene& other);
  PlanningScene& operator=(const PlanningScene& other);
  PlanningScene(PlanningScene&&) noexcept;
  PlanningScene& operator=(PlanningScene&&) noexcept;

  /// Loads an env's scene, its objects and what its robot holds. As in the simulation after a grasp
  /// and after a release, some contacts are ignored until countFree(): spheres of the held object
  /// that penetrate something where the robot of `state` is, and spheres of the robot against
  /// resting objects that they penetrate there. `state` must be of the same world, with the objects
  /// that TaskOptions::distractors selects.
  /// Refused if the world has no such scene or episode, if the episode is in another scene, if the
  /// number of objects or positions is not that of the episode or robot, if EnvState::held is
  /// neither an object's index nor -1, if a number is not finite, or if a rotation is not of unit
  /// length.
  void update(const EnvState& state);
  /// The static scene of that env.
  [[nodiscard]] const Scene& scene() const;

  /// Sets the joint positions for the questions that follow: one per position of the robot
  /// (Robot::positionCount()), radians or meters, finite. Limits are not enforced. The positions
  /// stay the same when another env is loaded.
  void setJoints(std::span<const float> positions);
  /// root_from_link of all links for these joint positions (forward kinematics); valid until the
  /// next call of setJoints().
  [[nodiscard]] std::span<const Pose> rootFromLinks() const;
  /// Origin at the grasp point, axes of the end effector's link, as in EnvState::world_from_grip.
  [[nodiscard]] Pose rootFromGrip() const;
  /// How far the robot's spheres reach from the vertical axis through its root, meters.
  [[nodiscard]] float reach() const;
  /// Whether the robot touches itself with these joint positions, or comes within `margin` of doing
  /// so, meters, as SelfCollision defines it. What it holds is ignored.
  [[nodiscard]] bool touchesItself(float margin = 0) const;

  /// Where the base of the robot of `state` stands.
  [[nodiscard]] BasePlace baseOf(const EnvState& state) const;
  [[nodiscard]] Pose worldFromRoot(const BasePlace& base) const;
  /// Height of the floor under (x, z), meters, for a base that comes from the height `from`. None
  /// if the floor rises or drops too far (GroundOptions), or if there is no floor, for example
  /// because a number is not finite. Can be called before setJoints().
  [[nodiscard]] std::optional<float> floorAt(float x, float z, float from) const;

  /// Whether neither the robot nor what it holds penetrates the static scene or an object at rest.
  /// A place outside the column grids counts as penetrated. Whether the robot touches itself is a
  /// separate question (touchesItself()), which BatchSimulator does not ask. Whether a floor
  /// carries the base is another one (floorAt()): half a meter above the floor, a base is free.
  [[nodiscard]] bool isFree(const BasePlace& base);
  /// The two parts of isFree(), for planners that cache answers about the static scene: the robot
  /// against the scene, and everything else. At a place with numbers that are not finite, only
  /// isRobotFreeOfScene() is false; isFreeOfAllElse() may be true.
  [[nodiscard]] bool isRobotFreeOfScene(const BasePlace& base);
  [[nodiscard]] bool isFreeOfAllElse(const BasePlace& base);

  /// Whether the robot can move straight from one pose to another, both ends included: the base
  /// along a line, turning the shorter way around; joints at constant speed, those that wrap also
  /// the shorter way around. As with SimulationOptions::continuous_collision, the motion is checked
  /// at places so close together that no sphere, of the robot or of what it holds, moves further
  /// than its radius from one to the next. At each of them isFree() must be true, and the floor
  /// must carry the base from one place to the next. The height of `from` selects the floor, to
  /// which the base may rise or drop (GroundOptions), and the motion must end at the height of
  /// `to`. Spheres that are ignored at the beginning count again from where they are free
  /// (countFree()). If numbers are so large that their rounding moves a sphere further than its
  /// radius, no motion is free. Joint limits are not checked, nor whether the robot touches itself.
  /// The effects of setJoints(), ignorePenetrating() and countFree() are kept.
  [[nodiscard]] bool isMotionFree(const RobotPose& from, const RobotPose& to);

  /// isFree() for many poses, independent of setJoints(). `free`: 1 or 0 for each, overwritten.
  /// Uses up to `threads` threads (0: as many as there are processors). If lengths differ or a
  /// joint position is not finite, the call is refused before anything is written. Allocates.
  void areFree(const RobotPoses& poses, std::span<std::uint8_t> free,
               std::uint32_t threads = 1) const;
  /// isMotionFree() for many motions, in the same way.
  void areMotionsFree(const RobotPoses& from, const RobotPoses& to, std::span<std::uint8_t> free,
                      std::uint32_t threads = 1) const;

  /// Number of spheres of the robot and of what it holds: those of Robot::spheres(), then those of
  /// the held ObjectModel.
  [[nodiscard]] std::size_t sphereCount() const;

  /// The distance of each of these spheres to the static scene or the objects at rest, whichever is
  /// nearer (ties: scene before object, lower indices first); valid until the next call. The
  /// smallest of them is the robot's distance. It is negative if and only if isFree() is false, up
  /// to rounding by 0.1 mm. `base` must be finite. `most`, meters, > 0, limits the search: the
  /// distance is `most` if nothing is nearer, and -`most` if the scene is penetrated deeper or no
  /// free place is that near.
  ///
  /// Distances to objects are exact: a sphere against an oriented box. The distance to the scene is
  /// the exact distance to where queries of the sphere's column grid change between free and not
  /// free: to edges of cells and ends of spans. The grid itself is off by up to half a cell's
  /// diagonal (2.1 cm with cells of 3 cm). The distance is never too small by more than that, nor
  /// too large by more if the radius is at least that; smaller spheres may miss what stands between
  /// two columns, as in isFree(). With `--coverage cell`, the distance is never too large, and up
  /// to a whole diagonal too small. Places outside the grid count as scene, and so do places that
  /// the bake did not count as room.
  ///
  /// Spheres that no controlled joint moves relative to the base keep their height above the floor.
  /// Their distance to the scene is measured in the horizontal plane; otherwise the floor on which
  /// the robot stands would be nearest everywhere. Spheres that are ignored (ignorePenetrating(),
  /// countFree()) are at distance `most`.
  [[nodiscard]] std::span<const SphereClearance> clearances(const BasePlace& base, float most);
  /// The same for many poses, independent of setJoints(). `clearances`: sphereCount() for each
  /// pose, overwritten, as are the gradients. Uses up to `threads` threads (0: as many as there are
  /// processors); answers do not depend on their number. If lengths differ, a number is not finite
  /// or `most` is not above 0, the call is refused before anything is written. The first question
  /// about a scene builds a table that speeds up the search and that all copies of this
  /// PlanningScene share: some milliseconds, and 60 kB per radius in an apartment.
  void clearances(const RobotPoses& poses, float most, std::span<SphereClearance> clearances,
                  const ClearanceGradients& gradients = {}, std::uint32_t threads = 1) const;

  /// Number of the episode's objects, in the order of EnvState::objects; without distractors, the
  /// target alone.
  [[nodiscard]] std::size_t objectCount() const;
  /// The box of an object where it rests, or where it rested before it was held: world_from_box and
  /// half extents.
  [[nodiscard]] OrientedBox objectBox(std::size_t object) const;
  /// Squared distance from a point in the world frame to the shape of an object that the hand
  /// touches (ActionOptions::grasp_shape), square meters; 0 inside.
  [[nodiscard]] float squaredGraspDistance(std::size_t object, const Vec3& point) const;
  /// The object that the hand would grasp if it closed here: the nearest object within
  /// EndEffector::grasp_radius of the grasp point, measured as by squaredGraspDistance(). None if
  /// there is no such object.
  [[nodiscard]] std::optional<std::uint32_t> graspedAt(const BasePlace& base) const;

  /// Puts a resting object into the hand, as if it were grasped here. `base` must be finite, and
  /// the hand must be empty. The object's spheres that penetrate something are ignored; see
  /// ignorePenetrating().
  void hold(std::uint32_t object, const BasePlace& base);
  /// Puts the object that hold() took back to where it rested. Refused if hold() has taken nothing
  /// since the last update() or putBack(): an object that the env's robot holds has no resting
  /// place.
  void putBack();
  /// False before update().
  [[nodiscard]] bool isHolding() const;
  /// grip_from_object of the held object; refused if the hand is empty.
  [[nodiscard]] const Pose& gripFromObject() const;

  /// From now on, ignores the spheres of the held object that penetrate something here, and counts
  /// all its other spheres. The simulation does the same when an object is grasped, because the
  /// object's spheres reach beyond the box that stands for it at rest. update() has already done
  /// this for the place of the env's robot, and hold() for the place of the grasp. Does nothing if
  /// no object is held.
  void ignorePenetrating(const BasePlace& base);
  /// Counts ignored spheres of the held object and of the robot again if they are free here. The
  /// simulation does the same in each place that the robot reaches, so call this along a path that
  /// begins where an object was grasped or released.
  void countFree(const BasePlace& base);

  /// world_from_object of the held object after a release here: where it comes to rest, placed as
  /// in the simulation but without random jitters. None if no place is found. Refused if the hand
  /// is empty.
  [[nodiscard]] std::optional<Pose> landing(const BasePlace& base);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic
