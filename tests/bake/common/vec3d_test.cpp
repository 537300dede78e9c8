#include "common/vec3d.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace galactic::test::vec3d_test {
namespace {

using bake::Vec3d;

constexpr unsigned kSeed = 20250611;

/// No direction is far from all of them, nor are two of them close to each other: measured by the
/// edge of a square of the sphere's share of each.
TEST(EvenDirections, LieAsFarFromEachOtherAsFromWhatIsBetweenThem) {
  constexpr std::size_t kCount = 300;
  const double edge = std::sqrt(4 * std::numbers::pi / static_cast<double>(kCount));
  std::vector<Vec3d> directions;
  for (std::size_t n = 0; n < kCount; ++n) {
    directions.push_back(bake::evenDirection(n, kCount));
    EXPECT_NEAR(norm(directions.back()), 1, 1e-12);
  }
  const auto nearest = [&](const Vec3d& to, std::size_t but) {
    double least = HUGE_VAL;
    for (std::size_t n = 0; n < kCount; ++n) {
      if (n != but) least = std::min(least, norm(directions[n] - to));
    }
    return least;
  };
  for (std::size_t n = 0; n < kCount; ++n) EXPECT_GT(nearest(directions[n], n), 0.7 * edge) << n;
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 1000; ++n) {
    const Vec3d to = bake::normalized({normal(random), normal(random), normal(random)});
    EXPECT_LT(nearest(to, kCount), 0.9 * edge) << "seed " << kSeed;
  }
}

TEST(EvenDirections, OfOneIsOne) { EXPECT_NEAR(norm(bake::evenDirection(0, 1)), 1, 1e-12); }

}  // namespace
}  // namespace galactic::test::vec3d_test
