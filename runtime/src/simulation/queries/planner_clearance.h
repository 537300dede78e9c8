#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "column_grid/grid_distance.h"
#include "galactic/planning_scene.h"
#include "galactic/pose.h"
#include "galactic/world.h"
#include "simulation/queries/planner_env.h"

namespace galactic::simulation {

/// The distance fields of all grids of a world, made for each scene when first asked for. Safe to
/// share between threads.
class WorldDistances {
 public:
  explicit WorldDistances(const World& world);

  /// One per radius of the working set.
  [[nodiscard]] const std::vector<detail::GridDistance>& of(const Scene& scene);

 private:
  struct OfScene {
    std::once_flag once;
    std::vector<detail::GridDistance> grids;
  };
  World world_;
  std::vector<OfScene> scenes_;
};

/// How far a robot's spheres, and those of its held object, are from their surroundings; see
/// PlanningScene::clearances(). Copies share the distances of the scenes.
class PlannerClearance {
 public:
  explicit PlannerClearance(const World& world);

  [[nodiscard]] std::size_t sphereCount(const PlannerEnv& env) const;

  /// Measures the clearances of all spheres of the robot with its assembled joints; valid until the
  /// next call. `base`: finite.
  std::span<const SphereClearance> measure(PlannerEnv& env, const BasePlace& base, float most);

  /// Writes how the last measured clearances change with the base and the joints. `gradients`: of
  /// this one pose.
  void derive(const PlannerEnv& env, const RobotPose& pose,
              const ClearanceGradients& gradients) const;

 private:
  /// Finds the resting objects that may be within `most` of a sphere when the base is there.
  void findNear(const PlannerEnv& env, const BasePlace& base, float most);

  std::shared_ptr<WorldDistances> distances_;
  /// For each sphere of the robot the link that carries it, and whether it keeps its height because
  /// no controlled joint moves it.
  std::vector<std::uint32_t> links_;
  std::vector<bool> keeps_height_;

  // Results of the last measure().
  std::vector<SphereClearance> clearances_;
  /// World frame.
  std::vector<Vec3> centers_;
  /// Indices of objects, ascending.
  std::vector<std::uint32_t> near_;
};

}  // namespace galactic::simulation
