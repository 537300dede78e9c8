#include "support/packs/robot_pack_builder.h"

#include <limits>

#include "support/packs/schema_parts.h"

namespace galactic::test {
namespace {

/// Makes packs of RobotPackFields.
class RobotPackBuilder {
 public:
  explicit RobotPackBuilder(const RobotPackFields& fields) : fields_(fields) {}

  /// The whole file: header and payload.
  [[nodiscard]] AlignedBytes build() {
    const auto name = builder_.CreateString(fields_.name);
    const auto radii = builder_.CreateVector(fields_.radii);
    const auto links = buildLinks();
    const auto link_names = builder_.CreateVectorOfStrings(fields_.link_names);
    const auto joint_names = builder_.CreateVectorOfStrings(fields_.joint_names);
    std::vector<schema::PositionLimits> limits;
    for (const PositionLimits& one : fields_.limits) limits.emplace_back(one.lower, one.upper);
    const auto limit_vector = alignedStructs(builder_, limits);
    const auto start_positions = alignedNumbers(builder_, fields_.start_positions);
    const auto spheres = buildSpheres(builder_, fields_.spheres);
    const auto groups = buildGroups();
    std::vector<schema::GroupPair> pairs;
    for (const PairFields& pair : fields_.group_pairs) {
      pairs.emplace_back(pair.first, pair.second, static_cast<schema::PairKind>(pair.kind));
    }
    const auto pair_vector = builder_.CreateVectorOfStructs(pairs);
    std::vector<schema::ControlledJoint> joints;
    for (const ControlledJoint& joint : fields_.controlled_joints) {
      joints.emplace_back(joint.position, joint.step, joint.lower, joint.upper);
    }
    const auto joint_vector = builder_.CreateVectorOfStructs(joints);
    const auto end_effector = buildEndEffector();
    const auto camera = buildCamera();
    const auto base = buildBase();
    const auto surfaces = buildSurfaces();
    const auto meshes = buildRenderMeshesField(builder_, fields_.render_meshes);
    const auto robot =
        schema::CreateRobot(builder_, name, radii, links, link_names, joint_names, limit_vector,
                            start_positions, spheres, groups, pair_vector, joint_vector,
                            end_effector, camera, base, surfaces, meshes, buildLaser());
    return finishFile(builder_, fields_.kind, schema::Asset::Robot, robot.Union());
  }

 private:
  flatbuffers::Offset<flatbuffers::Vector<const schema::LinkFrame*>> buildLinks() {
    std::vector<schema::LinkFrame> links;
    for (std::size_t n = 0; n < fields_.links.size(); ++n) {
      const LinkFrame& link = fields_.links[n];
      const bool last = n + 1 == fields_.links.size();
      const auto type =
          last && fields_.last_type ? *fields_.last_type : static_cast<std::uint8_t>(link.type);
      links.emplace_back(stored(link.parent_from_joint), stored(link.axis), link.parent,
                         link.position, link.multiplier, link.offset,
                         static_cast<schema::JointType>(type));
    }
    return alignedStructs(builder_, links);
  }

  flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<schema::SphereGroup>>> buildGroups() {
    std::vector<flatbuffers::Offset<schema::SphereGroup>> groups;
    for (const GroupFields& group : fields_.groups) {
      flatbuffers::Offset<schema::SphereSetStatistics> statistics;
      if (group.statistics) statistics = buildStatistics(builder_, *group.statistics);
      const auto links = builder_.CreateVector(group.links);
      groups.push_back(schema::CreateSphereGroup(builder_, group.link, links, group.first_sphere,
                                                 group.sphere_count, statistics));
    }
    return builder_.CreateVector(groups);
  }

  flatbuffers::Offset<schema::EndEffector> buildEndEffector() {
    if (!fields_.end_effector) return {};
    const EndEffectorFields& fields = *fields_.end_effector;
    const schema::Vec3 point = stored(fields.grasp_point.value_or(Vec3{}));
    return schema::CreateEndEffector(builder_, fields.link, fields.grasp_point ? &point : nullptr,
                                     fields.grasp_radius);
  }

  flatbuffers::Offset<schema::Camera> buildCamera() {
    if (!fields_.camera) return {};
    const CameraFields& fields = *fields_.camera;
    const schema::Pose pose = stored(fields.link_from_camera.value_or(Pose{}));
    return schema::CreateCamera(builder_, fields.link, fields.link_from_camera ? &pose : nullptr,
                                fields.vertical_fov);
  }

  flatbuffers::Offset<schema::Laser> buildLaser() {
    if (!fields_.laser) return {};
    const LaserFields& fields = *fields_.laser;
    const schema::Pose pose = stored(fields.link_from_laser.value_or(Pose{}));
    return schema::CreateLaser(builder_, fields.link, fields.link_from_laser ? &pose : nullptr,
                               fields.field_of_view, fields.least_range, fields.range,
                               fields.noise);
  }

  flatbuffers::Offset<schema::Base> buildBase() {
    if (!fields_.base) return {};
    const BaseFields& fields = *fields_.base;
    const schema::Vec3 min = stored(fields.footprint_min.value_or(Vec3{}));
    const schema::Vec3 max = stored(fields.footprint_max.value_or(Vec3{}));
    return schema::CreateBase(builder_, fields.forward_step, fields.turn_step, fields.root_height,
                              fields.footprint_min ? &min : nullptr,
                              fields.footprint_max ? &max : nullptr, fields.footprint_radius,
                              fields.sideways_step);
  }

  flatbuffers::Offset<flatbuffers::Vector<flatbuffers::Offset<schema::LinkSurface>>>
  buildSurfaces() {
    std::vector<flatbuffers::Offset<schema::LinkSurface>> surfaces;
    for (const LinkSurfaceFields& fields : fields_.surfaces) {
      flatbuffers::Offset<schema::Surface> collision;
      flatbuffers::Offset<schema::Surface> visual;
      if (fields.collision) collision = buildSurface(builder_, *fields.collision);
      if (fields.visual) visual = buildSurface(builder_, *fields.visual);
      surfaces.push_back(schema::CreateLinkSurface(builder_, fields.link, collision, visual));
    }
    return builder_.CreateVector(surfaces);
  }

  const RobotPackFields& fields_;
  flatbuffers::FlatBufferBuilder builder_;
};

}  // namespace

RobotPackFields smallRobotPack() {
  constexpr float kUnlimited = std::numeric_limits<float>::max();
  const auto link = [](std::int32_t parent, JointType type, std::int32_t position) {
    LinkFrame frame;
    frame.parent_from_joint = {{0.125F, 0.25F, 0}, {0, 0.6F, 0, 0.8F}};
    frame.axis = {0, 1, 0};
    frame.parent = parent;
    frame.type = type;
    frame.position = position;
    return frame;
  };
  RobotPackFields robot;
  robot.name = "helper";
  robot.links = {link(-1, JointType::kFixed, -1),  link(0, JointType::kPrismatic, 0),
                 link(1, JointType::kRevolute, 1), link(2, JointType::kContinuous, 2),
                 link(3, JointType::kRevolute, 1), link(0, JointType::kFixed, -1),
                 link(0, JointType::kPlanar, 3),   link(6, JointType::kFloating, 6)};
  robot.links[4].multiplier = -0.5F;
  robot.links[4].offset = 0.25F;
  robot.link_names = {"base", "torso", "arm", "hand", "finger", "lid", "tray", "ball"};
  robot.joint_names = {"", "lift", "elbow", "wrist", "grip", "hinge", "slide", "free"};
  robot.limits.assign(13, {-kUnlimited, kUnlimited});
  robot.limits[0] = {0, 0.5F};
  robot.limits[1] = {-1, 2};
  robot.start_positions.assign(13, 0);
  robot.start_positions[0] = 0.125F;
  robot.start_positions[12] = 1;
  robot.spheres = {{{0, 0.1F, 0}, 1}, {{0.1F, 0, 0}, 0}, {{0.2F, 0, 0}, 0}, {{0, 0, 0}, 1}};
  robot.groups = {{0, {0, 5}, 0, 2, SphereStatisticsFields{}},
                  {1, {1}, 2, 0, std::nullopt},
                  {2, {2}, 2, 1, SphereStatisticsFields{}},
                  {3, {3}, 3, 1, SphereStatisticsFields{}},
                  {4, {4}, 4, 0, std::nullopt},
                  {6, {6}, 4, 0, std::nullopt},
                  {7, {7}, 4, 0, std::nullopt}};
  robot.group_pairs = {{0, 2, 0}, {0, 3, 3}, {2, 3, 1}};
  robot.controlled_joints = {{1, 0.2F, -0.5F, 1.5F}, {0, 0.05F, 0, 0.5F}};
  robot.surfaces = {{0, SurfaceFields{}, SurfaceFields{}},
                    {2, SurfaceFields{}, std::nullopt},
                    {3, std::nullopt, SurfaceFields{}}};
  return robot;
}

AlignedBytes buildPack(const RobotPackFields& fields) { return RobotPackBuilder(fields).build(); }

}  // namespace galactic::test
