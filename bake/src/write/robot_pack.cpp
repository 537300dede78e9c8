#include <fmt/format.h>

#include "galactic/bake/packs.h"
#include "support/try.h"
#include "write/pack_payload.h"
#include "write/render_meshes.h"

namespace galactic::bake {
namespace {

Offset<schema::SphereGroup> groupTable(FlatBufferBuilder& builder, const BakedGroup& group,
                                       std::size_t first_sphere) {
  const auto links = builder.CreateVector(group.links);
  Offset<schema::SphereSetStatistics> statistics;
  if (group.measured) {
    statistics = sphereStatistics(builder, group.spheres,
                                  {.eps = group.eps, .tau = group.tau, .authored = group.authored});
  }
  return schema::CreateSphereGroup(
      builder, group.link, links, static_cast<std::uint32_t>(first_sphere),
      static_cast<std::uint32_t>(group.spheres.spheres.size()), statistics);
}

/// Copied field by field, because the padding in our structs would not be zero.
std::vector<schema::LinkFrame> linkFrames(const std::vector<LinkFrame>& links) {
  std::vector<schema::LinkFrame> stored;
  stored.reserve(links.size());
  for (const LinkFrame& link : links) {
    stored.emplace_back(toSchema(link.parent_from_joint), toSchema(link.axis), link.parent,
                        link.position, link.multiplier, link.offset,
                        static_cast<schema::JointType>(link.type));
  }
  return stored;
}

Offset<schema::LinkSurface> linkSurface(FlatBufferBuilder& builder, const BakedRobot& robot,
                                        std::size_t link) {
  Offset<schema::Surface> collision;
  Offset<schema::Surface> visual;
  if (!robot.collision_surfaces[link].empty()) {
    collision = surfaceTable(builder, robot.collision_surfaces[link]);
  }
  if (!robot.visual_surfaces[link].empty()) {
    visual = surfaceTable(builder, robot.visual_surfaces[link]);
  }
  return schema::CreateLinkSurface(builder, static_cast<std::uint32_t>(link), collision, visual);
}

Offset<flatbuffers::Vector<Offset<schema::LinkSurface>>> linkSurfaces(FlatBufferBuilder& builder,
                                                                      const BakedRobot& robot) {
  std::vector<Offset<schema::LinkSurface>> surfaces;
  for (std::size_t n = 0; n < robot.kinematics.links.size(); ++n) {
    if (robot.collision_surfaces[n].empty() && robot.visual_surfaces[n].empty()) continue;
    surfaces.push_back(linkSurface(builder, robot, n));
  }
  return builder.CreateVector(surfaces);
}

/// The tables that the recipe adds; null offsets without a recipe.
struct RecipeTables {
  Offset<flatbuffers::Vector<const schema::ControlledJoint*>> controlled_joints;
  Offset<schema::EndEffector> end_effector;
  Offset<schema::Camera> camera;
  Offset<schema::Base> base;
  Offset<schema::Laser> laser;
};

RecipeTables recipeTables(FlatBufferBuilder& builder, const BakedRobot& robot) {
  RecipeTables tables;
  std::vector<schema::ControlledJoint> joints;
  for (const ControlledJoint& joint : robot.controlled_joints) {
    joints.emplace_back(joint.position, joint.step, joint.lower, joint.upper);
  }
  tables.controlled_joints = builder.CreateVectorOfStructs(joints);
  if (robot.end_effector) {
    const schema::Vec3 point = toSchema(robot.end_effector->grasp_point);
    tables.end_effector = schema::CreateEndEffector(builder, robot.end_effector->link, &point,
                                                    robot.end_effector->grasp_radius);
  }
  if (robot.camera) {
    const schema::Pose pose = toSchema(robot.camera->link_from_camera);
    tables.camera =
        schema::CreateCamera(builder, robot.camera->link, &pose, robot.camera->vertical_fov);
  }
  if (robot.base) {
    const schema::Vec3 min = toSchema(robot.base->footprint_min);
    const schema::Vec3 max = toSchema(robot.base->footprint_max);
    tables.base = schema::CreateBase(builder, robot.base->forward_step, robot.base->turn_step,
                                     robot.base->root_height, &min, &max,
                                     robot.base->footprint_radius, robot.base->sideways_step);
  }
  if (robot.laser) {
    const schema::Pose pose = toSchema(robot.laser->link_from_laser);
    tables.laser =
        schema::CreateLaser(builder, robot.laser->link, &pose, robot.laser->field_of_view,
                            robot.laser->least_range, robot.laser->range, robot.laser->noise);
  }
  return tables;
}

Offset<schema::Robot> robotTable(FlatBufferBuilder& builder, const BakedRobot& robot) {
  std::vector<SetSphere> spheres;
  std::vector<Offset<schema::SphereGroup>> groups;
  for (const BakedGroup& group : robot.groups) {
    groups.push_back(groupTable(builder, group, spheres.size()));
    spheres.insert(spheres.end(), group.spheres.spheres.begin(), group.spheres.spheres.end());
  }
  std::vector<schema::GroupPair> pairs;
  for (const BakedPair& pair : robot.pairs) {
    pairs.emplace_back(pair.first, pair.second, static_cast<schema::PairKind>(pair.kind));
  }
  Offset<schema::RenderMeshes> render_meshes;
  if (robot.render_meshes) render_meshes = renderMeshesTable(builder, *robot.render_meshes);
  const RecipeTables recipe = recipeTables(builder, robot);
  const auto surfaces = linkSurfaces(builder, robot);
  const auto pair_vector = builder.CreateVectorOfStructs(pairs);
  const auto group_vector = builder.CreateVector(groups);
  const auto sphere_vector = alignedStructs<schema::SetSphere>(builder, spheres);
  const auto start = alignedVector<float>(builder, robot.kinematics.start_positions);
  const auto limits = alignedStructs<schema::PositionLimits>(builder, robot.kinematics.limits);
  const auto joint_names = builder.CreateVectorOfStrings(robot.joint_names);
  const auto link_names = builder.CreateVectorOfStrings(robot.link_names);
  const std::vector<schema::LinkFrame> frames = linkFrames(robot.kinematics.links);
  const auto links = alignedStructs<schema::LinkFrame>(builder, frames);
  const auto radii = builder.CreateVector(robot.radii);
  const auto name = builder.CreateString(robot.name);
  return schema::CreateRobot(builder, name, radii, links, link_names, joint_names, limits, start,
                             sphere_vector, group_vector, pair_vector, recipe.controlled_joints,
                             recipe.end_effector, recipe.camera, recipe.base, surfaces,
                             render_meshes, recipe.laser);
}

}  // namespace

Result<std::vector<std::byte>> encodeRobotPack(const BakedRobot& robot,
                                               const Provenance& provenance) {
  std::uint64_t bytes = 0;
  for (const auto* surfaces : {&robot.collision_surfaces, &robot.visual_surfaces}) {
    for (const Surface& surface : *surfaces) bytes += storedBytes(surface);
  }
  if (robot.render_meshes) bytes += robot.render_meshes->storedBytes();
  if (bytes > kMaxSurfaceBytes) {
    return fail(ErrorCode::kUnsupported, robot.name,
                fmt::format("the links' meshes need {} MB, one pack holds less than 2048 MB; "
                            "simplify them",
                            bytes >> 20U));
  }
  FlatBufferBuilder builder(static_cast<std::size_t>(bytes) + 65536);
  const auto provenance_table = provenanceTable(builder, provenance);
  const auto robot_table = robotTable(builder, robot);
  return finishPack(builder, provenance_table, schema::Asset::Robot, robot_table.Union());
}

Result<std::uint64_t> writeRobotPack(const std::filesystem::path& path, const BakedRobot& robot,
                                     const Provenance& provenance) {
  ASSIGN_OR_RETURN(const auto payload, encodeRobotPack(robot, provenance));
  return writePackFile(path, PackKind::kRobot, payload);
}

}  // namespace galactic::bake
