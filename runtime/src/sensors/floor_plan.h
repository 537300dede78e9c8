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

/// Edge of the cells of a floor plan, meters.
inline constexpr float kPlanCell = 0.1F;

/// The robot in its start pose, for trying it in many places.
class StandingRobot {
 public:
  /// The robot is tried in this many evenly spaced headings.
  static constexpr std::size_t kHeadings = simulation::kLanes;

  StandingRobot(const Robot& robot, const simulation::MotionModel& motion,
                const simulation::MotionKernels& kernels);

  /// Room for the sphere centers of one heading.
  struct Scratch {
    std::vector<float> x, y, z;
  };
  [[nodiscard]] Scratch scratch() const;

  /// Whether the robot, with its base at `base`, is free of the static scene in at least one
  /// heading.
  [[nodiscard]] bool isFree(const Scene& scene, const Vec3& base, Scratch& scratch) const;

 private:
  std::vector<simulation::RadiusRange> ranges_;
  std::size_t spheres_ = 0;
  /// Sphere centers for a base at the origin: heading by heading, x, y and z of all spheres.
  std::vector<float> centers_;
};

/// Index of a plan's cell.
struct PlanCell {
  std::int32_t i = 0;
  std::int32_t k = 0;
};

/// A cell in which a robot stands on a floor.
struct FloorSeed {
  PlanCell cell;
  /// Height of the floor, meters.
  float height = 0;
};

/// The floor that a robot can drive over from where it starts: cells over the whole scene, with one
/// floor per cell. A cell belongs to it if the robot's start pose is free in some heading with the
/// base in the middle of the cell or a third of a cell beside it, and if the floor there is within
/// a step (the smaller number of GroundOptions) of the floor of a neighbor along an axis that
/// belongs to it; it spreads from the start. If paths cross above each other, the cell gets the
/// floor that is reached first. Immutable.
class FloorPlan {
 public:
  /// A plan without cells, for a robot that can stand nowhere.
  FloorPlan() = default;
  FloorPlan(const Scene& scene, const StandingRobot& robot, const FloorSeed& seed,
            const GroundOptions& ground);

  /// The cell of a point; it is the same in all plans of a scene.
  [[nodiscard]] static PlanCell cellOf(const Scene& scene, const Vec3& point);
  /// The cell from which the floor of a start spreads: the start's own or, if the robot cannot
  /// stand there, a cell near it. Nullopt if there is none.
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
  /// `cell` must be inside the plan.
  [[nodiscard]] std::size_t indexOf(const PlanCell& cell) const {
    return static_cast<std::size_t>(cell.k) * static_cast<std::size_t>(columns_x_) +
           static_cast<std::size_t>(cell.i);
  }
  [[nodiscard]] PlanCell cellAt(float x, float z) const;
  /// The middle of a cell, on its floor. `cell` must be passable.
  [[nodiscard]] Vec3 middle(const PlanCell& cell) const;
  /// Whether the robot can stand in the cell; false outside the plan.
  [[nodiscard]] bool isPassable(const PlanCell& cell) const;
  /// Whether both cells are passable and their floors are more than `steps` steps apart.
  [[nodiscard]] bool areApart(const PlanCell& a, const PlanCell& b, int steps = 1) const;
  /// Whether both cells are passable and their floors are at most one step apart.
  [[nodiscard]] bool areConnected(const PlanCell& a, const PlanCell& b) const {
    return isPassable(a) && isPassable(b) && !areApart(a, b);
  }
  /// Whether the cell is passable and its floor is on the storey of `height`.
  [[nodiscard]] bool isOnStorey(const PlanCell& cell, float height) const;
  /// Height of the floor in each cell, meters, in the order of indexOf(); NaN where the robot
  /// cannot go.
  [[nodiscard]] std::span<const float> heights() const { return heights_; }
  /// Whether a base at `base` is on this plan's floor, or at most `beside` cells beside it.
  [[nodiscard]] bool covers(const Vec3& base, std::int32_t beside = 1) const;
  /// Whether the seed is on this plan's floor.
  [[nodiscard]] bool has(const FloorSeed& seed) const;

 private:
  /// Sets the frame of the cells, but no heights yet.
  explicit FloorPlan(const Scene& scene);
  [[nodiscard]] Vec3 middleAt(const PlanCell& cell, float height) const;

  std::int32_t columns_x_ = 0;
  std::int32_t columns_z_ = 0;
  float min_x_ = 0;
  float min_z_ = 0;
  /// The smaller number of GroundOptions, meters.
  float step_ = 0;
  /// Height of the floor, meters; NaN where the robot cannot go.
  std::vector<float> heights_;
};

}  // namespace galactic::sensors
