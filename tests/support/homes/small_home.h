#pragma once
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "galactic/world.h"
#include "support/homes/box_room.h"
#include "support/packs/world_pack_builder.h"
#include "support/scratch_folder.h"

namespace galactic::test {

/// The actions of the small home's robot, in their order.
enum SmallHomeAction : std::size_t {
  kLift,
  kShoulder,
  kArm,
  kWrist,
  kForward,
  kTurn,
  kHand,
  kTerminate,
  kSmallHomeActions
};

/// base - lift (prismatic, up) - shoulder (continuous, about up) - arm (prismatic, ahead) - hand
/// (revolute). With all joints at 0 the grip is 0.37 m ahead of the base and 0.5 m above the floor.
inline RobotPackFields smallHomeRobot() {
  constexpr float kUnlimited = std::numeric_limits<float>::max();
  // A chain: link n + 1 hangs on link n by the joint of position n.
  const auto link = [](std::int32_t parent, JointType type, const Vec3& from, const Vec3& axis) {
    LinkFrame frame;
    frame.parent_from_joint = {from, {}};
    frame.axis = axis;
    frame.parent = parent;
    frame.type = type;
    frame.position = parent;
    return frame;
  };
  RobotPackFields robot;
  robot.name = "helper";
  robot.links = {link(-1, JointType::kFixed, {}, {1, 0, 0}),
                 link(0, JointType::kPrismatic, {0, 0.3F, 0}, {0, 1, 0}),
                 link(1, JointType::kContinuous, {0, 0.1F, 0}, {0, 1, 0}),
                 link(2, JointType::kPrismatic, {0.15F, 0, 0}, {1, 0, 0}),
                 link(3, JointType::kRevolute, {0.1F, 0, 0}, {0, 0, 1})};
  robot.link_names = {"base", "mast", "turret", "arm", "hand"};
  robot.joint_names = {"", "lift", "elbow", "reach", "wrist"};
  robot.limits = {{0, 0.8F}, {-kUnlimited, kUnlimited}, {0, 0.6F}, {-1, 1}};
  robot.start_positions = {0.25F, 0, 0, 0};
  robot.spheres = {{{0, 0.1F, 0}, 2}, {{0, 0, 0}, 1}, {{0.02F, 0, 0}, 0}};
  robot.groups = {{0, {0}, 0, 1, SphereStatisticsFields{}},
                  {1, {1}, 1, 0, std::nullopt},
                  {2, {2}, 1, 0, std::nullopt},
                  {3, {3}, 1, 1, SphereStatisticsFields{}},
                  {4, {4}, 2, 1, SphereStatisticsFields{}}};
  robot.controlled_joints = {{0, 0.05F, 0, 0.8F},
                             {1, 0.1F, -kUnlimited, kUnlimited},
                             {2, 0.05F, 0, 0.6F},
                             {3, 0.1F, -1, 1}};
  robot.end_effector = EndEffectorFields{.link = 4, .grasp_point = Vec3{0.12F, 0, 0}};
  robot.base->root_height = 0.1F;
  return robot;
}

/// Boxes of 10 cm around a ball of 5 cm, their origins in the middle of their bottoms.
inline ObjectPackFields smallHomeObjects() {
  ObjectPackFields fields = smallObjects();
  for (ObjectFields& object : fields.objects) {
    object.box_pose = Pose{{0, 0.05F, 0}, {}};
    object.box_half_extents = Vec3{0.05F, 0.05F, 0.05F};
    object.spheres = {{{0, 0.05F, 0}, 1}};
  }
  return fields;
}

/// Four episodes around one table, each with a target, a goal in reach, and distractors; in the
/// third one the robot begins inside the table and cannot get out.
inline EpisodePackFields smallHomeEpisodes() {
  constexpr float kTop = 0.701F;
  EpisodePackFields fields;
  fields.start_positions = {0, 0.25F, 0.25F, 0.3F, 0, 0.25F, -0.5F, 0.4F};
  const auto on_table = [](std::uint32_t object, float x, float z) {
    return Placement{object, {{x, kTop, z}, test::yaw(0.3)}};
  };
  const auto add = [&](std::vector<Placement> placements, std::uint32_t target, const Vec3& base,
                       const Vec3& goal) {
    const auto first = static_cast<std::uint32_t>(fields.placements.size());
    fields.placements.insert(fields.placements.end(), placements.begin(), placements.end());
    fields.episodes.push_back({.scene = 0,
                               .first_placement = first,
                               .placement_count = static_cast<std::uint32_t>(placements.size()),
                               .target = target,
                               .base_position = base,
                               .base_yaw = 0.125F,
                               .goal = {goal, test::yaw(0.3)}});
  };
  add({on_table(0, 1.15F, 1.75F), on_table(1, 1.15F, 1.5F)}, 1, {0.65F, 0, 1.5F},
      {1.2F, kTop, 1.25F});
  add({on_table(1, 1.2F, 1.4F), on_table(0, 1.15F, 1.65F), on_table(1, 1.2F, 1.9F)}, 0,
      {0.6F, 0, 1.6F}, {1.15F, kTop, 1.2F});
  add({on_table(1, 1.2F, 1.4F)}, 0, {1.5F, 0, 1.5F}, {1.15F, kTop, 1.2F});
  add({on_table(0, 1.15F, 1.2F), on_table(1, 1.3F, 1.45F)}, 0, {0.65F, 0.01F, 1.3F},
      {1.15F, kTop, 1.6F});
  return fields;
}

/// A room of 3 x 3 m with a table.
inline WorldFields smallHomeWorld() {
  WorldFields world;
  world.robot = smallHomeRobot();
  world.objects = smallHomeObjects();
  world.objects.radii = {0.016F, 0.05F, 0.12F};
  world.robot.radii = world.objects.radii;
  const BoxRoom room({{{0, -0.25F, 0}, {3, 0, 3}}, {{1, 0, 1}, {2, 0.7F, 2}}});
  world.scene = room.fields(world.objects.radii);
  world.episodes = smallHomeEpisodes();
  return world;
}

/// The small home, opened.
class SmallHome {
 public:
  explicit SmallHome(const WorldFields& fields = smallHomeWorld())
      : path_(writeWorld(folder_, fields)) {
    Result<World> world = World::open(std::span(&path_, 1));
    if (!world) throw std::runtime_error(world.error().text());
    world_ = std::make_unique<World>(std::move(*world));
  }

  [[nodiscard]] const World& world() const { return *world_; }

 private:
  ScratchFolder folder_;
  std::filesystem::path path_;
  std::unique_ptr<World> world_;
};

}  // namespace galactic::test
