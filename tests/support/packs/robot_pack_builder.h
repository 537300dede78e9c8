#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "galactic/kinematics.h"
#include "galactic/robot.h"
#include "support/packs/pack_parts.h"
#include "support/packs/render_pack_builder.h"

namespace galactic::test {

struct GroupFields {
  std::uint32_t link = 0;
  std::vector<std::uint32_t> links;
  std::uint32_t first_sphere = 0;
  std::uint32_t sphere_count = 0;
  std::optional<SphereStatisticsFields> statistics = SphereStatisticsFields{};
};

struct PairFields {
  std::uint16_t first = 0;
  std::uint16_t second = 0;
  std::uint8_t kind = 0;
};

struct EndEffectorFields {
  std::uint32_t link = 3;
  std::optional<Vec3> grasp_point = Vec3{0.1F, 0, 0};
  float grasp_radius = 0.015F;
};

struct CameraFields {
  std::uint32_t link = 1;
  std::optional<Pose> link_from_camera = Pose{{0, 0.2F, 0}, {0, 0, 0, 1}};
  float vertical_fov = 1;
};

struct BaseFields {
  float forward_step = 0.1F;
  float turn_step = 0.05F;
  float sideways_step = 0;
  float root_height = 0.25F;
  std::optional<Vec3> footprint_min = Vec3{-0.3F, 0, -0.2F};
  std::optional<Vec3> footprint_max = Vec3{0.3F, 0, 0.2F};
  float footprint_radius = 0;
};

struct LaserFields {
  std::uint32_t link = 0;
  std::optional<Pose> link_from_laser = Pose{{0.1F, 0.2F, 0}, {0, 0, 0, 1}};
  float field_of_view = 4;
  float least_range = 0.05F;
  float range = 8;
  float noise = 0.01F;
};

struct LinkSurfaceFields {
  std::uint32_t link = 0;
  std::optional<SurfaceFields> collision;
  std::optional<SurfaceFields> visual;
};

/// All that a robot pack holds. buildPack makes a pack that is valid in every field that was left
/// as it is.
struct RobotPackFields {
  PackKind kind = PackKind::kRobot;
  std::string name;
  std::vector<float> radii{0.015F, 0.05F};
  std::vector<LinkFrame> links;
  /// Not checked by the type of LinkFrame: what the n-th link's type is stored as.
  std::optional<std::uint8_t> last_type;
  std::vector<std::string> link_names;
  std::vector<std::string> joint_names;
  std::vector<PositionLimits> limits;
  std::vector<float> start_positions;
  std::vector<SetSphere> spheres;
  std::vector<GroupFields> groups;
  std::vector<PairFields> group_pairs;
  std::vector<ControlledJoint> controlled_joints;
  std::optional<EndEffectorFields> end_effector = EndEffectorFields{};
  std::optional<CameraFields> camera = CameraFields{};
  std::optional<BaseFields> base = BaseFields{};
  std::vector<LinkSurfaceFields> surfaces;
  RenderMeshesField render_meshes;
  std::optional<LaserFields> laser = LaserFields{};
};

/// base - torso (prismatic) - arm (revolute) - hand (continuous), with a finger that mimics the
/// arm, a lid fixed to the base, and a tray on a planar joint that carries a floating ball.
RobotPackFields smallRobotPack();

AlignedBytes buildPack(const RobotPackFields& fields);

}  // namespace galactic::test
