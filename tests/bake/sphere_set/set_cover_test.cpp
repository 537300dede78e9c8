// Small set covers against an exhaustive search, and the parts that the search is made of.
#include "sphere_set/cover/set_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "sphere_set/cover/ball_weight.h"
#include "sphere_set/cover/local_search.h"
#include "sphere_set/gaps.h"
#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set::set_cover_test {
namespace {

constexpr std::uint32_t kSeed = 20250403;
constexpr int kInstances = 60;

FitTask someTask() {
  FitTask task;
  task.radii = {0.2, 0.3};
  task.eps = 0.05;
  return task;
}

/// Points in the unit square and spheres over it: every point is covered by some sphere.
struct Instance {
  std::vector<Vec3d> points;
  CandidatePool pool;
};

Instance randomInstance(std::mt19937& random, const FitTask& task) {
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-32; };
  Instance instance;
  for (int n = 0; n < 40; ++n) instance.points.push_back(asStored({unit(), 0, unit()}));
  std::vector<Candidate> spheres;
  for (std::uint32_t n = 0; n < 9; ++n)
    spheres.push_back({asStored({unit(), 0, unit()}), n % 2, 0});
  for (std::size_t n = 0; n < instance.points.size(); n += 6) {
    spheres.push_back({instance.points[n], 1, 0.01});
  }
  const PointGrid all(instance.points, 0.1);
  CandidatePool pool;
  appendCovering(task, all, spheres, pool);
  std::vector<char> covered(instance.points.size(), 0);
  markCovered(pool, 0, covered);
  std::vector<Vec3d> kept;
  for (std::size_t at = 0; at < covered.size(); ++at) {
    if (covered[at] != 0) kept.push_back(instance.points[at]);
  }
  instance.points = kept;
  appendCovering(task, PointGrid(kept, 0.1), spheres, instance.pool);
  return instance;
}

bool coversAll(const Instance& instance, const Selection& selection) {
  std::set<std::uint32_t> rows;
  for (const std::uint32_t at : selection) {
    for (const std::uint32_t row : instance.pool.cover.column(at)) rows.insert(row);
  }
  return rows.size() == instance.points.size();
}

/// By trying all selections; points are bits.
std::size_t smallestCover(const Instance& instance) {
  const std::size_t count = instance.pool.candidates.size();
  std::vector<std::uint64_t> covered(count, 0);
  for (std::uint32_t at = 0; at < count; ++at) {
    for (const std::uint32_t row : instance.pool.cover.column(at)) {
      covered[at] |= std::uint64_t{1} << row;
    }
  }
  std::uint64_t all = 0;
  for (std::size_t row = 0; row < instance.points.size(); ++row) all |= std::uint64_t{1} << row;
  std::size_t smallest = count;
  for (std::uint32_t bits = 1; bits < 1U << count; ++bits) {
    const auto size = static_cast<std::size_t>(std::popcount(bits));
    if (size >= smallest) continue;
    std::uint64_t together = 0;
    for (std::uint32_t left = bits; left != 0; left &= left - 1) {
      together |= covered[static_cast<std::size_t>(std::countr_zero(left))];
    }
    if (together == all) smallest = size;
  }
  return smallest;
}

TEST(SetCover, LocalSearchFindsTheSmallestCover) {
  std::mt19937 random(kSeed);
  const FitTask task = someTask();
  int improved = 0;
  for (int n = 0; n < kInstances; ++n) {
    const Instance instance = randomInstance(random, task);
    Selection greedy;
    completeGreedily(instance.pool, instance.points.size(), greedy);
    ASSERT_TRUE(coversAll(instance, greedy));
    Selection pruned = greedy;
    removeRedundant(instance.pool, instance.points.size(), pruned);
    ASSERT_TRUE(coversAll(instance, pruned));
    LocalSearch search(task, instance.points, instance.pool);
    const Selection found = search.improve(pruned, 2'000'000);
    ASSERT_TRUE(coversAll(instance, found));
    EXPECT_EQ(found.size(), smallestCover(instance)) << "seed " << kSeed << ", instance " << n;
    improved += found.size() < pruned.size() ? 1 : 0;
  }
  EXPECT_GT(improved, kInstances / 10);
  EXPECT_LT(improved, kInstances * 9 / 10);
}

TEST(SetCover, ALargeCoverGetsFewerExchangesForTheSameBudget) {
  const FitTask task = someTask();
  constexpr std::uint64_t kBudget = 400'000;
  std::vector<std::int64_t> exchanges;
  for (const std::size_t count : {50U, 4000U}) {
    // Points too far apart for a sphere to cover two, and two spheres for each.
    Instance instance;
    std::vector<Candidate> spheres;
    for (std::size_t n = 0; n < count; ++n) {
      const Vec3d p{static_cast<double>(n), 0, 0};
      instance.points.push_back(p);
      for (std::uint32_t radius : {0U, 1U}) spheres.push_back({p, radius, 0});
    }
    appendCovering(task, PointGrid(instance.points, 0.1), spheres, instance.pool);
    Selection greedy;
    completeGreedily(instance.pool, instance.points.size(), greedy);
    LocalSearch search(task, instance.points, instance.pool);
    EXPECT_EQ(search.improve(greedy, kBudget).size(), count);
    exchanges.push_back(search.exchanges());
  }
  // Of 4000 spheres, each exchange looks through nearly all: without a price for that, it took as
  // many exchanges as the small one.
  EXPECT_GT(exchanges[0], 2000);
  EXPECT_LT(exchanges[1], exchanges[0] / 5);
  EXPECT_GT(exchanges[1], 100);
}

TEST(SetCover, GapsToManySpheresAreThoseToTheNearest) {
  std::mt19937 random(kSeed + 2);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-32; };
  const FitTask task = someTask();
  std::vector<Candidate> spheres;
  for (std::uint32_t n = 0; n < 300; ++n) {
    spheres.push_back({{3 * unit(), 3 * unit(), 3 * unit()}, n % 2, 0});
  }
  std::vector<Vec3d> points;
  for (int n = 0; n < 3000; ++n) points.push_back({3 * unit(), 3 * unit(), 3 * unit()});
  const std::vector<double> gaps = gapsOf(task, spheres, points);
  std::size_t near = 0;
  for (std::size_t at = 0; at < points.size(); ++at) {
    double nearest = HUGE_VAL;
    for (const Candidate& sphere : spheres) {
      nearest = std::min(nearest, outside(task, sphere, points[at]));
    }
    ASSERT_EQ(gaps[at], nearest) << "seed " << kSeed + 2 << ", point " << at;
    near += nearest <= task.eps ? 1U : 0U;
  }
  EXPECT_GT(near, points.size() / 10);
  EXPECT_LT(near, points.size() * 9 / 10);
}

TEST(SetCover, WithoutDominatedIsAsSmall) {
  std::mt19937 random(kSeed + 1);
  const FitTask task = someTask();
  std::size_t before = 0;
  std::size_t after = 0;
  for (int n = 0; n < kInstances; ++n) {
    Instance instance = randomInstance(random, task);
    const std::size_t smallest = smallestCover(instance);
    before += instance.pool.candidates.size();
    instance.pool = withoutDominated(task, instance.points, instance.pool, 0.5);
    after += instance.pool.candidates.size();
    EXPECT_EQ(smallestCover(instance), smallest) << "seed " << kSeed + 1 << ", instance " << n;
  }
  EXPECT_GT(after, before / 10);
  EXPECT_LT(after, before * 9 / 10);
}

TEST(SetCover, GreedyPrefersLessProtrusionAmongEquals) {
  const FitTask task = someTask();
  const std::vector<Vec3d> points{{0, 0, 0}};
  CandidatePool pool;
  appendCovering(task, PointGrid(points, 0.1),
                 std::vector<Candidate>{{{0.1, 0, 0}, 0, 0.02}, {{0, 0.1, 0}, 0, 0.01}}, pool);
  Selection selection;
  completeGreedily(pool, points.size(), selection);
  EXPECT_EQ(selection, Selection{1});
}

TEST(PointGrid, FindsWhatBruteForceFinds) {
  std::mt19937 random(kSeed);
  const auto unit = [&] { return static_cast<double>(random()) * 0x1p-32; };
  std::vector<Vec3d> points;
  for (int n = 0; n < 500; ++n) points.push_back({unit(), 0.1 * unit(), unit()});
  const PointGrid grid(points, 0.07);
  std::size_t found = 0;
  for (int n = 0; n < 200; ++n) {
    const Vec3d center{2 * unit() - 0.5, unit() - 0.5, 2 * unit() - 0.5};
    const double radius = 0.6 * unit();
    std::set<std::uint32_t> by_grid;
    grid.visitWithin(center, radius, [&](std::uint32_t index, double) {
      by_grid.insert(index);
      return true;
    });
    std::set<std::uint32_t> by_force;
    for (std::uint32_t at = 0; at < points.size(); ++at) {
      if (squaredNorm(points[at] - center) <= radius * radius) by_force.insert(at);
    }
    EXPECT_EQ(by_grid, by_force);
    EXPECT_EQ(grid.anyWithin(center, radius), !by_force.empty());
    found += by_force.empty() ? 0U : 1U;
  }
  EXPECT_GT(found, 20U) << "seed " << kSeed;
  EXPECT_LT(found, 180U) << "seed " << kSeed;
}

TEST(BallWeight, IsTheSameOnEveryMachine) {
  std::mt19937 random(kSeed);
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
  std::vector<std::int32_t> weight;
  for (int n = 0; n < 1003; ++n) {
    for (auto* axis : {&x, &y, &z}) axis->push_back(static_cast<float>(random() % 1000) / 1000);
    weight.push_back(static_cast<std::int32_t>(random() % 50));
  }
  const BallWeight fastest = fastestBallWeight();
  for (std::size_t count = 0; count < x.size(); count += 7) {
    const WeightedPoints points{x.data(), y.data(), z.data(), weight.data(), count};
    const Ball ball{0.5F, 0.4F, 0.6F, 0.25F};
    std::int32_t sum = 0;
    for (std::size_t at = 0; at < count; ++at) {
      const float dx = x[at] - ball.x;
      const float dy = y[at] - ball.y;
      const float dz = z[at] - ball.z;
      if (dx * dx + dy * dy + dz * dz <= ball.squared_reach) sum += weight[at];
    }
    EXPECT_EQ(ballWeightPortable(points, ball), sum);
    EXPECT_EQ(fastest(points, ball), sum);
  }
}

}  // namespace
}  // namespace galactic::bake::sphere_set::set_cover_test
