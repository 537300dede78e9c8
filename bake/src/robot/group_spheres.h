#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/bake/robot_baker.h"
#include "galactic/bake/sphere_set.h"
#include "galactic/error.h"
#include "robot/robot_parts.h"

namespace galactic::bake {

/// The sets of one curve, by ascending number of spheres.
using CurvePoints = std::vector<CurvePoint>;

/// Chooses a set of each curve, so that all together have at most `budget` spheres (0: no limit,
/// the finest sets) and the least sum of errors. Exact, by dynamic programming over the number of
/// spheres (a multiple-choice knapsack). Of equally good choices it takes the one with the coarser
/// sets for the last curves. If even the coarsest sets exceed the budget, it returns those. Curves
/// may be empty; the sets of a curve must ascend in their number of spheres. Deterministic; the
/// work grows with budget times sets.
[[nodiscard]] std::vector<std::size_t> spendBudget(const std::vector<CurvePoints>& curves,
                                                   std::uint32_t budget);

/// The same, but only with sets whose gaps are at most `widest_gap`, in meters; if a curve has no
/// such set, only with its finest one. Exceeds the budget if even the coarsest of these need more
/// spheres.
[[nodiscard]] std::vector<std::size_t> spendBudgetWithin(const std::vector<CurvePoints>& curves,
                                                         std::uint32_t budget, double widest_gap);

/// As spendBudget, but makes the widest gap of all curves as narrow as is possible for at most a
/// tenth more error.
[[nodiscard]] std::vector<std::size_t> spendBudgetEvenly(const std::vector<CurvePoints>& curves,
                                                         std::uint32_t budget);

/// What the spheres of all groups are made from.
struct SphereTask {
  const SourceRobot& robot;
  /// May be null.
  const RobotRecipe* recipe = nullptr;
  const RobotBakeOptions& options;
  /// The surfaces that spheres are fitted to, one per link.
  const std::vector<Surface>& surfaces;
  /// Pose of each link at the start positions, with the root at its height above the ground.
  const std::vector<Pose>& world_from_link;
  unsigned threads = 1;
};

/// The spheres of each group: made by hand, or fitted within the robot's budget. Adds what the user
/// should know to `warnings`.
[[nodiscard]] Result<std::vector<BakedGroup>> makeGroupSpheres(
    const std::vector<RigidGroup>& groups, const SphereTask& task,
    std::vector<std::string>& warnings);

}  // namespace galactic::bake
