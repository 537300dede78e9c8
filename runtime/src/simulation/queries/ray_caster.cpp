#include "galactic/ray_caster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "column_grid/free_way.h"
#include "galactic/kinematics.h"
#include "galactic/robot.h"
#include "simulation/collision/resting_box.h"
#include "simulation/queries/checked_state.h"
#include "support/call_check.h"
#include "support/threads/workers.h"

namespace galactic {
namespace {

using detail::StraightLine;
using simulation::RestingBox;

/// The number of lines that a thread takes at a time.
constexpr std::size_t kLinesOfAPart = 256;
/// Enlarges the ball around a box, so that rounding does not leave out a corner.
constexpr double kSlack = 1 + 1e-6;

/// A sphere of the robot, or of its held object.
struct Ball {
  Vec3 center;
  float radius = 0;
  CastEnd of = CastEnd::kRobot;
  std::int32_t index = -1;
};

struct Box {
  RestingBox box;
  /// The radius of a ball around it.
  double radius = 0;
  std::int32_t index = -1;
};

/// How far along a line it enters a ball: 0 from inside, none if it passes by.
std::optional<double> wayToBall(const StraightLine& line, const Vec3& center, double radius) {
  const double x = static_cast<double>(center.x) - static_cast<double>(line.from.x);
  const double y = static_cast<double>(center.y) - static_cast<double>(line.from.y);
  const double z = static_cast<double>(center.z) - static_cast<double>(line.from.z);
  const double beyond = x * x + y * y + z * z - radius * radius;
  if (beyond < 0) return 0;
  const double ahead = x * line.along[0] + y * line.along[1] + z * line.along[2];
  const double square = ahead * ahead - beyond;
  if (!(ahead > 0 && square > 0)) return std::nullopt;
  return beyond / (ahead + std::sqrt(square));
}

/// The nearest thing that a line has met so far.
struct Nearest {
  double distance = 0;
  CastEnd end = CastEnd::kNothing;
  std::int32_t index = -1;

  /// Whether a thing at distance `other` is nearer. If nothing is in the way so far, a thing
  /// exactly at the end counts, too.
  [[nodiscard]] bool isBehind(double other) const {
    return other < distance || (other == distance && end == CastEnd::kNothing);
  }
  void take(std::optional<double> other, CastEnd of, std::int32_t number) {
    if (other && isBehind(*other)) *this = {*other, of, number};
  }
};

CastEnd endOf(Clearance clearance) {
  switch (clearance) {
    case Clearance::kFree:
      return CastEnd::kNothing;
    case Clearance::kBlocked:
      return CastEnd::kScene;
    case Clearance::kOutside:
      break;
  }
  return CastEnd::kOutside;
}

bool isFinite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void checkLines(const char* call, const CastLines& lines, std::size_t hits) {
  const std::size_t count = lines.origins.size();
  detail::checkLength(call, "directions", lines.directions.size(), count);
  detail::checkLength(call, "lengths", lines.lengths.size(), count);
  detail::checkLength(call, "hits", hits, count);
  for (std::size_t n = 0; n < count; ++n) {
    if (!isFinite(lines.origins[n])) {
      detail::refuseCall(call, fmt::format("origins[{}] holds a number that is not finite", n));
    }
    if (!isFinite(lines.directions[n])) {
      detail::refuseCall(call, fmt::format("directions[{}] holds a number that is not finite", n));
    }
    if (lines.directions[n] == Vec3{}) {
      detail::refuseCall(call, fmt::format("directions[{}] is zero, and leads nowhere", n));
    }
    if (!(lines.lengths[n] >= 0)) {
      detail::refuseCall(
          call, fmt::format("lengths[{}] is {}, expected 0 or more meters", n, lines.lengths[n]));
    }
  }
}

/// The grid for spheres of a radius; throws if there is none.
const ColumnGrid& gridOf(const char* call, const Scene& scene, float radius) {
  const std::optional<std::size_t> index = scene.gridIndex(radius);
  if (index) return scene.grids()[*index];
  std::string radii;
  for (const ColumnGrid& grid : scene.grids()) {
    radii += fmt::format("{}{}", radii.empty() ? "" : ", ", grid.radius());
  }
  detail::refuseCall(call, fmt::format("found the radius {} m, expected one that the scene has a "
                                       "grid for: {}",
                                       radius, radii));
}

/// Calls `cast` with the index, the lines and the hits of each env of a batch.
template <class Cast>
void forEachEnv(const char* call, const BatchSimulator& simulator, const CastLines& lines,
                std::span<CastHit> hits, std::uint32_t threads, const Cast& cast) {
  if (simulator.isStepping()) {
    detail::refuseCall(call, "found a step that has begun; end it first, with endStep()");
  }
  const std::size_t envs = simulator.envCount();
  if (hits.size() % envs != 0) {
    detail::refuseCall(call, fmt::format("found {} lines for {} envs, expected as many for each",
                                         hits.size(), envs));
  }
  const std::size_t each = hits.size() / envs;
  if (each == 0) return;
  detail::forEachPart(detail::threadCount(threads), envs, [&](std::size_t env) {
    const std::size_t first = env * each;
    const CastLines own{lines.origins.subspan(first, each), lines.directions.subspan(first, each),
                        lines.lengths.subspan(first, each)};
    cast(env, own, hits.subspan(first, each));
  });
}

}  // namespace

class RayCaster::Impl {
 public:
  explicit Impl(const Scene& scene) : scene_(scene) {}
  Impl(const World& world, const EnvState& state, CastRobot robot);

  [[nodiscard]] const Scene& scene() const { return scene_; }

  /// Finds which spheres of the grid's radius touch nothing.
  void find(const ColumnGrid& grid, std::span<const Vec3> centers, std::span<std::uint8_t> free,
            std::uint32_t threads) const;

  /// Casts a ball of `radius` against the robot and the objects, and one of the grid's radius
  /// against the scene.
  void cast(const ColumnGrid& grid, float radius, const CastLines& lines, std::span<CastHit> hits,
            std::uint32_t threads) const;

 private:
  void addRobot(const World& world, const EnvState& state);
  void addHeld(const World& world, const ObjectModel& model, const EnvState& state);
  [[nodiscard]] CastHit castOne(const ColumnGrid& grid, float radius,
                                const StraightLine& line) const;

  /// Keeps the packs of the scene alive, unless the caller does.
  std::optional<World> world_;
  Scene scene_;
  std::vector<Box> boxes_;
  std::vector<Ball> balls_;
};

RayCaster::Impl::Impl(const World& world, const EnvState& state, CastRobot robot)
    : world_(world), scene_(world.scenes()[0]) {
  const std::span<const Placement> placements =
      simulation::checkedObjects("RayCaster", world, state);
  scene_ = world.scenes()[state.scene];
  for (std::size_t n = 0; n < placements.size(); ++n) {
    const ObjectModel& model = world.objectOf(placements[n]);
    const auto index = static_cast<std::int32_t>(n);
    if (index != state.held) {
      const RestingBox box = simulation::restingBox(model.box, state.objects[n]);
      const auto squared = static_cast<double>(dot(box.half_extents, box.half_extents));
      boxes_.push_back({box, std::sqrt(squared), index});
    } else if (robot == CastRobot::kIsSeen) {
      addHeld(world, model, state);
    }
  }
  if (robot == CastRobot::kIsSeen) addRobot(world, state);
}

void RayCaster::Impl::addHeld(const World& world, const ObjectModel& model, const EnvState& state) {
  const Pose& world_from_object = state.objects[static_cast<std::size_t>(state.held)];
  for (const SetSphere& sphere : model.spheres) {
    balls_.push_back({world_from_object * sphere.center, world.radii()[sphere.radius_index],
                      CastEnd::kObject, state.held});
  }
}

void RayCaster::Impl::addRobot(const World& world, const EnvState& state) {
  const Robot& robot = world.robot();
  std::vector<Pose> world_from_links(robot.links().size());
  forwardKinematics(robot.links(), state.world_from_root, state.joint_positions, world_from_links);
  for (const SphereGroup& group : robot.groups()) {
    for (const SetSphere& sphere : group.spheres) {
      balls_.push_back({world_from_links[group.link] * sphere.center,
                        robot.radii()[sphere.radius_index], CastEnd::kRobot,
                        static_cast<std::int32_t>(group.link)});
    }
  }
}

CastHit RayCaster::Impl::castOne(const ColumnGrid& grid, float radius,
                                 const StraightLine& line) const {
  const detail::FreeWay way = detail::freeWay(grid, line);
  Nearest nearest{way.length, endOf(way.end)};
  const auto wider = static_cast<double>(radius);
  for (const Box& one : boxes_) {
    const auto around = wayToBall(line, one.box.center, (one.radius + wider) * kSlack);
    if (!around || !nearest.isBehind(*around)) continue;
    nearest.take(simulation::wayToOverlap(one.box, line.from, line.along, radius), CastEnd::kObject,
                 one.index);
  }
  for (const Ball& ball : balls_) {
    const double reach = static_cast<double>(ball.radius) + wider;
    nearest.take(wayToBall(line, ball.center, reach), ball.of, ball.index);
  }
  return {static_cast<float>(nearest.distance), nearest.end, nearest.index};
}

void RayCaster::Impl::cast(const ColumnGrid& grid, float radius, const CastLines& lines,
                           std::span<CastHit> hits, std::uint32_t threads) const {
  const std::size_t count = hits.size();
  const std::size_t parts = (count + kLinesOfAPart - 1) / kLinesOfAPart;
  detail::forEachPart(detail::threadCount(threads), parts, [&](std::size_t part) {
    const std::size_t end = std::min(count, (part + 1) * kLinesOfAPart);
    for (std::size_t n = part * kLinesOfAPart; n < end; ++n) {
      const auto length = static_cast<double>(lines.lengths[n]);
      hits[n] = castOne(grid, radius,
                        detail::straightLine(lines.origins[n], lines.directions[n], length));
    }
  });
}

void RayCaster::Impl::find(const ColumnGrid& grid, std::span<const Vec3> centers,
                           std::span<std::uint8_t> free, std::uint32_t threads) const {
  const std::size_t parts = (centers.size() + kLinesOfAPart - 1) / kLinesOfAPart;
  detail::forEachPart(detail::threadCount(threads), parts, [&](std::size_t part) {
    const std::size_t end = std::min(centers.size(), (part + 1) * kLinesOfAPart);
    for (std::size_t n = part * kLinesOfAPart; n < end; ++n) {
      const CastHit hit =
          castOne(grid, grid.radius(), detail::straightLine(centers[n], {0, 1, 0}, 0));
      free[n] = hit.end == CastEnd::kNothing ? 1 : 0;
    }
  });
}

RayCaster::RayCaster(const Scene& scene) : impl_(std::make_shared<const Impl>(scene)) {}

RayCaster::RayCaster(const World& world, const EnvState& state, CastRobot robot)
    : impl_(std::make_shared<const Impl>(world, state, robot)) {}

void RayCaster::castRays(const CastLines& lines, std::span<CastHit> hits,
                         std::uint32_t threads) const {
  checkLines("RayCaster::castRays", lines, hits.size());
  impl_->cast(impl_->scene().grids().front(), 0, lines, hits, threads);
}

void RayCaster::sweepSpheres(float radius, const CastLines& lines, std::span<CastHit> hits,
                             std::uint32_t threads) const {
  constexpr const char* kCall = "RayCaster::sweepSpheres";
  checkLines(kCall, lines, hits.size());
  const ColumnGrid& grid = gridOf(kCall, impl_->scene(), radius);
  impl_->cast(grid, grid.radius(), lines, hits, threads);
}

void RayCaster::areSpheresFree(float radius, std::span<const Vec3> centers,
                               std::span<std::uint8_t> free, std::uint32_t threads) const {
  constexpr const char* kCall = "RayCaster::areSpheresFree";
  detail::checkLength(kCall, "free", free.size(), centers.size());
  for (std::size_t n = 0; n < centers.size(); ++n) {
    if (isFinite(centers[n])) continue;
    detail::refuseCall(kCall, fmt::format("centers[{}] holds a number that is not finite", n));
  }
  impl_->find(gridOf(kCall, impl_->scene(), radius), centers, free, threads);
}

void castRaysInEnvs(const BatchSimulator& simulator, const CastLines& lines,
                    std::span<CastHit> hits, CastRobot robot, std::uint32_t threads) {
  constexpr const char* kCall = "castRaysInEnvs";
  checkLines(kCall, lines, hits.size());
  forEachEnv(kCall, simulator, lines, hits, threads,
             [&](std::size_t env, const CastLines& own, std::span<CastHit> found) {
               RayCaster(simulator.world(), simulator.envState(env), robot).castRays(own, found);
             });
}

void sweepSpheresInEnvs(const BatchSimulator& simulator, float radius, const CastLines& lines,
                        std::span<CastHit> hits, CastRobot robot, std::uint32_t threads) {
  constexpr const char* kCall = "sweepSpheresInEnvs";
  checkLines(kCall, lines, hits.size());
  // All scenes of a world have grids of the same radii.
  static_cast<void>(gridOf(kCall, simulator.world().scenes()[0], radius));
  forEachEnv(kCall, simulator, lines, hits, threads,
             [&](std::size_t env, const CastLines& own, std::span<CastHit> found) {
               RayCaster(simulator.world(), simulator.envState(env), robot)
                   .sweepSpheres(radius, own, found);
             });
}

}  // namespace galactic
