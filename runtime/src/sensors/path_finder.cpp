#include "galactic/path_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "galactic/option_text.h"
#include "sensors/floor_plan.h"
#include "sensors/way_field.h"
#include "simulation/collision/floor_query.h"
#include "simulation/motion/motion_model.h"
#include "support/call_check.h"
#include "support/threads/workers.h"
#include "support/try.h"

namespace galactic {
namespace {

using sensors::FloorPlan;
using sensors::kBeside;
using sensors::kNoWay;
using sensors::kPlanCell;
using sensors::PlanCell;

/// The longest path that a field can store, meters.
constexpr float kFarthest = (kNoWay - 1) * sensors::kWayUnit;
constexpr std::array<PlanCell, 8> kNeighbors{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

/// Whether a point can have a cell: its numbers must be finite, and smaller than 1000 km.
bool isPlace(const Vec3& point) {
  constexpr float kMost = 1e6F;
  const float farthest = std::max({std::fabs(point.x), std::fabs(point.y), std::fabs(point.z)});
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z) &&
         farthest < kMost;
}

float squaredDistance(const Vec3& a, const Vec3& b) {
  const Vec3 apart = a - b;
  return dot(apart, apart);
}

/// Whether a base is at the end of its path. So near to the goal, interpolation between the middles
/// of cells gives no direction and too long a path.
bool isAtEnd(float distance, const Vec3& base, const Vec3& goal) {
  constexpr float kThere = 1e-4F;
  // A hand's goal may be right above a base that still has to go around something to reach it.
  constexpr float kNear = 2 * kPlanCell;
  const float x = goal.x - base.x;
  const float z = goal.z - base.z;
  return distance < kNear && x * x + z * z < kThere * kThere;
}

/// The passable cell nearest to a base, among those within kBeside cells and on its storey.
std::optional<PlanCell> cellBeside(const FloorPlan& plan, const Vec3& base) {
  if (!isPlace(base)) return std::nullopt;
  const PlanCell at = plan.cellAt(base.x, base.z);
  std::optional<PlanCell> nearest;
  float least = std::numeric_limits<float>::infinity();
  for (std::int32_t k = at.k - kBeside; k <= at.k + kBeside; ++k) {
    for (std::int32_t i = at.i - kBeside; i <= at.i + kBeside; ++i) {
      const PlanCell cell{i, k};
      if (!plan.isOnStorey(cell, base.y)) continue;
      const float squared = squaredDistance(plan.middle(cell), base);
      if (squared < least) {
        least = squared;
        nearest = cell;
      }
    }
  }
  return nearest;
}

/// Whether a straight line in the ground plane stays on passable cells whose floors are at most a
/// step apart.
bool isOpen(const FloorPlan& plan, const Vec3& a, const Vec3& b) {
  constexpr float kStride = 0.02F;
  const float x = b.x - a.x;
  const float z = b.z - a.z;
  const int steps = static_cast<int>(std::sqrt(x * x + z * z) / kStride) + 1;
  PlanCell before = plan.cellAt(a.x, a.z);
  for (int n = 0; n <= steps; ++n) {
    const float share = static_cast<float>(n) / static_cast<float>(steps);
    const PlanCell cell = plan.cellAt(a.x + share * x, a.z + share * z);
    if (!plan.areConnected(before, cell)) return false;
    before = cell;
  }
  return true;
}

/// The passable cell around `cell` with the shortest path, if that is shorter than the path of
/// `cell`. Diagonal steps must not cut corners.
std::optional<PlanCell> nextCell(const FloorPlan& plan, std::span<const std::uint16_t> lengths,
                                 const PlanCell& cell) {
  std::optional<PlanCell> next;
  std::uint16_t least = lengths[plan.indexOf(cell)];
  for (const PlanCell& way : kNeighbors) {
    const PlanCell there{cell.i + way.i, cell.k + way.k};
    const PlanCell along_x{there.i, cell.k};
    const PlanCell along_z{cell.i, there.k};
    const bool is_connected = plan.areConnected(cell, along_x) &&
                              plan.areConnected(along_x, there) &&
                              plan.areConnected(cell, along_z) && plan.areConnected(along_z, there);
    if (!is_connected || lengths[plan.indexOf(there)] >= least) continue;
    least = lengths[plan.indexOf(there)];
    next = there;
  }
  return next;
}

/// Height of the floor at a start or below it, found in the same way as for episodes.
float floorBelow(const Scene& scene, const Vec3& start, const GroundOptions& ground) {
  const simulation::FloorUnder under = simulation::floorUnderStart(scene, start, ground);
  return under.floor == simulation::Floor::kDrops ? start.y : under.height;
}

/// The corners of the path that remain when straight lines over passable cells replace the points
/// between them.
std::vector<Vec3> pulledTight(const FloorPlan& plan, const std::vector<Vec3>& points) {
  std::vector<Vec3> corners{points.front()};
  for (std::size_t n = 1; n + 1 < points.size(); ++n) {
    if (!isOpen(plan, corners.back(), points[n + 1])) corners.push_back(points[n]);
  }
  if (points.size() > 1) corners.push_back(points.back());
  return corners;
}

}  // namespace

GeodesicWay GeodesicFields::way(std::size_t n, const Vec3& base) const {
  detail::checkIndex("GeodesicFields::way", "goal", n, goals_.size());
  if (!cellBeside(*plan_, base)) return {};
  const sensors::Way way = sensors::wayFrom(*plan_, lengths_[n], base.x, base.z);
  if (way.distance < 0 || way.distance >= kFarthest) return {};
  if (isAtEnd(way.distance, base, goals_[n])) return {.distance = 0};
  return {way.distance, way.x, way.z};
}

std::vector<Vec3> GeodesicFields::path(std::size_t n, const Vec3& base) const {
  detail::checkIndex("GeodesicFields::path", "goal", n, goals_.size());
  const std::span<const std::uint16_t> lengths = lengths_[n];
  std::optional<PlanCell> cell = cellBeside(*plan_, base);
  // Beyond the longest length that the field can store, it has no directions.
  if (!cell || lengths[plan_->indexOf(*cell)] >= kNoWay - 1) return {};
  std::vector<Vec3> points{base};
  // If the base is beside the floor, the path begins with a step onto it.
  if (!plan_->isPassable(plan_->cellAt(base.x, base.z))) points.push_back(plan_->middle(*cell));
  while ((cell = nextCell(*plan_, lengths, *cell))) points.push_back(plan_->middle(*cell));
  if (are_places_) points.push_back(goals_[n]);
  return pulledTight(*plan_, points);
}

Result<PathFinder> PathFinder::create(const World& world, std::uint32_t scene, const Vec3& start,
                                      const GroundOptions& ground) {
  SimulationOptions options;
  options.ground = ground;
  RETURN_IF_ERROR(checkOptions(options));
  const std::size_t count = world.scenes().size();
  if (scene >= count) {
    return fail(ErrorCode::kInvalidInput, "path finder",
                fmt::format("there is no scene {}, the last is {}", scene, count - 1));
  }
  ASSIGN_OR_RETURN(const simulation::MotionModel motion,
                   simulation::makeMotionModel(world.robot(), world.startPositionIndices()));
  const sensors::StandingRobot robot(world.robot(), motion, simulation::motionKernels());
  const Scene& home = world.scenes()[scene];
  std::optional<sensors::FloorSeed> seed;
  if (isPlace(start)) {
    seed =
        FloorPlan::seedOf(home, robot, {start.x, floorBelow(home, start, ground), start.z}, ground);
  }
  if (!seed) {
    return fail(
        ErrorCode::kInvalidInput, "path finder",
        fmt::format("the robot cannot stand at or near ({:.2f}, {:.2f}, {:.2f}) in scene {}; "
                    "start where it can",
                    start.x, start.y, start.z, home.name()));
  }
  return PathFinder(world, scene, std::make_shared<const FloorPlan>(home, robot, *seed, ground));
}

float PathFinder::cellSize() { return kPlanCell; }
std::int32_t PathFinder::columnsX() const { return plan_->columnsX(); }
std::int32_t PathFinder::columnsZ() const { return plan_->columnsZ(); }
float PathFinder::minX() const { return plan_->minX(); }
float PathFinder::minZ() const { return plan_->minZ(); }
std::span<const float> PathFinder::heights() const { return plan_->heights(); }

bool PathFinder::isNavigable(const Vec3& base) const {
  return isPlace(base) && plan_->isOnStorey(plan_->cellAt(base.x, base.z), base.y);
}

Vec3 PathFinder::snap(const Vec3& point) const {
  if (!isPlace(point)) {
    detail::refuseCall("PathFinder::snap",
                       fmt::format("found ({:g}, {:g}, {:g}), which is no point of a scene; take "
                                   "one within 1000 km",
                                   point.x, point.y, point.z));
  }
  Vec3 nearest{};
  float least = std::numeric_limits<float>::infinity();
  for (std::int32_t k = 0; k < columnsZ(); ++k) {
    for (std::int32_t i = 0; i < columnsX(); ++i) {
      if (!plan_->isPassable({i, k})) continue;
      const Vec3 place = plan_->middle({i, k});
      const float squared = squaredDistance(place, point);
      if (squared >= least) continue;
      least = squared;
      nearest = place;
    }
  }
  return nearest;
}

std::vector<Vec3> PathFinder::places() const {
  std::vector<Vec3> places;
  for (std::int32_t k = 0; k < columnsZ(); ++k) {
    for (std::int32_t i = 0; i < columnsX(); ++i) {
      if (plan_->isPassable({i, k})) places.push_back(plan_->middle({i, k}));
    }
  }
  return places;
}

Result<GeodesicFields> PathFinder::fieldsTo(std::span<const Vec3> goals, GoalOf of,
                                            std::uint32_t threads) const {
  GeodesicFields fields;
  fields.plan_ = plan_;
  fields.goals_.assign(goals.begin(), goals.end());
  fields.are_places_ = of == GoalOf::kBase;
  fields.lengths_.resize(goals.size());
  for (std::size_t n = 0; n < goals.size(); ++n) {
    if (fields.are_places_ ? isNavigable(goals[n]) : isPlace(goals[n])) continue;
    return fail(ErrorCode::kInvalidInput, "path finder",
                fmt::format("goal {}, ({:.2f}, {:.2f}, {:.2f}), is {}", n, goals[n].x, goals[n].y,
                            goals[n].z,
                            fields.are_places_ ? "not navigable; take what snap() makes of it"
                                               : "no point of a scene; take one within 1000 km"));
  }
  detail::forEachPart(detail::threadCount(threads), goals.size(), [&](std::size_t n) {
    fields.lengths_[n] = fields.are_places_
                             ? sensors::wayFieldToPlace(*plan_, goals[n])
                             : sensors::wayField(*plan_, world_.scenes()[scene_], goals[n]);
  });
  return fields;
}

}  // namespace galactic
