#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/robot.h"
#include "galactic/scene.h"
#include "galactic/simulation_options.h"
#include "simulation/motion/motion_kernels.h"

namespace galactic::sensors {

/// Edge of a cell of a floor plan, meters.
inline constexpr float kPlanCell = 0.1F;

/// The robot in its start pose, to be tried in many places.
class StandingRobot {
 public:
  /// Headings in which it is tried, evenly spread.
  static constexpr std::size_t kHeadings = simulation::kLanes;

  StandingRobot(const Robot& robot, const simulation::MotionModel& motion,
                const simulation::MotionKernels& kernels);

  /// Room for the centers of one heading.
  struct Scratch {
    std::vector<float> x, y, z;
  };
  [[nodiscard]] Scratch scratch() const;

  /// Whether it is free of the static scene in any heading, with its base at `base`.
  [[nodiscard]] bool isFree(const Scene& scene, const Vec3& base, Scratch& scratch) const;

 private:
  std::vector<simulation::RadiusRange> ranges_;
  std::size_t spheres_ = 0;
  /// Centers around a base at the origin: heading by heading, x, y and z of all spheres.
  std::vector<float> centers_;
};

/// Index of a cell of a plan.
struct PlanCell {
  std::int32_t i = 0;
  std::int32_t k = 0;
};

/// Where a robot stands on a floor.
struct FloorSeed {
  PlanCell cell;
  /// Of the floor, meters.
  float height = 0;
};

/// The floor that a robot can drive over from where it starts: cells over the whole scene, one
/// floor to a cell. A cell belongs to it when the robot's start pose is free in some heading with
/// the base in its middle or a third of a cell beside, and when the floor there is within a step
/// (the lesser of GroundOptions) of a neighbor's along an axis, from the start on. Where ways cross
/// above each other, the one that is met first counts. Immutable.
class FloorPlan {
 public:
  /// Without cells: of a robot that can stand nowhere.
  FloorPlan() = default;
  FloorPlan(const Scene& scene, const StandingRobot& robot, const FloorSeed& seed,
            const GroundOptions& ground);

  /// The cell of a point in all plans of a scene.
  [[nodiscard]] static PlanCell cellOf(const Scene& scene, const Vec3& point);
  /// From where the floor of a start spreads: its cell or, where the robot can only stand aside of
  /// it, one next to it. None where there is none.
  [[nodiscard]] static std::optional<FloorSeed> seedOf(const Scene& scene,
                                                       const StandingRobot& robot,
                                                       const Vec3& start,
                                                       const GroundOptions& ground);

  [[nodiscard]] std::int32_t columnsX() const { return columns_x_; }
  [[nodiscard]] std::int32_t columnsZ() const { return columns_z_; }
  [[nodiscard]] std::size_t cellCount() const { return heights_.size(); }
  /// Corner of cell (0, 0), world frame, meters.
  [[nodiscard]] float minX() const { return min_x_; }
  [[nodiscard]] float minZ() const { return min_z_; }

  [[nodiscard]] bool isInside(const PlanCell& cell) const {
    return cell.i >= 0 && cell.k >= 0 && cell.i < columns_x_ && cell.k < columns_z_;
  }
  /// Of a cell inside.
  [[nodiscard]] std::size_t indexOf(const PlanCell& cell) const {
    return static_cast<std::size_t>(cell.k) * static_cast<std::size_t>(columns_x_) +
           static_cast<std::size_t>(cell.i);
  }
  [[nodiscard]] PlanCell cellAt(float x, float z) const;
  /// The middle of a cell on its floor; of a passable one.
  [[nodiscard]] Vec3 middle(const PlanCell& cell) const;
  /// False outside.
  [[nodiscard]] bool isPassable(const PlanCell& cell) const;
  /// Whether both are passable, and their floors further apart than so many steps.
  [[nodiscard]] bool areApart(const PlanCell& a, const PlanCell& b, int steps = 1) const;
  /// Whether both are passable, and a step leads from one to the other.
  [[nodiscard]] bool areConnected(const PlanCell& a, const PlanCell& b) const {
    return isPassable(a) && isPassable(b) && !areApart(a, b);
  }
  /// Whether it is passable, and its floor no storey above or below a height.
  [[nodiscard]] bool isOnStorey(const PlanCell& cell, float height) const;
  /// Of the floor in each cell, meters, X first; NaN where the robot cannot go.
  [[nodiscard]] std::span<const float> heights() const { return heights_; }
  /// Whether a base at `base` is on this plan's floor, or beside it by so many cells at most.
  [[nodiscard]] bool covers(const Vec3& base, std::int32_t beside = 1) const;
  /// Whether the seed is on this plan's floor.
  [[nodiscard]] bool has(const FloorSeed& seed) const;

 private:
  /// The frame of the cells, and no heights yet.
  explicit FloorPlan(const Scene& scene);
  [[nodiscard]] Vec3 middleAt(const PlanCell& cell, float height) const;

  std::int32_t columns_x_ = 0;
  std::int32_t columns_z_ = 0;
  float min_x_ = 0;
  float min_z_ = 0;
  /// The lesser of GroundOptions, meters.
  float step_ = 0;
  /// Of the floor, meters; NaN where the robot cannot go.
  std::vector<float> heights_;
};

}  // namespace galactic::sensors
