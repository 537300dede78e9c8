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

/// No point of a tessellated cylinder or sphere is further than this from the shape. Meters.
inline constexpr double kTessellationError = 1e-4;

/// What a link without a color of its own looks like, linear RGBA.
inline constexpr std::array<float, 4> kPlainColor{0.55F, 0.55F, 0.57F, 1.0F};

/// A box, cylinder or sphere as a surface in the link's frame; empty for a mesh.
[[nodiscard]] Surface surfaceOfPrimitive(const LinkShape& shape);

/// The shapes of one link as one colored surface in the link's frame. Boxes are exact; cylinders
/// and spheres are tessellated to within kTessellationError (beyond a radius of 0.6 m: to 256 steps
/// around), with vertices on the shape.
[[nodiscard]] Surface surfaceOfShapes(const SourceRobot& robot,
                                      const std::vector<LinkShape>& shapes);

/// What is drawn of a link: its visuals, or its collisions where all visuals were lost. A link
/// without any in its file is not drawn.
[[nodiscard]] const std::vector<LinkShape>& drawnShapes(const SourceLink& link);

/// Links that count as one rigid body.
struct RigidGroup {
  /// The link nearest to the root: the frame of the group.
  std::uint32_t link = 0;
  /// Ascending, `link` first.
  std::vector<std::uint32_t> links;
  /// group_from_link of each of `links`.
  std::vector<Affine> group_from_link;
};

/// The groups of `robot`, by ascending first link: links joined by fixed joints, and those that the
/// recipe (may be null) merges with their parent. Where a merged joint can move, the group has its
/// shape at `start`: the transform joint_from_link of each link at the start positions.
[[nodiscard]] std::vector<RigidGroup> findRigidGroups(const SourceRobot& robot,
                                                      const RobotRecipe* recipe,
                                                      const std::vector<Affine>& start);

/// The rigid transform as the runtime holds it. Exact to float rounding.
[[nodiscard]] Pose poseOf(const Affine& rigid);

/// Links, limits and start positions of `robot` as the runtime reads them. A joint that mimics
/// another has no position of its own. Joints start where the robot's file has them
/// rest, else at 0, or at their limit nearest to it, those of `recipe` (may be null) included,
/// unless the recipe's start pose says otherwise.
[[nodiscard]] FlatKinematics flattenKinematics(const SourceRobot& robot, const RobotRecipe* recipe);

/// Joint vectors tried to find out which groups can touch.
inline constexpr std::size_t kSelfCollisionSamples = 4000;

/// What each pair of groups with spheres does over the start pose and random joint vectors within
/// the limits (a full turn where there is none), from a fixed seed. Groups joined by a joint are
/// adjacent; `ignored` holds ascending pairs of links that may touch. Deterministic.
[[nodiscard]] std::vector<BakedPair> classifyPairs(
    const BakedRobot& robot, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& ignored);

}  // namespace galactic::bake
