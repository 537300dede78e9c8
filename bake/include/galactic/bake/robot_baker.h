#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/render_baker.h"
#include "galactic/bake/robot_recipe.h"
#include "galactic/bake/source_robot.h"
#include "galactic/bake/sphere_set.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/kinematics.h"
#include "galactic/robot.h"

namespace galactic::bake {

struct RobotBakeOptions {
  /// Working set, meters, ascending.
  std::vector<float> radii{0.015F, 0.05F, 0.12F};
  /// Meters. Override the recipe's; without either, 20 and 40 mm.
  std::optional<float> eps;
  std::optional<float> tau;
  /// Of the whole robot; 0: as many as the tolerances need. Overrides the recipe's; without either,
  /// 100, and more where gaps would be wider than the recipe's max_gap (50 mm).
  std::optional<std::uint32_t> max_spheres;
  /// Spheres made by hand or by another tool. Links named here take them instead of fitted ones;
  /// the others get none.
  std::optional<HandSpheres> hand_spheres;

  friend bool operator==(const RobotBakeOptions&, const RobotBakeOptions&) = default;
};

/// Links that no joint moves against each other, and their spheres.
struct BakedGroup {
  /// The link in whose frame the spheres are: the one nearest to the root.
  std::uint32_t link = 0;
  /// Ascending, `link` first.
  std::vector<std::uint32_t> links;
  /// Empty where the group has no geometry or was skipped.
  SphereSet spheres;
  /// What was asked for, meters.
  float eps = 0;
  float tau = 0;
  /// Whether the spheres were given by hand.
  bool authored = false;
  /// Whether the group has geometry that was measured.
  bool measured = false;
};

struct BakedPair {
  std::uint16_t first = 0;
  std::uint16_t second = 0;
  PairKind kind = PairKind::kTested;
};

/// The kinematic tree as the runtime reads it.
struct FlatKinematics {
  std::vector<LinkFrame> links;
  /// One per position.
  std::vector<PositionLimits> limits;
  std::vector<float> start_positions;
};

struct RobotTimes {
  double spheres = 0;
  double self_collision = 0;
  double render = 0;
};

/// Everything of a robot pack but its provenance.
struct BakedRobot {
  std::string name;
  std::vector<float> radii;
  FlatKinematics kinematics;
  std::vector<std::string> link_names;
  std::vector<std::string> joint_names;
  std::vector<BakedGroup> groups;
  std::vector<BakedPair> pairs;
  std::vector<ControlledJoint> controlled_joints;
  std::optional<EndEffector> end_effector;
  std::optional<RobotCamera> camera;
  std::optional<RobotBase> base;
  std::optional<RobotLaser> laser;
  /// One per link; empty where a link has none.
  std::vector<Surface> collision_surfaces;
  std::vector<Surface> visual_surfaces;
  /// What is drawn, where it is wanted: a model per link. Not made by bakeRobot.
  std::optional<BakedRenderMeshes> render_meshes;
  RobotTimes times;
  std::vector<std::string> warnings;
};

/// Kinematics, spheres and self-collision pairs of a robot; `recipe` may be null. Links that lie
/// lower than the clip height get no spheres, with a warning. Fails with kInvalidInput or
/// kUnsupported on names, options, recipe or geometry that cannot give them; `where` names the line
/// of the recipe, the link or the option, or is empty, since the baker knows no file. The result
/// does not depend on the number of threads.
[[nodiscard]] Result<BakedRobot> bakeRobot(const SourceRobot& robot, const RobotRecipe* recipe,
                                           const RobotBakeOptions& options, unsigned threads = 1);

}  // namespace galactic::bake
