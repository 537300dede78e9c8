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

/// The sets of one curve, by rising count.
using CurvePoints = std::vector<CurvePoint>;

/// Which set of each curve to take, so that all together have at most `budget` spheres (0: no
/// limit, the finest sets) and the sum of their errors is least; exact, by
/// dynamic programming over the number of spheres (a multiple-choice knapsack). Of equally good
/// ways the one with the coarser last curves is taken. Where even the coarsest sets have more than
/// the budget, those are taken. Curves may be empty; the sets of one rise in count. Deterministic;
/// work grows with budget times sets.
[[nodiscard]] std::vector<std::size_t> spendBudget(const std::vector<CurvePoints>& curves,
                                                   std::uint32_t budget);

/// The same among the sets without gaps wider than `widest_gap`, meters; of a curve that has none
/// of them, its finest set. The budget gives way where these alone have more spheres.
[[nodiscard]] std::vector<std::size_t> spendBudgetWithin(const std::vector<CurvePoints>& curves,
                                                         std::uint32_t budget, double widest_gap);

/// As spendBudget, but with the widest gap of all curves as narrow as costs no more than a tenth of
/// the error.
[[nodiscard]] std::vector<std::size_t> spendBudgetEvenly(const std::vector<CurvePoints>& curves,
                                                         std::uint32_t budget);

/// What the spheres of all groups are made from.
struct SphereTask {
  const SourceRobot& robot;
  /// May be null.
  const RobotRecipe* recipe = nullptr;
  const RobotBakeOptions& options;
  /// What spheres are fitted to, one per link.
  const std::vector<Surface>& surfaces;
  /// Pose of each link at the start positions; the root stands at its height above the ground.
  const std::vector<Pose>& world_from_link;
  unsigned threads = 1;
};

/// The spheres of each group: given by hand, or fitted within the robot's budget. Adds what the
/// user should know to `warnings`.
[[nodiscard]] Result<std::vector<BakedGroup>> makeGroupSpheres(
    const std::vector<RigidGroup>& groups, const SphereTask& task,
    std::vector<std::string>& warnings);

}  // namespace galactic::bake
