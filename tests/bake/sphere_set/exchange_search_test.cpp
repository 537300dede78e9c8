// The search for sets with a small error, against errors counted anew in double precision.
#include "sphere_set/curve/exchange_search.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>
#include <vector>

#include "sphere_set/curve/gap_gain.h"
#include "sphere_set/shapes.h"
#include "sphere_set/solid/distance_grid.h"
#include "sphere_set/solid/surface_samples.h"

namespace galactic::bake::sphere_set::exchange_search_test {
namespace {

/// A box, with everything that a search needs.
struct Scene {
  Scene() : solid(test::box(0.5, 0.1, 0.2).mesh, 0.015, 1) {
    task.solid = &solid;
    task.radii = {0.015, 0.05, 0.12};
    task.eps = 0.02;
    task.tau = 0.04;
    points = sampleSurface(solid, std::nullopt, {0.02, 3, 10});
    weights.gap = {0.04F, 400.0F};
  }

  ExteriorSolid solid;
  FitTask task;
  std::vector<Vec3d> points;
  ErrorWeights weights;
  DistanceGrid grid{solid, kLooserTau * 0.04, 6000, 1};
};

/// The error as its definition says, with nothing that the search keeps.
double errorOf(const Scene& scene, const std::vector<Candidate>& spheres) {
  double sum = 0;
  for (const Vec3d& point : scene.points) {
    double gap = HUGE_VAL;
    for (const Candidate& sphere : spheres) {
      gap = std::min(gap, norm(point - sphere.center) - scene.task.radii[sphere.radius_index]);
    }
    gap = std::max(gap, 0.0);
    sum += 0.04 * gap + gap * gap + 400 * gap * gap * gap * gap;
  }
  double error = sum * scene.solid.area() / static_cast<double>(scene.points.size());
  for (const Candidate& sphere : spheres) {
    error += protrusionIntegral(scene.grid, sphere.center, scene.task.radii[sphere.radius_index]);
  }
  return error;
}

TEST(ExchangeSearch, KeepsTheErrorThatItsSpheresHave) {
  const Scene scene;
  ExchangeSearch search(scene.task, scene.grid, scene.points, scene.weights);
  double previous = HUGE_VAL;
  for (std::size_t count = 1; count <= 6; ++count) {
    ASSERT_TRUE(search.grow());
    const std::vector<Candidate> spheres = search.spheres();
    ASSERT_EQ(spheres.size(), count);
    // Costs of points are kept in single precision.
    constexpr double kRounding = 1e-5;
    const double error = errorOf(scene, spheres);
    EXPECT_NEAR(search.error(), error, kRounding * error);
    EXPECT_LT(error, previous);
    previous = error;
    for (const Candidate& sphere : spheres) {
      const double radius = scene.task.radii[sphere.radius_index];
      const double outside = scene.solid.distance(sphere.center).distance + radius;
      EXPECT_LE(outside, kLooserTau * scene.task.tau + scene.grid.step());
    }
  }
}

TEST(ExchangeSearch, FindsThreeSpheresAsGoodAsAnyOfRandomTries) {
  constexpr std::uint32_t kSeed = 5;
  std::printf("seed %u\n", kSeed);
  const Scene scene;
  ExchangeSearch search(scene.task, scene.grid, scene.points, scene.weights);
  for (int count = 0; count < 3; ++count) ASSERT_TRUE(search.grow());
  std::mt19937 random(kSeed);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32 - 0.5; };
  double best = HUGE_VAL;
  for (int attempt = 0; attempt < 3000; ++attempt) {
    std::vector<Candidate> spheres;
    while (spheres.size() < 3) {
      const Vec3d center{0.5 * uniform(), 0.1 * uniform(), 0.2 * uniform()};
      const double outside = scene.solid.distance(center).distance + scene.task.radii[1];
      if (outside <= scene.task.tau) spheres.push_back({center, 1, outside});
    }
    best = std::min(best, errorOf(scene, spheres));
  }
  EXPECT_LE(search.error(), best);
}

TEST(ExchangeSearch, SettlingNeverMakesTheErrorLarger) {
  const Scene scene;
  const std::vector<Candidate> spheres{{{0.1, 0, 0}, 1, 0}, {{-0.2, 0.01, 0.03}, 1, 0.01}};
  ExchangeSearch search(scene.task, scene.grid, scene.points, scene.weights, spheres);
  const double before = search.error();
  search.settle(8);
  EXPECT_LT(search.error(), before);
  EXPECT_FALSE(search.grow()) << "there are no candidates";
}

/// Points in clumps, what their gaps cost, and the blocks that an exchange search makes of them.
struct RandomPoints {
  explicit RandomPoints(std::mt19937& random, const GapCost& cost) {
    const auto uniform = [&] { return static_cast<float>(random()) * 0x1p-32F; };
    const std::size_t clumps = 1 + random() % 5;
    for (std::size_t clump = 0; clump < clumps; ++clump) {
      const Vec3 middle{uniform(), uniform(), uniform()};
      constexpr float kSpread = 0.1F;
      constexpr float kWidestNext = 0.3F;
      for (std::size_t lane = 0; lane < kGainLanes; ++lane) {
        x.push_back(middle.x + kSpread * (uniform() - 0.5F));
        y.push_back(middle.y + kSpread * (uniform() - 0.5F));
        z.push_back(middle.z + kSpread * (uniform() - 0.5F));
        const double next_gap = static_cast<double>(kWidestNext * uniform());
        next.push_back(static_cast<float>(costOfGap(cost, next_gap)));
        nearest.push_back(next.back() * uniform());
      }
      blocks.push_back({middle.x, middle.y, middle.z, kSpread + kWidestNext});
    }
  }

  [[nodiscard]] CostedPoints view() const {
    return {x.data(), y.data(), z.data(), nearest.data(), next.data(), blocks.data(), x.size()};
  }

  std::vector<float> x, y, z, nearest, next;
  std::vector<PointBlock> blocks;
};

TEST(GapGain, IsTheSameInAllVersionsAndAsDefined) {
  constexpr std::uint32_t kSeed = 9;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const auto uniform = [&] { return static_cast<float>(random()) * 0x1p-32F; };
  const GapCost cost{0.04F, 400.0F};
  const GapGainOf fastest = fastestGapGain();
  int gains = 0;
  int out_of_reach = 0;
  for (int round = 0; round < 200; ++round) {
    const RandomPoints points(random, cost);
    const Sphere sphere{uniform(), uniform(), uniform(), 0.2F * uniform()};
    const Vec3d center = widen({sphere.x, sphere.y, sphere.z});
    double staying = 0;
    double gone = 0;
    for (std::size_t at = 0; at < points.x.size(); ++at) {
      const double distance = norm(widen({points.x[at], points.y[at], points.z[at]}) - center);
      const double now = costOfGap(cost, distance - static_cast<double>(sphere.radius));
      staying += std::max(0.0, static_cast<double>(points.nearest[at]) - now);
      gone += std::max(0.0, static_cast<double>(points.next[at]) - now);
    }
    for (const PointBlock& block : points.blocks) {
      const double distance = norm(widen({block.x, block.y, block.z}) - center);
      if (distance > static_cast<double>(block.reach + sphere.radius)) ++out_of_reach;
    }
    const GapGain portable = gapGainPortable(points.view(), cost, sphere);
    const GapGain fast = fastest(points.view(), cost, sphere);
    EXPECT_EQ(portable.staying, fast.staying);
    EXPECT_EQ(portable.gone, fast.gone);
    constexpr double kRounding = 1e-4;
    EXPECT_NEAR(static_cast<double>(portable.staying), staying, kRounding);
    EXPECT_NEAR(static_cast<double>(portable.gone), gone, kRounding);
    if (staying > 0) ++gains;
  }
  EXPECT_GT(gains, 20);
  EXPECT_LT(gains, 180);
  EXPECT_GT(out_of_reach, 50);
}

TEST(DistanceGrid, IsNearTheDistanceItself) {
  constexpr std::uint32_t kSeed = 21;
  std::printf("seed %u\n", kSeed);
  const Scene scene;
  std::mt19937 random(kSeed);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32 - 0.5; };
  int inside = 0;
  constexpr int kRounds = 2000;
  for (int round = 0; round < kRounds; ++round) {
    const Vec3d p{0.6 * uniform(), 0.2 * uniform(), 0.3 * uniform()};
    const double exact = scene.solid.distance(p).distance;
    // A distance changes by no more than the way gone, and interpolation by no more than a cell's.
    EXPECT_NEAR(scene.grid.at(p), exact, std::sqrt(3.0) * scene.grid.step());
    if (exact < 0) ++inside;
  }
  EXPECT_GT(inside, kRounds / 10);
  EXPECT_LT(inside, kRounds * 9 / 10);
}

}  // namespace
}  // namespace galactic::bake::sphere_set::exchange_search_test
