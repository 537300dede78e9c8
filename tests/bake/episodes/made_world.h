#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "support/homes/sample_world.h"
#include "support/packs/object_pack_builder.h"
#include "support/packs/robot_pack_builder.h"
#include "support/source_asset.h"
#include "support/test_meshes.h"

namespace galactic::test {

/// The radii of all made packs.
inline std::vector<float> madeRadii() { return {0.015F, 0.05F, 0.12F}; }

/// A closed room from the origin to (width, height, depth), its floor at y = 0.
inline MeshBuilder madeRoom(float width, float depth, float height = 2.5F) {
  MeshBuilder room;
  constexpr float kWall = 0.1F;
  room.box({-kWall, -kWall, -kWall}, {width + kWall, 0, depth + kWall});
  room.box({-kWall, height, -kWall}, {width + kWall, height + kWall, depth + kWall});
  room.box({-kWall, 0, -kWall}, {0, height, depth + kWall});
  room.box({width, 0, -kWall}, {width + kWall, height, depth + kWall});
  room.box({0, 0, -kWall}, {width, height, 0});
  room.box({0, 0, depth}, {width, height, depth + kWall});
  return room;
}

/// `source_bytes`: of the file that the pack says it was baked from.
inline MemoryPack scenePackOf(const bake::TriangleMesh& mesh, const std::string& name = "room",
                              const std::vector<float>& radii = madeRadii(),
                              std::uint64_t source_bytes = 1234) {
  bake::SceneBakeOptions options;
  options.radii = radii;
  options.check_columns = 0;
  bake::StageTimes times;
  const auto silent = [](std::string_view, double) {};
  const auto scene =
      MemoryPack::opened(bake::bakeScene(sourceAssetOf(mesh, name), options, times, silent));
  bake::Provenance provenance = testProvenance(name);
  provenance.sources.front().bytes = source_bytes;
  return {PackKind::kScene, MemoryPack::opened(bake::encodeScenePack(scene, provenance)), name};
}

/// A cube of 8 cm that stands on its bottom only.
inline MemoryPack cubePack(const std::string& name = "cube") {
  ObjectPackFields fields;
  fields.radii = madeRadii();
  ObjectFields& cube = fields.objects.emplace_back();
  constexpr float kHalf = 0.04F;
  cube.name = name;
  cube.box_pose = Pose{{0, kHalf, 0}, {}};
  cube.box_half_extents = Vec3{kHalf, kHalf, kHalf};
  cube.spheres = {{{0, kHalf, 0}, 1}};
  cube.stable_poses = {{{}, 0, 1}};
  return {buildPack(fields), name};
}

/// A base of one sphere, a shoulder 0.7 m high that turns and lifts, an upper arm and a forearm of
/// 0.4 m each with a sphere in the middle, folded upwards at the start.
inline RobotPackFields stickRobot() {
  RobotPackFields robot;
  robot.name = "stick";
  robot.radii = madeRadii();
  const auto link = [](std::int32_t parent, const Vec3& at, const Vec3& axis,
                       std::int32_t position) {
    LinkFrame frame;
    frame.parent_from_joint = {at, {}};
    frame.axis = axis;
    frame.parent = parent;
    frame.position = position;
    frame.type = position < 0 ? JointType::kFixed : JointType::kRevolute;
    return frame;
  };
  robot.links = {link(-1, {}, {1, 0, 0}, -1), link(0, {0, 0.7F, 0}, {0, 1, 0}, 0),
                 link(1, {}, {0, 0, 1}, 1), link(2, {0.4F, 0, 0}, {0, 0, 1}, 2)};
  robot.link_names = {"base", "shoulder", "upper_arm", "forearm"};
  robot.joint_names = {"", "turn", "lift", "bend"};
  robot.limits = {{-1.5F, 1.5F}, {-1.5F, 1.6F}, {-2.8F, 2.8F}};
  robot.start_positions = {0, 1.5F, 2.8F};
  robot.spheres = {{{0, 0.2F, 0}, 2}, {{0.2F, 0, 0}, 1}, {{0.2F, 0, 0}, 1}};
  robot.groups = {{0, {0}, 0, 1, SphereStatisticsFields{}},
                  {1, {1}, 1, 0, std::nullopt},
                  {2, {2}, 1, 1, SphereStatisticsFields{}},
                  {3, {3}, 2, 1, SphereStatisticsFields{}}};
  robot.group_pairs = {{0, 2, 0}, {0, 3, 0}, {2, 3, 1}};
  robot.controlled_joints = {
      {0, 0.2F, -1.5F, 1.5F}, {1, 0.2F, -1.5F, 1.6F}, {2, 0.2F, -2.8F, 2.8F}};
  robot.end_effector = EndEffectorFields{.link = 3, .grasp_point = Vec3{0.4F, 0, 0}};
  robot.end_effector->grasp_radius = 0.05F;
  robot.camera = std::nullopt;
  robot.base = BaseFields{};
  robot.base->root_height = 0;
  return robot;
}

/// Everything that a generator reads, made by hand.
class MadeWorld {
 public:
  MadeWorld(const bake::TriangleMesh& mesh, const RobotPackFields& robot)
      : scene_pack_(scenePackOf(mesh)),
        object_pack_(cubePack()),
        robot_pack_(buildPack(robot), "r") {
    scenes_.push_back(MemoryPack::opened(Scene::from(scene_pack_.pack())));
    objects_.push_back(MemoryPack::opened(ObjectSet::from(object_pack_.pack())));
    robots_.push_back(MemoryPack::opened(Robot::from(robot_pack_.pack())));
  }

  [[nodiscard]] std::vector<const PackFile*> packs() const {
    return {&scene_pack_.pack(), &object_pack_.pack(), &robot_pack_.pack()};
  }
  [[nodiscard]] const Scene& scene() const { return scenes_.front(); }
  [[nodiscard]] const ObjectSet& objects() const { return objects_.front(); }
  [[nodiscard]] const Robot& robot() const { return robots_.front(); }

 private:
  MemoryPack scene_pack_;
  MemoryPack object_pack_;
  MemoryPack robot_pack_;
  std::vector<Scene> scenes_;
  /// One each; vectors because neither can be made empty.
  std::vector<ObjectSet> objects_;
  std::vector<Robot> robots_;
};

}  // namespace galactic::test
