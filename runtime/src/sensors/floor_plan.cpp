#include "sensors/floor_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "simulation/phases/move.h"

namespace galactic::sensors {
namespace {

using simulation::kLanes;

constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<PlanCell, 4> kAround{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
/// Cells about a start in which its floor is looked for.
constexpr std::int32_t kStartReach = 3;
/// Places in a cell where the robot is tried, in cells from the middle: it passes between things
/// that are no cell further apart than it is wide.
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
/// Two floors at one place are further apart, meters.
constexpr float kStorey = 0.5F;

/// Lanes as the kernels of the motion want them.
struct alignas(32) Lanes {
  std::array<float, kLanes> values{};
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
    variables[v].values.fill(variable.wraps ? std::remainder(start, 2 * std::numbers::pi_v<float>)
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

FloorPlan::FloorPlan(const Scene& scene, const StandingRobot& robot, const Vec3& start,
                     const GroundOptions& ground) {
  const ColumnGrid& grid = scene.grids().front();
  const auto cells = [](std::uint32_t columns, float spacing) {
    return static_cast<std::int32_t>(std::ceil(static_cast<float>(columns) * spacing / kPlanCell));
  };
  columns_x_ = cells(grid.columnsX(), grid.spacing());
  columns_z_ = cells(grid.columnsZ(), grid.spacing());
  min_x_ = grid.layout().min_x;
  min_z_ = grid.layout().min_z;
  heights_.assign(static_cast<std::size_t>(columns_x_) * static_cast<std::size_t>(columns_z_),
                  kNowhere);
  // What can be driven both ways.
  GroundOptions step = ground;
  step.most_rise = step.most_drop = std::min(ground.most_rise, ground.most_drop);
  std::vector<std::uint8_t> is_tried(heights_.size());
  std::vector<PlanCell> open;
  StandingRobot::Scratch scratch = robot.scratch();
  const auto visit = [&](const PlanCell& cell, float from_height) {
    if (!isInside(cell) || is_tried[indexOf(cell)] != 0) return;
    const Vec3 at = middle(cell);
    for (const auto& [x, z] : kPlaces) {
      Vec3 base{at.x + x * kPlanCell, from_height, at.z + z * kPlanCell};
      const simulation::FloorUnder under = simulation::floorUnder(scene, base, step);
      // Another neighbor may lie higher or lower.
      if (under.floor != simulation::Floor::kCarries) continue;
      is_tried[indexOf(cell)] = 1;
      base.y = under.height;
      if (!robot.isFree(scene, base, scratch)) continue;
      heights_[indexOf(cell)] = under.height;
      open.push_back(cell);
      return;
    }
  };
  // From the start's cell, or where the robot can only stand aside of it from the one next to it.
  const PlanCell first = cellAt(start.x, start.z);
  for (std::int32_t reach = 0; reach <= kStartReach && open.empty(); ++reach) {
    for (std::int32_t k = -reach; k <= reach && open.empty(); ++k) {
      for (std::int32_t i = -reach; i <= reach && open.empty(); ++i) {
        visit({first.i + i, first.k + k}, start.y);
      }
    }
  }
  for (std::size_t n = 0; n < open.size(); ++n) {
    const PlanCell cell = open[n];
    const float height = heights_[indexOf(cell)];
    for (const PlanCell& way : kAround) visit({cell.i + way.i, cell.k + way.k}, height);
  }
}

PlanCell FloorPlan::cellAt(float x, float z) const {
  return {static_cast<std::int32_t>(std::floor((x - min_x_) / kPlanCell)),
          static_cast<std::int32_t>(std::floor((z - min_z_) / kPlanCell))};
}

Vec3 FloorPlan::middle(const PlanCell& cell) const {
  const float height = isInside(cell) ? heights_[indexOf(cell)] : kNowhere;
  return {min_x_ + (static_cast<float>(cell.i) + 0.5F) * kPlanCell, height,
          min_z_ + (static_cast<float>(cell.k) + 0.5F) * kPlanCell};
}

bool FloorPlan::isPassable(const PlanCell& cell) const {
  return isInside(cell) && !std::isnan(heights_[indexOf(cell)]);
}

bool FloorPlan::covers(const Vec3& base) const {
  const PlanCell at = cellAt(base.x, base.z);
  for (std::int32_t k = -1; k <= 1; ++k) {
    for (std::int32_t i = -1; i <= 1; ++i) {
      const PlanCell cell{at.i + i, at.k + k};
      if (isPassable(cell) && std::fabs(middle(cell).y - base.y) < kStorey) return true;
    }
  }
  return false;
}

}  // namespace galactic::sensors
