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

TEST(GapGain, IsTheSameInAllVersionsAndAsDefined) {
  constexpr std::uint32_t kSeed = 9;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const auto uniform = [&] { return static_cast<float>(random()) * 0x1p-32F; };
  const GapCost cost{0.04F, 400.0F};
  const GapGainOf fastest = fastestGapGain();
  int gains = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<std::vector<float>> columns(5);
    const std::size_t count = kGainLanes * (1 + random() % 5);
    for (std::size_t at = 0; at < count; ++at) {
      for (std::size_t n = 0; n < 3; ++n) columns[n].push_back(uniform());
      columns[3].push_back(0.3F * uniform());
      columns[4].push_back(columns[3].back() + 0.3F * uniform());
    }
    const CostedPoints points{columns[0].data(), columns[1].data(), columns[2].data(),
                              columns[3].data(), columns[4].data(), count};
    const Sphere sphere{uniform(), uniform(), uniform(), 0.2F * uniform()};
    double staying = 0;
    double gone = 0;
    for (std::size_t at = 0; at < count; ++at) {
      const Vec3d p = widen({columns[0][at], columns[1][at], columns[2][at]});
      const double distance = norm(p - widen({sphere.x, sphere.y, sphere.z}));
      const double now = costOfGap(cost, distance - static_cast<double>(sphere.radius));
      staying += std::max(0.0, static_cast<double>(columns[3][at]) - now);
      gone += std::max(0.0, static_cast<double>(columns[4][at]) - now);
    }
    const GapGain portable = gapGainPortable(points, cost, sphere);
    const GapGain fast = fastest(points, cost, sphere);
    EXPECT_EQ(portable.staying, fast.staying);
    EXPECT_EQ(portable.gone, fast.gone);
    constexpr double kRounding = 1e-4;
    EXPECT_NEAR(static_cast<double>(portable.staying), staying, kRounding);
    EXPECT_NEAR(static_cast<double>(portable.gone), gone, kRounding);
    if (staying > 0) ++gains;
  }
  EXPECT_GT(gains, 20);
  EXPECT_LT(gains, 180);
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
