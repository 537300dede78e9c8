// The sample apartment has room for its robot: whoever changes it must not close a way.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <set>
#include <utility>

#include "galactic/scene.h"
#include "support/homes/sample_world.h"

namespace galactic::scripted::sample_ways_test {
namespace {

using Cell = std::pair<int, int>;
constexpr float kEdge = 0.05F;
// Porter's base and 4 cm beside it. Its spheres stick out by 2 cm, by more in a coarse fit.
constexpr float kRadius = 0.27F + 0.04F;

Cell cellAt(float x, float z) {
  return {static_cast<int>(std::lround(x / kEdge)), static_cast<int>(std::lround(z / kEdge))};
}

/// Whether a cylinder as tall as Porter's mast finds room on the floor.
bool hasRoom(const ColumnGrid& grid, const Cell& cell) {
  const auto x = static_cast<float>(cell.first) * kEdge;
  const auto z = static_cast<float>(cell.second) * kEdge;
  constexpr int kDirections = 16;
  for (const float y : {0.14F, 0.35F, 0.55F, 0.75F, 0.95F}) {
    for (int n = 0; n < kDirections; ++n) {
      const float angle = 2 * std::numbers::pi_v<float> / kDirections * static_cast<float>(n);
      const float out = kRadius - grid.radius();
      const Vec3 center{x + out * std::cos(angle), y, z + out * std::sin(angle)};
      if (grid.clearance(center) != Clearance::kFree) return false;
    }
  }
  return true;
}

std::set<Cell> reachedFrom(const ColumnGrid& grid, const Cell& start) {
  std::set<Cell> reached{start};
  std::deque<Cell> waiting{start};
  while (!waiting.empty()) {
    const Cell at = waiting.front();
    waiting.pop_front();
    for (const auto& [dx, dz] : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell next{at.first + dx, at.second + dz};
      if (!reached.contains(next) && hasRoom(grid, next)) {
        reached.insert(next);
        waiting.push_back(next);
      }
    }
  }
  return reached;
}

TEST(SampleApartment, HasWaysForItsRobot) {
  const test::MemoryPack pack = test::bakeSampleApartment();
  const auto scene = test::MemoryPack::opened(Scene::from(pack.pack()));
  const ColumnGrid& grid = scene.grids().back();
  ASSERT_FLOAT_EQ(grid.radius(), 0.12F);
  const Cell corridor = cellAt(2.3F, -2.1F);
  ASSERT_TRUE(hasRoom(grid, corridor));
  const std::set<Cell> reached = reachedFrom(grid, corridor);
  const struct {
    const char* what;
    float x;
    float z;
  } places[] = {{"kitchen", -2.0F, -1.8F},
                {"window of the kitchen", -3.5F, -1.2F},
                {"middle of the living room", -0.2F, 0.0F},
                {"between coffee table and armchair", -1.4F, 1.2F},
                {"between sofa and bookshelf", -0.5F, 2.3F},
                {"bed", 2.6F, 0.2F}};
  for (const auto& [what, x, z] : places) {
    EXPECT_TRUE(reached.contains(cellAt(x, z))) << what;
  }
}

}  // namespace
}  // namespace galactic::scripted::sample_ways_test
