#pragma once
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "galactic/world.h"
#include "support/homes/box_room.h"
#include "support/packs/episode_pack_builder.h"
#include "support/packs/object_pack_builder.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::test {

/// Where an episode begins; its first object is the target.
struct Start {
  Vec3 base;
  float yaw = 0;
  std::vector<Vec3> objects{};
};

/// The positions of cartRobot's joints, and its actions.
inline constexpr std::size_t kCartJoints = 2;
inline constexpr std::size_t kCartActions = kCartJoints + 4;

/// A cart with a ball of 12 cm, 30 cm above the floor, from whose middle an arm slides forward with
/// a ball of 5 cm at its end and, on a wrist that turns about the vertical without limits, one of
/// 1.5 cm. Drawn in, the arm is inside the cart's ball. It grasps what is
/// 12 cm from the end of its arm.
inline RobotPackFields cartRobot() {
  constexpr float kUnlimited = std::numeric_limits<float>::max();
  RobotPackFields robot;
  robot.name = "cart";
  robot.radii.assign(BoxRoom::kRadii.begin(), BoxRoom::kRadii.end());
  robot.links.resize(3);
  robot.links[1].parent_from_joint.translation = {0, 0.3F, 0};
  robot.links[1].parent = 0;
  robot.links[1].type = JointType::kPrismatic;
  robot.links[1].position = 0;
  robot.links[2].parent = 1;
  robot.links[2].axis = {0, 1, 0};
  robot.links[2].type = JointType::kContinuous;
  robot.links[2].position = 1;
  robot.link_names = {"cart", "arm", "hand"};
  robot.joint_names = {"", "slide", "wrist"};
  robot.limits = {{0, 0.6F}, {-kUnlimited, kUnlimited}};
  robot.start_positions = {0, 0};
  robot.spheres = {{{0, 0.3F, 0}, 2}, {{0, 0, 0}, 1}, {{-0.03F, 0, 0}, 0}};
  robot.groups = {
      {0, {0}, 0, 1, std::nullopt}, {1, {1}, 1, 1, std::nullopt}, {2, {2}, 2, 1, std::nullopt}};
  robot.controlled_joints = {{0, 0.3F, 0, 0.6F}, {1, 0.25F, -kUnlimited, kUnlimited}};
  robot.end_effector = EndEffectorFields{2, Vec3{}, 0.12F};
  robot.camera.reset();
  robot.laser.reset();
  robot.base->root_height = 0;
  return robot;
}

/// A cube of 20 cm, held as a ball of 5 cm and eight of 1.5 cm.
inline ObjectPackFields cubes() {
  ObjectPackFields fields;
  fields.radii.assign(BoxRoom::kRadii.begin(), BoxRoom::kRadii.end());
  ObjectFields cube;
  cube.name = "cube";
  cube.spheres = {{{0, 0.1F, 0}, 1}};
  for (const float x : {-0.085F, 0.085F}) {
    for (const float y : {0.015F, 0.185F}) {
      for (const float z : {-0.085F, 0.085F}) cube.spheres.push_back({{x, y, z}, 0});
    }
  }
  sortSpheres(cube.spheres);
  fields.objects = {cube};
  return fields;
}

/// Episodes that begin as told, with cubes.
inline EpisodePackFields episodesFrom(const std::vector<Start>& starts) {
  EpisodePackFields fields;
  fields.objects = {"cube"};
  fields.robot.clear();
  fields.start_joints.clear();
  for (const Start& start : starts) {
    fields.episodes.push_back(
        {.scene = 0,
         .first_placement = static_cast<std::uint32_t>(fields.placements.size()),
         .placement_count = static_cast<std::uint32_t>(start.objects.size()),
         .target = 0,
         .base_position = start.base,
         .base_yaw = start.yaw,
         .goal = {{1.5F, 0.75F, 1.5F}, {}}});
    for (const Vec3& at : start.objects) fields.placements.push_back({0, {at, {}}});
  }
  return fields;
}

/// A world in memory: a room of blocks, and packs of objects, robot and episodes.
class BoxWorld {
 public:
  BoxWorld(std::vector<Block> blocks, const std::vector<Start>& starts)
      : BoxWorld(std::move(blocks), cartRobot(), episodesFrom(starts)) {}

  /// The robot may have its spheres in another order than packs do.
  BoxWorld(std::vector<Block> blocks, const RobotPackFields& robot,
           const EpisodePackFields& episodes)
      : room_(std::move(blocks)),
        objects_(buildPack(cubes())),
        robot_(buildPack(robot)),
        episodes_(buildPack(episodes)),
        world_(open()) {}

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const BoxRoom& room() const { return room_; }

 private:
  [[nodiscard]] World open() const {
    std::vector<PackFile> packs;
    packs.reserve(4);
    // BoxRoom's columns are a little further apart than those of packs may be.
    packs.push_back(opened(PackFile::view(room_.bytes(), "room", Trust::kTrusted)));
    packs.push_back(opened(PackFile::view(objects_.bytes(), "objects")));
    packs.push_back(opened(PackFile::view(robot_.bytes(), "robot", Trust::kTrusted)));
    packs.push_back(opened(PackFile::view(episodes_.bytes(), "episodes")));
    return opened(World::from(std::move(packs)));
  }

  template <class T>
  static T opened(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().text());
    return std::move(*result);
  }

  BoxRoom room_;
  AlignedBytes objects_;
  AlignedBytes robot_;
  AlignedBytes episodes_;
  World world_;
};

/// A floor of 3 x 3 m at height 0.
inline Block plainFloor() { return {{0, -0.25F, 0}, {3, 0, 3}}; }

}  // namespace galactic::test
