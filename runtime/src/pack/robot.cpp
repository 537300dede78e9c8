#include "galactic/robot.h"

#include <algorithm>
#include <string>

#include "pack/schema_values.h"

namespace galactic {

static_assert(sizeof(LinkFrame) == sizeof(schema::LinkFrame));
static_assert(sizeof(PositionLimits) == sizeof(schema::PositionLimits));
static_assert(sizeof(ControlledJoint) == sizeof(schema::ControlledJoint));
static_assert(static_cast<int>(PairKind::kTested) == static_cast<int>(schema::PairKind::Tested));
static_assert(static_cast<int>(PairKind::kAdjacent) ==
              static_cast<int>(schema::PairKind::Adjacent));
static_assert(static_cast<int>(PairKind::kAlways) == static_cast<int>(schema::PairKind::Always));
static_assert(static_cast<int>(PairKind::kNever) == static_cast<int>(schema::PairKind::Never));
static_assert(static_cast<int>(PairKind::kIgnored) == static_cast<int>(schema::PairKind::Ignored));

namespace {

std::optional<EndEffector> endEffectorOf(const schema::EndEffector* stored) {
  if (stored == nullptr) return std::nullopt;
  return EndEffector{stored->link(), detail::fromSchema(*stored->grasp_point()),
                     stored->grasp_radius()};
}

std::optional<RobotCamera> cameraOf(const schema::Camera* stored) {
  if (stored == nullptr) return std::nullopt;
  return RobotCamera{stored->link(), detail::fromSchema(*stored->link_from_camera()),
                     stored->vertical_fov()};
}

std::optional<RobotBase> baseOf(const schema::Base* stored) {
  if (stored == nullptr) return std::nullopt;
  return RobotBase{.forward_step = stored->forward_step(),
                   .turn_step = stored->turn_step(),
                   .sideways_step = stored->sideways_step(),
                   .root_height = stored->root_height(),
                   .footprint_min = detail::fromSchema(*stored->footprint_min()),
                   .footprint_max = detail::fromSchema(*stored->footprint_max()),
                   .footprint_radius = stored->footprint_radius()};
}

std::optional<RobotLaser> laserOf(const schema::Laser* stored) {
  if (stored == nullptr) return std::nullopt;
  return RobotLaser{.link = stored->link(),
                    .link_from_laser = detail::fromSchema(*stored->link_from_laser()),
                    .field_of_view = stored->field_of_view(),
                    .least_range = stored->least_range(),
                    .range = stored->range(),
                    .noise = stored->noise()};
}

}  // namespace

Result<Robot> Robot::from(const PackFile& pack) {
  const schema::Robot* stored =
      pack.kind() == PackKind::kRobot ? pack.root().asset_as_Robot() : nullptr;
  if (stored == nullptr) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                "is a pack of kind " + packKindName(pack.kind()) +
                    ", expected a robot (RBOT); give the pack of a robot");
  }
  Robot robot;
  robot.name_ = detail::fromSchema(stored->name());
  robot.radii_ = detail::inPlace<float>(stored->radii());
  robot.links_ = detail::inPlace<LinkFrame>(stored->links());
  robot.link_names_ = detail::namesOf(*stored->link_names());
  robot.joint_names_ = detail::namesOf(*stored->joint_names());
  robot.limits_ = detail::inPlace<PositionLimits>(stored->limits());
  robot.start_positions_ = detail::inPlace<float>(stored->start_positions());
  robot.spheres_ = detail::inPlace<SetSphere>(stored->spheres());
  for (const schema::SphereGroup* group : *stored->groups()) {
    robot.groups_.push_back({group->link(),
                             robot.spheres_.subspan(group->first_sphere(), group->sphere_count()),
                             detail::inPlace<std::uint32_t>(group->links())});
  }
  for (const schema::GroupPair* pair : *stored->group_pairs()) {
    robot.group_pairs_.push_back(
        {pair->first(), pair->second(), static_cast<PairKind>(pair->kind())});
    if (pair->kind() == schema::PairKind::Tested) {
      robot.tested_pairs_.push_back(robot.group_pairs_.back());
    }
  }
  robot.controlled_ = detail::inPlace<ControlledJoint>(stored->controlled_joints());
  robot.end_effector_ = endEffectorOf(stored->end_effector());
  robot.camera_ = cameraOf(stored->camera());
  robot.base_ = baseOf(stored->base());
  robot.laser_ = laserOf(stored->laser());
  return robot;
}

std::optional<std::uint32_t> Robot::findLink(std::string_view name) const {
  const auto found = std::find(link_names_.begin(), link_names_.end(), name);
  if (found == link_names_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - link_names_.begin());
}

std::optional<std::uint32_t> Robot::findJoint(std::string_view name) const {
  // The root has no joint.
  const auto found = std::find(joint_names_.begin() + 1, joint_names_.end(), name);
  if (found == joint_names_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - joint_names_.begin());
}

}  // namespace galactic
