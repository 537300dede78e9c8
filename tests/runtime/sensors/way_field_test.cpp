// Ways along the floor against shortest paths from cell to cell in sight of each other, in double
// precision.
#include "sensors/way_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "sensors/floor_plan.h"
#include "support/homes/box_world.h"

namespace galactic::test::way_field_test {
namespace {

using sensors::FloorPlan;
using sensors::kPlanCell;
using sensors::PlanCell;
using sensors::StandingRobot;
using sensors::Way;

constexpr std::uint32_t kSeed = 4711;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Fast marching is a little long behind corners, and paths from middle to middle of
/// cells a little short of a way that keeps off corners as the lattice does.
constexpr double kRelativeTolerance = 0.05;
constexpr double kTolerance = 1.5 * static_cast<double>(kPlanCell);

StandingRobot standing(const World& world) {
  const auto motion = simulation::makeMotionModel(world.robot(), world.startPositionIndices());
  return {world.robot(), motion.value(), simulation::motionKernels()};
}

/// The floor of a start; none where the robot cannot stand there.
FloorPlan planFrom(const World& world, const Vec3& start) {
  const Scene& scene = world.scenes().front();
  const StandingRobot robot = standing(world);
  const auto seed = FloorPlan::seedOf(scene, robot, start, {});
  return seed ? FloorPlan(scene, robot, *seed, {}) : FloorPlan();
}

/// A room with walls around, and a few inside.
std::vector<Block> maze(std::mt19937& random) {
  std::vector<Block> blocks{plainFloor(),
                            {{0, 0, 0}, {0.125F, 2, 3}},
                            {{2.875F, 0, 0}, {3, 2, 3}},
                            {{0, 0, 0}, {3, 2, 0.125F}},
                            {{0, 0, 2.875F}, {3, 2, 3}}};
  for (int n = 0; n < 6; ++n) {
    const Vec3 corner{uniformIn(random, 0.2F, 2.4F), 0, uniformIn(random, 0.2F, 2.4F)};
    const bool is_long = random() % 2 == 0;
    const float longer = uniformIn(random, 0.4F, 1.6F);
    blocks.push_back(
        {corner, {corner.x + (is_long ? longer : 0.1F), 2, corner.z + (is_long ? 0.1F : longer)}});
  }
  return blocks;
}

/// Whether a straight line in the ground plane stays on passable cells.
bool isOpen(const FloorPlan& plan, const Vec3& a, const Vec3& b) {
  const double x = static_cast<double>(b.x) - static_cast<double>(a.x);
  const double z = static_cast<double>(b.z) - static_cast<double>(a.z);
  const int steps = static_cast<int>(std::hypot(x, z) / 0.02) + 1;
  for (int n = 0; n <= steps; ++n) {
    const double share = static_cast<double>(n) / steps;
    const PlanCell cell = plan.cellAt(static_cast<float>(static_cast<double>(a.x) + share * x),
                                      static_cast<float>(static_cast<double>(a.z) + share * z));
    if (!plan.isPassable(cell)) return false;
  }
  return true;
}

/// What the scene's columns know of a wall reaches this far beyond it, meters: the radius of their
/// sphere, and half the diagonal of a cell.
constexpr float kGrown = 0.04F;

/// Whether the line meets no wall, each made larger by `grown`.
bool isInSight(const std::vector<Block>& blocks, const Vec3& a, const Vec3& b, float grown) {
  for (int n = 0; n <= 200; ++n) {
    const float share = static_cast<float>(n) / 200;
    const Vec3 at = a + (b - a) * share;
    for (std::size_t wall = 1; wall < blocks.size(); ++wall) {
      const Block& block = blocks[wall];
      const bool is_beside = at.x < block.min.x - grown || at.x > block.max.x + grown ||
                             at.z < block.min.z - grown || at.z > block.max.z + grown;
      if (!is_beside) return false;
    }
  }
  return true;
}

/// Lengths of the shortest paths over lines of sight between the middles of cells (Dijkstra), which
/// begin where the point is in sight past walls made larger.
std::vector<double> pathLengths(const FloorPlan& plan, const std::vector<Block>& blocks,
                                const Vec3& point, float grown) {
  std::vector<PlanCell> cells;
  std::vector<double> lengths;
  for (std::int32_t k = 0; k < plan.columnsZ(); ++k) {
    for (std::int32_t i = 0; i < plan.columnsX(); ++i) {
      if (!plan.isPassable({i, k})) continue;
      const Vec3 at = plan.middle({i, k});
      const double length = std::hypot(static_cast<double>(at.x) - static_cast<double>(point.x),
                                       static_cast<double>(at.z) - static_cast<double>(point.z));
      cells.push_back({i, k});
      const bool begins = length <= static_cast<double>(sensors::kLastLeg) &&
                          isInSight(blocks, {at.x, 0, at.z}, {point.x, 0, point.z}, grown);
      lengths.push_back(begins ? length : kInfinity);
    }
  }
  std::vector<bool> is_done(cells.size());
  std::vector<double> result(plan.cellCount(), kInfinity);
  for (std::size_t round = 0; round < cells.size(); ++round) {
    std::size_t best = cells.size();
    for (std::size_t n = 0; n < cells.size(); ++n) {
      if (!is_done[n] && (best == cells.size() || lengths[n] < lengths[best])) best = n;
    }
    if (lengths[best] == kInfinity) break;
    is_done[best] = true;
    result[plan.indexOf(cells[best])] = lengths[best];
    const Vec3 from = plan.middle(cells[best]);
    for (std::size_t n = 0; n < cells.size(); ++n) {
      if (is_done[n]) continue;
      const Vec3 to = plan.middle(cells[n]);
      const double step = std::hypot(static_cast<double>(to.x) - static_cast<double>(from.x),
                                     static_cast<double>(to.z) - static_cast<double>(from.z));
      if (lengths[best] + step < lengths[n] && isOpen(plan, from, to)) {
        lengths[n] = lengths[best] + step;
      }
    }
  }
  return result;
}

TEST(FloorPlan, ReachesWhatTheRobotCanDriveTo) {
  std::vector<Block> blocks{plainFloor(),
                            // A wall with a gap of 50 cm at the end, and a step of 3 cm behind it.
                            {{1.25F, 0, 0}, {1.5F, 2, 2.5F}},
                            {{1.5F, 0, 0}, {3, 0.03F, 1.5F}},
                            // A platform that it cannot climb.
                            {{0, 0, 2}, {0.5F, 0.4F, 3}},
                            // A board under which it does not fit.
                            {{2.25F, 0.3F, 2}, {3, 0.35F, 3}}};
  const BoxWorld world(blocks, {{{0.625F, 0, 0.625F}, 0, {{0.6F, 1.5F, 0.6F}}}});
  const FloorPlan plan = planFrom(world.world(), {0.625F, 0, 0.625F});
  const auto at = [&plan](float x, float z) { return plan.isPassable(plan.cellAt(x, z)); };
  EXPECT_TRUE(at(0.65F, 0.65F));
  EXPECT_TRUE(at(1.35F, 2.75F));
  EXPECT_TRUE(at(2.25F, 0.75F));
  EXPECT_NEAR(plan.middle(plan.cellAt(2.25F, 0.75F)).y, 0.03F, 1e-3F);
  EXPECT_FALSE(at(1.35F, 1.25F));
  EXPECT_FALSE(at(1.22F, 1.25F)) << "too near to the wall";
  EXPECT_FALSE(at(0.25F, 2.5F));
  EXPECT_FALSE(at(2.65F, 2.5F));
  EXPECT_FALSE(at(-0.25F, 0.5F));
  EXPECT_TRUE(plan.covers({0.65F, 0, 0.65F}));
  EXPECT_FALSE(plan.covers({0.25F, 0.4F, 2.5F}));
}

TEST(WayField, IsAsLongAsTheShortestPath) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  int around = 0;
  int cells = 0;
  int closed = 0;
  double sum = 0;
  for (int round = 0; round < 8; ++round) {
    const std::vector<Block> blocks = maze(random);
    const Vec3 start{uniformIn(random, 0.3F, 2.7F), 0, uniformIn(random, 0.3F, 2.7F)};
    const BoxWorld world(blocks, {{{0.5F, 0, 0.5F}, 0, {{1, 1.5F, 1}}}});
    const Scene& scene = world.world().scenes().front();
    const FloorPlan plan = planFrom(world.world(), start);
    Vec3 point;
    do {
      point = {uniformIn(random, 0.3F, 2.7F), 0.5F, uniformIn(random, 0.3F, 2.7F)};
    } while (!isInSight(blocks, point, point, 0.1F));
    const std::vector<std::uint16_t> field = sensors::wayField(plan, scene, point);
    const std::vector<double> least = pathLengths(plan, blocks, point, 0);
    const std::vector<double> most = pathLengths(plan, blocks, point, kGrown);
    for (std::int32_t k = 0; k < plan.columnsZ(); ++k) {
      for (std::int32_t i = 0; i < plan.columnsX(); ++i) {
        const PlanCell cell{i, k};
        if (!plan.isPassable(cell)) continue;
        const double shortest = least[plan.indexOf(cell)];
        const double longest = most[plan.indexOf(cell)];
        const std::uint16_t length = field[plan.indexOf(cell)];
        ++cells;
        if (length == sensors::kNoWay) {
          ++closed;
          ASSERT_EQ(longest, kInfinity) << "round " << round << " cell " << i << ", " << k;
          continue;
        }
        const double found = static_cast<double>(length) * static_cast<double>(sensors::kWayUnit);
        ASSERT_GT(found, (1 - kRelativeTolerance) * shortest - kTolerance)
            << "round " << round << " cell " << i << ", " << k;
        ASSERT_LT(found, (1 + kRelativeTolerance) * longest + kTolerance)
            << "round " << round << " cell " << i << ", " << k;
        const Vec3 at = plan.middle(cell);
        const double straight =
            std::hypot(static_cast<double>(at.x) - static_cast<double>(point.x),
                       static_cast<double>(at.z) - static_cast<double>(point.z));
        around += shortest > straight + static_cast<double>(kPlanCell) ? 1 : 0;
        sum += std::max({shortest - found, found - longest, 0.0});
      }
    }
  }
  std::printf("cells %d, around a corner %d, without a way %d, mean error %.1f mm\n", cells, around,
              closed, 1000 * sum / cells);
  EXPECT_GT(10 * around, cells);
  EXPECT_LT(10 * around, 9 * cells);
  EXPECT_LT(sum / cells, static_cast<double>(kPlanCell));
}

TEST(WayField, IsStraightInAnyDirection) {
  const BoxWorld world({plainFloor()}, {{{0.5F, 0, 0.5F}, 0, {{1, 1.5F, 1}}}});
  const FloorPlan plan = planFrom(world.world(), {0.5F, 0, 0.5F});
  const Vec3 place = plan.middle(plan.cellAt(0.5F, 0.5F));
  const std::vector<std::uint16_t> field = sensors::wayFieldToPlace(plan, place);
  int cells = 0;
  double greatest = 0;
  for (std::int32_t k = 0; k < plan.columnsZ(); ++k) {
    for (std::int32_t i = 0; i < plan.columnsX(); ++i) {
      if (!plan.isPassable({i, k})) continue;
      const Vec3 at = plan.middle({i, k});
      const double straight = std::hypot(static_cast<double>(at.x) - static_cast<double>(place.x),
                                         static_cast<double>(at.z) - static_cast<double>(place.z));
      if (straight < 1) continue;
      const auto length = static_cast<double>(field[plan.indexOf({i, k})]);
      const double found = length * static_cast<double>(sensors::kWayUnit);
      ++cells;
      greatest = std::max(greatest, std::abs(found / straight - 1));
    }
  }
  std::printf("cells %d, greatest error %.2f %%\n", cells, 100 * greatest);
  EXPECT_GT(cells, 300);
  EXPECT_LT(greatest, 0.025) << "of first order, fast marching errs by 5.6 %";
}

TEST(WayField, LeadsThere) {
  std::mt19937 random(kSeed);
  int ways = 0;
  for (int round = 0; round < 8; ++round) {
    const std::vector<Block> blocks = maze(random);
    const BoxWorld world(blocks, {{{0.5F, 0, 0.5F}, 0, {{1, 1.5F, 1}}}});
    const Scene& scene = world.world().scenes().front();
    const FloorPlan plan =
        planFrom(world.world(), {uniformIn(random, 0.3F, 2.7F), 0, uniformIn(random, 0.3F, 2.7F)});
    const Vec3 point{uniformIn(random, 0.3F, 2.7F), 0.5F, uniformIn(random, 0.3F, 2.7F)};
    const std::vector<std::uint16_t> field = sensors::wayField(plan, scene, point);
    for (int n = 0; n < 40; ++n) {
      Vec3 at{uniformIn(random, 0.3F, 2.7F), 0, uniformIn(random, 0.3F, 2.7F)};
      if (!plan.isPassable(plan.cellAt(at.x, at.z))) continue;
      Way way = sensors::wayFrom(plan, field, at.x, at.z);
      if (way.distance < 0) continue;
      ++ways;
      const float length = way.distance;
      ASSERT_NEAR(std::hypot(way.x, way.z), 1, 1e-4F);
      constexpr float kStep = 0.05F;
      int steps = 0;
      while (way.distance > 0.5F && steps < 200) {
        at.x += kStep * way.x;
        at.z += kStep * way.z;
        way = sensors::wayFrom(plan, field, at.x, at.z);
        ASSERT_GE(way.distance, 0) << "round " << round << ": lost at " << at.x << ", " << at.z;
        ++steps;
      }
      ASSERT_LE(way.distance, 0.5F) << "round " << round << ": stuck at " << at.x << ", " << at.z;
      EXPECT_LT(static_cast<float>(steps) * kStep, 1.15F * length + 0.2F);
    }
  }
  EXPECT_GT(ways, 100);
}

TEST(WayField, SaysWhereThereIsNoWay) {
  // A closed cell in the corner; the point is behind its wall.
  const std::vector<Block> blocks{
      plainFloor(), {{2, 0, 0}, {2.125F, 2, 1}}, {{2, 0, 1}, {3, 2, 1.125F}}};
  const BoxWorld world(blocks, {{{0.5F, 0, 0.5F}, 0, {{1, 1.5F, 1}}}});
  const Scene& scene = world.world().scenes().front();
  const FloorPlan plan = planFrom(world.world(), {0.5F, 0, 0.5F});
  const std::vector<std::uint16_t> field = sensors::wayField(plan, scene, {2.5F, 0.5F, 0.5F});
  EXPECT_TRUE(std::ranges::all_of(field, [](std::uint16_t v) { return v == sensors::kNoWay; }));
  const Way way = sensors::wayFrom(plan, field, 0.5F, 0.5F);
  EXPECT_EQ(way.distance, -1);
  EXPECT_EQ(way.x, 0);
  EXPECT_EQ(way.z, 0);
  // Outside of everything.
  EXPECT_EQ(sensors::wayFrom(plan, field, -50, 80).distance, -1);
}

}  // namespace
}  // namespace galactic::test::way_field_test
