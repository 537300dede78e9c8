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
  /// Working set of radii, meters, ascending.
  std::vector<float> radii{0.015F, 0.05F, 0.12F};
  /// Tolerances, meters. They override the recipe's; without either, they are 20 and 40 mm.
  std::optional<float> eps;
  std::optional<float> tau;
  /// Most spheres of the whole robot; 0: as many as the tolerances need. Overrides the recipe's
  /// number. Without either, 100, or more if gaps would be wider than the recipe's max_gap (50 mm).
  std::optional<std::uint32_t> max_spheres;
  /// Spheres made by hand or by another tool. Links named here take them in place of fitted ones;
  /// other links get none.
  std::optional<HandSpheres> hand_spheres;

  friend bool operator==(const RobotBakeOptions&, const RobotBakeOptions&) = default;
};

/// Links that no joint moves relative to each other, and their spheres.
struct BakedGroup {
  /// The link in whose frame the spheres are: the one nearest to the root.
  std::uint32_t link = 0;
  /// Ascending, `link` first.
  std::vector<std::uint32_t> links;
  /// Empty if the group has no geometry or was skipped.
  SphereSet spheres;
  /// The tolerances that were asked for, meters.
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

/// Everything in a robot pack but its provenance.
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
  /// One per link; empty if a link has none.
  std::vector<Surface> collision_surfaces;
  std::vector<Surface> visual_surfaces;
  /// What is drawn, if it is wanted: a model per link. Not made by bakeRobot().
  std::optional<BakedRenderMeshes> render_meshes;
  RobotTimes times;
  std::vector<std::string> warnings;
};

/// Kinematics, spheres and self-collision pairs of a robot; `recipe` may be null. Links that lie
/// lower than the clip height get no spheres, with a warning. Fails with kInvalidInput or
/// kUnsupported if names, options, recipe or geometry make that impossible; `where` names the line
/// of the recipe, the link or the option, or is empty, since the baker does not know the file. The
/// result does not depend on the number of threads.
[[nodiscard]] Result<BakedRobot> bakeRobot(const SourceRobot& robot, const RobotRecipe* recipe,
                                           const RobotBakeOptions& options, unsigned threads = 1);

}  // namespace galactic::bake
