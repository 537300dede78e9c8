#include "inspect/query_workload.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace galactic {
namespace {

constexpr std::size_t kHandSpheres = 16;
constexpr std::size_t kArmSpheres = 16;
constexpr std::size_t kBodySpheres = 8;
constexpr std::size_t kRobotSpheres = kHandSpheres + kArmSpheres + kBodySpheres;
/// Farthest that a robot moves in a step, meters.
constexpr float kStep = 0.02F;

/// Uniform random numbers that are the same with every standard library.
class Uniform {
 public:
  explicit Uniform(std::uint32_t seed) : random_(seed) {}

  float operator()(float lo, float hi) {
    constexpr double kRange = 4294967296.0;
    const double fraction = static_cast<double>(random_()) / kRange;
    return lo + static_cast<float>(fraction * static_cast<double>(hi - lo));
  }

  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }

 private:
  std::mt19937 random_;
};

/// A robot: the place of its base, and the places of its spheres relative to the base.
struct Robot {
  std::uint32_t scene = 0;
  Vec3 base;
  float heading = 0;
  std::array<Vec3, kRobotSpheres> spheres;
};

/// The middle of a random column with free space, at the bottom of its lowest span; the grid's
/// corner if none is found.
Vec3 freePlace(const ColumnGrid& grid, Uniform& uniform) {
  constexpr int kTries = 1000;
  const ColumnGridLayout& layout = grid.layout();
  Vec3 place{layout.min_x, layout.heights.lo, layout.min_z};
  for (int n = 0; n < kTries; ++n) {
    const std::uint32_t i = uniform.below(grid.columnsX());
    const std::uint32_t k = uniform.below(grid.columnsZ());
    std::array<Span, 1> lowest;
    if (grid.spans(i, k, lowest) == 0) continue;
    place.x = layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing;
    place.y = lowest[0].lo - layout.radius;
    place.z = layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing;
    break;
  }
  return place;
}

std::array<Vec3, kRobotSpheres> robotSpheres(Uniform& uniform) {
  const Vec3 hand{uniform(0.3F, 0.8F), uniform(0.3F, 1.4F), uniform(-0.3F, 0.3F)};
  std::array<Vec3, kRobotSpheres> spheres;
  for (std::size_t n = 0; n < kRobotSpheres; ++n) {
    if (n < kHandSpheres + kArmSpheres) {
      const float t = static_cast<float>(n % kHandSpheres) / (kHandSpheres - 1);
      spheres[n] = n < kHandSpheres
                       ? Vec3{hand.x + 0.1F * t, hand.y + uniform(-0.05F, 0.05F),
                              hand.z + uniform(-0.05F, 0.05F)}
                       : Vec3{0.1F + hand.x * t, 0.8F + (hand.y - 0.8F) * t, hand.z * t};
    } else {
      const auto level = static_cast<float>(n - kHandSpheres - kArmSpheres);
      constexpr float kEighthTurn = 0.785F;
      spheres[n] = {0.2F * std::cos(level * kEighthTurn), 0.15F + 0.12F * level,
                    0.2F * std::sin(level * kEighthTurn)};
    }
  }
  return spheres;
}

void move(Robot& robot, Uniform& uniform) {
  robot.heading += uniform(-0.05F, 0.05F);
  const float distance = kStep * uniform(-0.5F, 1);
  robot.base.x += distance * std::cos(robot.heading);
  robot.base.z += distance * std::sin(robot.heading);
  constexpr float kArmMotion = 0.003F;
  for (Vec3& sphere : robot.spheres) {
    sphere.x += uniform(-kArmMotion, kArmMotion);
    sphere.y += uniform(-kArmMotion, kArmMotion);
    sphere.z += uniform(-kArmMotion, kArmMotion);
  }
}

void appendGroup(QueryWorkload& workload, std::uint32_t scene, std::uint32_t grid,
                 std::size_t count) {
  workload.groups.push_back({scene, grid, workload.x.size(), count});
  workload.longest = std::max(workload.longest, count);
}

void appendCenter(QueryWorkload& workload, Vec3 center) {
  workload.x.push_back(center.x);
  workload.y.push_back(center.y);
  workload.z.push_back(center.z);
}

void appendRobot(QueryWorkload& workload, const Robot& robot, std::size_t grids) {
  const float c = std::cos(robot.heading);
  const float s = std::sin(robot.heading);
  for (std::size_t n = 0; n < kRobotSpheres; ++n) {
    if (n == 0) appendGroup(workload, robot.scene, 0, kHandSpheres);
    if (n == kHandSpheres) {
      appendGroup(workload, robot.scene, static_cast<std::uint32_t>(grids / 2), kArmSpheres);
    }
    if (n == kHandSpheres + kArmSpheres) {
      appendGroup(workload, robot.scene, static_cast<std::uint32_t>(grids - 1), kBodySpheres);
    }
    const Vec3& sphere = robot.spheres[n];
    appendCenter(workload, {robot.base.x + c * sphere.x - s * sphere.z, robot.base.y + sphere.y,
                            robot.base.z + s * sphere.x + c * sphere.z});
  }
}

}  // namespace

QueryWorkload coherentWorkload(std::span<const SceneGrids> scenes, std::uint32_t robots,
                               std::uint32_t steps, std::uint32_t seed) {
  Uniform uniform(seed);
  std::vector<Robot> all(robots);
  for (std::uint32_t n = 0; n < robots; ++n) {
    all[n].scene = n % static_cast<std::uint32_t>(scenes.size());
    all[n].base = freePlace(scenes[all[n].scene].back(), uniform);
    all[n].heading = uniform(0, 6.28F);
    all[n].spheres = robotSpheres(uniform);
  }
  QueryWorkload workload;
  workload.name = fmt::format("coherent, {} robots", robots);
  workload.spheres = std::size_t{robots} * kRobotSpheres;
  for (std::uint32_t step = 0; step < steps; ++step) {
    for (Robot& robot : all) {
      move(robot, uniform);
      appendRobot(workload, robot, scenes[robot.scene].size());
    }
  }
  return workload;
}

QueryWorkload randomWorkload(std::span<const SceneGrids> scenes, std::uint32_t groups,
                             std::uint32_t seed) {
  constexpr std::size_t kGroup = 8;
  Uniform uniform(seed);
  QueryWorkload workload;
  workload.name = "random";
  for (std::uint32_t n = 0; n < groups; ++n) {
    const std::uint32_t scene = uniform.below(static_cast<std::uint32_t>(scenes.size()));
    const std::uint32_t index = uniform.below(static_cast<std::uint32_t>(scenes[scene].size()));
    const ColumnGridLayout& grid = scenes[scene][index].layout();
    appendGroup(workload, scene, index, kGroup);
    for (std::size_t sphere = 0; sphere < kGroup; ++sphere) {
      appendCenter(workload,
                   {grid.min_x + uniform(0, static_cast<float>(grid.columns_x) * grid.spacing),
                    uniform(grid.heights.lo, grid.heights.hi),
                    grid.min_z + uniform(0, static_cast<float>(grid.columns_z) * grid.spacing)});
    }
  }
  return workload;
}

}  // namespace galactic
