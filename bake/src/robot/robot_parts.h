#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "galactic/bake/robot_baker.h"
#include "galactic/bake/robot_recipe.h"
#include "galactic/bake/source_robot.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// The greatest distance between the surface of a tessellated cylinder or sphere and the shape.
/// Meters.
inline constexpr double kTessellationError = 1e-4;

/// Color of links that have none of their own, linear RGBA.
inline constexpr std::array<float, 4> kPlainColor{0.55F, 0.55F, 0.57F, 1.0F};

/// A box, cylinder or sphere as a surface in the link's frame; empty for a mesh.
[[nodiscard]] Surface surfaceOfPrimitive(const LinkShape& shape);

/// The shapes of one link as one colored surface in the link's frame. Boxes are exact; cylinders
/// and spheres are tessellated to within kTessellationError (beyond a radius of 0.6 m: to 256 steps
/// around), with vertices on the shape.
[[nodiscard]] Surface surfaceOfShapes(const SourceRobot& robot,
                                      const std::vector<LinkShape>& shapes);

/// The shapes that are drawn of a link: its visuals, or its collisions if all visuals were lost.
/// Links without visuals in the robot's file are not drawn.
[[nodiscard]] const std::vector<LinkShape>& drawnShapes(const SourceLink& link);

/// Links that count as one rigid body.
struct RigidGroup {
  /// The link nearest to the root, whose frame is that of the group.
  std::uint32_t link = 0;
  /// Ascending, `link` first.
  std::vector<std::uint32_t> links;
  /// group_from_link of each of `links`.
  std::vector<Affine> group_from_link;
};

/// The groups of `robot`, by ascending first link: links connected by fixed joints, and those that
/// the recipe (may be null) merges with their parent. If a merged joint can move, the shape of its
/// group is that at `start`, which holds joint_from_link of each link at the start positions.
[[nodiscard]] std::vector<RigidGroup> findRigidGroups(const SourceRobot& robot,
                                                      const RobotRecipe* recipe,
                                                      const std::vector<Affine>& start);

/// The rigid transform in the representation of the runtime. Exact except for float rounding.
[[nodiscard]] Pose poseOf(const Affine& rigid);

/// Links, limits and start positions of `robot` in the form that the runtime reads. A joint that
/// mimics another has no position of its own. The start position of a joint is the one in the
/// recipe's start pose, if any, or else its rest position in the robot's file, or else 0; moved to
/// the nearest limit, including those of `recipe` (may be null), if it is outside.
[[nodiscard]] FlatKinematics flattenKinematics(const SourceRobot& robot, const RobotRecipe* recipe);

/// Number of joint vectors that are tried to find out which groups can touch.
inline constexpr std::size_t kSelfCollisionSamples = 4000;

/// Classifies each pair of groups with spheres by trying the start pose and random joint vectors
/// within the limits (a full turn if there are none), from a fixed seed. Groups joined by a joint,
/// directly or through groups without spheres, are adjacent; `ignored` holds pairs of links that
/// may touch. Deterministic.
[[nodiscard]] std::vector<BakedPair> classifyPairs(
    const BakedRobot& robot, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& ignored);

}  // namespace galactic::bake
