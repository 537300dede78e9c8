#include "sensors/floor_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "simulation/collision/floor_query.h"

namespace galactic::sensors {
namespace {

using simulation::kLanes;

constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<PlanCell, 4> kAround{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
/// The floor of a start is looked for in up to this many cells around it.
constexpr std::int32_t kStartReach = 3;
/// Places in a cell where the robot is tried, in cells from the middle. Because of them, a gap need
/// not be a whole cell wider than the robot to let it pass.
constexpr float kAside = 1.0F / 3;
constexpr std::array<std::array<float, 2>, 9> kPlaces{{{0, 0},
                                                       {kAside, 0},
                                                       {-kAside, 0},
                                                       {0, kAside},
                                                       {0, -kAside},
                                                       {kAside, kAside},
                                                       {-kAside, kAside},
                                                       {kAside, -kAside},
                                                       {-kAside, -kAside}}};
/// Two floors above each other are at least this far apart, meters.
constexpr float kStorey = 0.5F;

/// Aligned as the kernels of the motion require.
struct alignas(32) Lanes {
  std::array<float, kLanes> values{};
};

/// Tries whether the robot can stand in a cell, and at what height.
class Stander {
 public:
  Stander(const Scene& scene, const StandingRobot& robot, const GroundOptions& ground)
      : scene_(scene), robot_(robot), step_(ground) {
    // Only steps that the robot can drive both up and down count.
    step_.most_rise = step_.most_drop = std::min(ground.most_rise, ground.most_drop);
  }

  struct Answer {
    /// Whether there is a floor within a step of the one that the robot comes from.
    bool has_floor = false;
    /// Height of the floor on which the robot can stand, meters.
    std::optional<float> height;
  };
  /// Tries the cell with this middle; the robot comes from a floor at `from_height`.
  [[nodiscard]] Answer tryAt(const Vec3& middle, float from_height,
                             StandingRobot::Scratch& scratch) const {
    Answer answer;
    for (const auto& [x, z] : kPlaces) {
      Vec3 base{middle.x + x * kPlanCell, from_height, middle.z + z * kPlanCell};
      const simulation::FloorUnder under = simulation::floorUnder(scene_, base, step_);
      if (under.floor != simulation::Floor::kCarries) continue;
      answer.has_floor = true;
      base.y = under.height;
      if (!robot_.isFree(scene_, base, scratch)) continue;
      answer.height = under.height;
      break;
    }
    return answer;
  }

 private:
  const Scene& scene_;
  const StandingRobot& robot_;
  GroundOptions step_;
};

}  // namespace

StandingRobot::StandingRobot(const Robot& robot, const simulation::MotionModel& motion,
                             const simulation::MotionKernels& kernels)
    : ranges_(motion.ranges), spheres_(motion.spheres.size()), centers_(3 * kLanes * spheres_) {
  static_assert(kHeadings == kLanes);
  Lanes zero;
  Lanes yaw;
  for (std::size_t n = 0; n < kLanes; ++n) {
    // In [-pi, pi).
    yaw.values[n] =
        std::numbers::pi_v<float> * (2 * static_cast<float>(n) / static_cast<float>(kLanes) - 1);
  }
  std::vector<Lanes> variables(motion.variables.size());
  for (std::size_t v = 0; v < variables.size(); ++v) {
    const simulation::MotionVariable& variable = motion.variables[v];
    const float start = robot.startPositions()[variable.position];
    variables[v].values.fill(variable.wraps ? wrappedAngle(start)
                                            : std::clamp(start, variable.lower, variable.upper));
  }
  std::vector<simulation::EnvRow> grips(simulation::kGripNumbers);
  std::vector<simulation::EnvRow> frames(simulation::frameRows(motion.nodes.size()));
  Lanes x;
  Lanes z;
  kernels.place(simulation::motionTables(motion),
                {.pose = {.x = x.values.data(),
                          .y = zero.values.data(),
                          .z = z.values.data(),
                          .yaw = yaw.values.data(),
                          .variables = variables.empty() ? nullptr : variables[0].values.data(),
                          .stride = kLanes},
                 .body = {.frames = frames.front().values,
                          .centers = centers_.data(),
                          .grips = grips.front().values}});
}

StandingRobot::Scratch StandingRobot::scratch() const {
  return {std::vector<float>(spheres_), std::vector<float>(spheres_), std::vector<float>(spheres_)};
}

bool StandingRobot::isFree(const Scene& scene, const Vec3& base, Scratch& scratch) const {
  for (std::size_t heading = 0; heading < kHeadings; ++heading) {
    const float* from = centers_.data() + 3 * heading * spheres_;
    for (std::size_t n = 0; n < spheres_; ++n) {
      scratch.x[n] = from[n] + base.x;
      scratch.y[n] = from[spheres_ + n] + base.y;
      scratch.z[n] = from[2 * spheres_ + n] + base.z;
    }
    const bool is_free = std::ranges::all_of(ranges_, [&](const simulation::RadiusRange& range) {
      const SphereCenters centers{std::span(scratch.x).subspan(range.first, range.count),
                                  std::span(scratch.y).subspan(range.first, range.count),
                                  std::span(scratch.z).subspan(range.first, range.count)};
      return scene.grids()[range.radius_index].firstNotFree(centers) == range.count;
    });
    if (is_free) return true;
  }
  return false;
}

FloorPlan::FloorPlan(const Scene& scene) {
  const ColumnGrid& grid = scene.grids().front();
  const auto cells = [](std::uint32_t columns, float spacing) {
    return static_cast<std::int32_t>(std::ceil(static_cast<float>(columns) * spacing / kPlanCell));
  };
  columns_x_ = cells(grid.columnsX(), grid.spacing());
  columns_z_ = cells(grid.columnsZ(), grid.spacing());
  min_x_ = grid.layout().min_x;
  min_z_ = grid.layout().min_z;
}

FloorPlan::FloorPlan(const Scene& scene, const StandingRobot& robot, const FloorSeed& seed,
                     const GroundOptions& ground)
    : FloorPlan(scene) {
  step_ = std::min(ground.most_rise, ground.most_drop);
  heights_.assign(static_cast<std::size_t>(columns_x_) * static_cast<std::size_t>(columns_z_),
                  kNowhere);
  const Stander stander(scene, robot, ground);
  std::vector<std::uint8_t> is_tried(heights_.size());
  std::vector<PlanCell> open{seed.cell};
  heights_[indexOf(seed.cell)] = seed.height;
  is_tried[indexOf(seed.cell)] = 1;
  StandingRobot::Scratch scratch = robot.scratch();
  for (std::size_t n = 0; n < open.size(); ++n) {
    const PlanCell cell = open[n];
    const float height = heights_[indexOf(cell)];
    for (const PlanCell& way : kAround) {
      const PlanCell next{cell.i + way.i, cell.k + way.k};
      if (!isInside(next) || is_tried[indexOf(next)] != 0) continue;
      const Stander::Answer answer = stander.tryAt(middle(next), height, scratch);
      // The cell may still be reached from another neighbor, which is higher or lower.
      if (!answer.has_floor) continue;
      is_tried[indexOf(next)] = 1;
      if (!answer.height) continue;
      heights_[indexOf(next)] = *answer.height;
      open.push_back(next);
    }
  }
}

PlanCell FloorPlan::cellOf(const Scene& scene, const Vec3& point) {
  return FloorPlan(scene).cellAt(point.x, point.z);
}

std::optional<FloorSeed> FloorPlan::seedOf(const Scene& scene, const StandingRobot& robot,
                                           const Vec3& start, const GroundOptions& ground) {
  const FloorPlan plan(scene);
  const Stander stander(scene, robot, ground);
  StandingRobot::Scratch scratch = robot.scratch();
  const PlanCell first = plan.cellAt(start.x, start.z);
  for (std::int32_t reach = 0; reach <= kStartReach; ++reach) {
    for (std::int32_t k = -reach; k <= reach; ++k) {
      for (std::int32_t i = -reach; i <= reach; ++i) {
        const PlanCell cell{first.i + i, first.k + k};
        // Nearer cells have already been tried.
        const bool is_new = std::max(std::abs(i), std::abs(k)) == reach;
        if (!is_new || !plan.isInside(cell)) continue;
        const Stander::Answer answer =
            stander.tryAt(plan.middleAt(cell, start.y), start.y, scratch);
        if (answer.height) return FloorSeed{cell, *answer.height};
      }
    }
  }
  return std::nullopt;
}

PlanCell FloorPlan::cellAt(float x, float z) const {
  return {static_cast<std::int32_t>(std::floor((x - min_x_) / kPlanCell)),
          static_cast<std::int32_t>(std::floor((z - min_z_) / kPlanCell))};
}

Vec3 FloorPlan::middleAt(const PlanCell& cell, float height) const {
  return {min_x_ + (static_cast<float>(cell.i) + 0.5F) * kPlanCell, height,
          min_z_ + (static_cast<float>(cell.k) + 0.5F) * kPlanCell};
}

Vec3 FloorPlan::middle(const PlanCell& cell) const {
  return middleAt(cell, isInside(cell) ? heights_[indexOf(cell)] : kNowhere);
}

bool FloorPlan::isPassable(const PlanCell& cell) const {
  return isInside(cell) && !std::isnan(heights_[indexOf(cell)]);
}

bool FloorPlan::areApart(const PlanCell& a, const PlanCell& b, int steps) const {
  constexpr float kRounding = 1e-3F;
  return isPassable(a) && isPassable(b) &&
         std::fabs(heights_[indexOf(a)] - heights_[indexOf(b)]) >
             static_cast<float>(steps) * (step_ + kRounding);
}

bool FloorPlan::isOnStorey(const PlanCell& cell, float height) const {
  return isPassable(cell) && std::fabs(middle(cell).y - height) < kStorey;
}

bool FloorPlan::has(const FloorSeed& seed) const { return isOnStorey(seed.cell, seed.height); }

bool FloorPlan::covers(const Vec3& base, std::int32_t beside) const {
  const PlanCell at = cellAt(base.x, base.z);
  if (isOnStorey(at, base.y)) return true;
  for (std::int32_t k = -beside; k <= beside; ++k) {
    for (std::int32_t i = -beside; i <= beside; ++i) {
      if (isOnStorey({at.i + i, at.k + k}, base.y)) return true;
    }
  }
  return false;
}

}  // namespace galactic::sensors
