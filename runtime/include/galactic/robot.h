#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/kinematics.h"
#include "galactic/pack.h"
#include "galactic/shapes.h"

namespace galactic {

/// Limits of one value in the vector of joint positions, radians or meters; the largest floats if
/// there is no limit. The memory layout is that of a pack.
struct PositionLimits {
  float lower = 0;
  float upper = 0;
};

/// A joint that an action moves. The memory layout is that of a pack.
struct ControlledJoint {
  /// Index into the vector of joint positions.
  std::uint32_t position = 0;
  /// Largest move of one action, radians or meters.
  float step = 0;
  /// Limits of the controlled motion, inside those of the joint.
  float lower = 0;
  float upper = 0;
};

/// Whether the spheres of two groups of links touch, as the bake found in some thousand positions
/// that it drew within the limits.
enum class PairKind : std::uint8_t {
  kTested = 0,    ///< They touch in some of these positions.
  kAdjacent = 1,  ///< A joint connects them: not examined.
  kAlways = 2,    ///< They touch in all of them.
  kNever = 3,     ///< They touch in none of them.
  kIgnored = 4,   ///< The recipe says that they may touch: not examined.
};

/// Two groups of links that have spheres: first < second.
struct GroupPair {
  std::uint16_t first = 0;
  std::uint16_t second = 0;
  PairKind kind = PairKind::kTested;
};

/// Links that no joint moves relative to each other, as one rigid body of spheres.
struct SphereGroup {
  /// The link in whose frame the spheres are.
  std::uint32_t link = 0;
  std::span<const SetSphere> spheres;
  /// All links of the group, ascending; `link` is the first.
  std::span<const std::uint32_t> links;
};

struct EndEffector {
  std::uint32_t link = 0;
  /// In the link's frame, meters.
  Vec3 grasp_point;
  /// Meters.
  float grasp_radius = 0;
};

struct RobotCamera {
  std::uint32_t link = 0;
  /// The camera looks along +X of its own frame, +Y is up in the image.
  Pose link_from_camera;
  /// Radians, between the lower and the upper edge of the image.
  float vertical_fov = 0;
};

struct RobotLaser {
  std::uint32_t link = 0;
  /// The laser scans the XZ plane of its own frame; +X is the middle of its field of view.
  Pose link_from_laser;
  /// Radians, up to a whole turn.
  float field_of_view = 0;
  /// Nearest and farthest distance, meters.
  float least_range = 0;
  float range = 0;
  /// Standard deviation of a distance, meters.
  float noise = 0;
};

struct RobotBase {
  /// Longest drive of one action, meters, and largest turn, radians.
  float forward_step = 0;
  float turn_step = 0;
  /// Longest sideways drive of one action, meters; 0: the base does not drive sideways.
  float sideways_step = 0;
  /// Height of the root link's origin above the ground, meters.
  float root_height = 0;
  /// Rectangle on the ground in the root link's frame, meters.
  Vec3 footprint_min;
  Vec3 footprint_max;
  /// > 0: the footprint is a circle of this radius around the middle of the rectangle.
  float footprint_radius = 0;
};

/// The robot of a robot pack: kinematics, spheres and the content of its recipe. Views into the
/// pack; every frame is Y up and X forward.
class Robot {
 public:
  /// The robot in `pack`, which must outlive the result. Fails with kInvalidInput if it is another
  /// kind of pack.
  [[nodiscard]] static Result<Robot> from(const PackFile& pack);
  static Result<Robot> from(const PackFile&& pack) = delete;

  /// The name that episode sets use: EpisodeSet::robotName().
  [[nodiscard]] std::string_view name() const { return name_; }
  /// The working set of radii, meters, ascending.
  [[nodiscard]] std::span<const float> radii() const { return radii_; }

  /// Root first, parents before children: what forwardKinematics reads.
  [[nodiscard]] std::span<const LinkFrame> links() const { return links_; }
  [[nodiscard]] std::string_view linkName(std::size_t link) const { return link_names_[link]; }
  /// Name of the joint to the parent; empty for the root.
  [[nodiscard]] std::string_view jointName(std::size_t link) const { return joint_names_[link]; }
  [[nodiscard]] std::optional<std::uint32_t> findLink(std::string_view name) const;
  /// The link that the joint of this name moves: links()[it].position is where the joint's values
  /// begin in the vector of joint positions.
  [[nodiscard]] std::optional<std::uint32_t> findJoint(std::string_view name) const;

  /// One entry per joint position.
  [[nodiscard]] std::span<const PositionLimits> limits() const { return limits_; }
  /// The joint positions in which an episode starts.
  [[nodiscard]] std::span<const float> startPositions() const { return start_positions_; }
  [[nodiscard]] std::size_t positionCount() const { return limits_.size(); }

  /// The spheres of all groups, group after group, each in the frame of its group's link; within a
  /// group by descending radius.
  [[nodiscard]] std::span<const SetSphere> spheres() const { return spheres_; }
  /// By ascending link; their spheres are parts of spheres().
  [[nodiscard]] const std::vector<SphereGroup>& groups() const { return groups_; }
  /// All pairs of groups that have spheres, ascending.
  [[nodiscard]] std::span<const GroupPair> groupPairs() const { return group_pairs_; }
  /// The pairs that touch in some positions and are apart in others (PairKind::kTested). Spheres
  /// stick out of what they cover, so some of these pairs, such as parts of a telescope or two
  /// fingers, touch in nearly every position, even if the robot itself does not. SelfCollision
  /// selects the pairs that are worth testing.
  [[nodiscard]] const std::vector<GroupPair>& testedPairs() const { return tested_pairs_; }

  /// In the order of the actions.
  [[nodiscard]] std::span<const ControlledJoint> controlledJoints() const { return controlled_; }
  /// This and the following are none if the robot was baked without a recipe.
  [[nodiscard]] const std::optional<EndEffector>& endEffector() const { return end_effector_; }
  [[nodiscard]] const std::optional<RobotCamera>& camera() const { return camera_; }
  [[nodiscard]] const std::optional<RobotBase>& base() const { return base_; }
  [[nodiscard]] const std::optional<RobotLaser>& laser() const { return laser_; }

 private:
  Robot() = default;

  std::string_view name_;
  std::span<const float> radii_;
  std::span<const LinkFrame> links_;
  std::vector<std::string_view> link_names_;
  std::vector<std::string_view> joint_names_;
  std::span<const PositionLimits> limits_;
  std::span<const float> start_positions_;
  std::span<const SetSphere> spheres_;
  std::vector<SphereGroup> groups_;
  std::vector<GroupPair> group_pairs_;
  std::vector<GroupPair> tested_pairs_;
  std::span<const ControlledJoint> controlled_;
  std::optional<EndEffector> end_effector_;
  std::optional<RobotCamera> camera_;
  std::optional<RobotBase> base_;
  std::optional<RobotLaser> laser_;
};

}  // namespace galactic
