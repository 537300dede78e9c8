// What penetrates what, and the ways out: by hand on small grids, and against brute force.
#include "simulation/collision/collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "column_grid/column_grid_kernels.h"
#include "support/homes/box_room.h"
#include "support/oracles/resting_oracle.h"
#include "support/packs/grid_builder.h"
#include "support/sanitized.h"

namespace galactic::test::collision_test {
namespace {

using namespace galactic::simulation;

/// How far beyond the border of a cell a sphere is pushed, and beyond contact with a box.
constexpr float kMargin = 1e-4F;
constexpr float kRounding = 1e-5F;

TEST(BlockedSpheres, AreThoseThatTheirColumnsBlockOfAnyThatAreAskedAbout) {
  constexpr std::uint32_t kSeed = 604;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  const BoxRoom room = furnishedRoom(random, 5);
  // Two groups before those that are asked about.
  constexpr std::size_t kFirst = 2;
  constexpr std::size_t kGroups = 5;
  std::vector<EightSpheres> groups(kFirst + kGroups);
  for (std::size_t n = 0; n < groups.size(); ++n) {
    groups[n] = {.radius_index = static_cast<std::uint32_t>(n % 3), .spheres = 0xff};
  }
  Tally blocked;
  for (int round = 0; round < 500; ++round) {
    std::array<float, kLanes*(kFirst + kGroups)> x;
    std::array<float, kLanes*(kFirst + kGroups)> y;
    std::array<float, kLanes*(kFirst + kGroups)> z;
    std::ranges::generate(x, [&] { return uniformIn(random, -0.2F, 3.2F); });
    std::ranges::generate(y, [&] { return uniformIn(random, 0, 1.4F); });
    std::ranges::generate(z, [&] { return uniformIn(random, -0.2F, 3.2F); });
    // One in two, or in sixteen.
    std::uint64_t asked = (std::uint64_t{random()} << 32U | random()) & 0xff'ffff'ffffU;
    if (round % 2 == 0) asked &= std::uint64_t{random()} << 8U & random() & random();
    std::uint64_t expected = 0;
    for (std::size_t n = 0; n < kLanes * kGroups; ++n) {
      if ((asked >> n & 1U) == 0) continue;
      const std::size_t at = kFirst * kLanes + n;
      const ColumnGrid& grid = room.scene().grids()[groups[at / kLanes].radius_index];
      const bool is_free = grid.clearance({x[at], y[at], z[at]}) == Clearance::kFree;
      expected |= std::uint64_t{is_free ? 0U : 1U} << n;
      blocked.add(!is_free);
    }
    const SphereBatch spheres{x.data(), y.data(), z.data(), {}};
    ASSERT_EQ(blockedSpheres(room.scene(), spheres, groups, kFirst, asked), expected);
  }
  blocked.expectBothSides();
}

TEST(PushSum, GivesTheSameBitsInAnyOrder) {
  std::mt19937 random(601);
  for (int round = 0; round < 200; ++round) {
    std::vector<Push> pushes(1 + random() % 20);
    for (Push& push : pushes) push = {uniformIn(random, -1, 1), uniformIn(random, -1, 1)};
    const auto total = [&] {
      PushSum sum;
      for (const Push& push : pushes) sum.add(push);
      return sum.total(0.5F);
    };
    const Push first = total();
    for (int order = 0; order < 10; ++order) {
      for (std::size_t n = pushes.size() - 1; n > 0; --n) {
        std::swap(pushes[n], pushes[random() % (n + 1)]);
      }
      ASSERT_EQ(total().x, first.x);
      ASSERT_EQ(total().z, first.z);
    }
  }
}

TEST(PushSum, TakesTheLargestInEachDirectionOnceAndOppositesAgainstEachOther) {
  PushSum sum;
  EXPECT_EQ(sum.total(1).x, 0);
  EXPECT_EQ(sum.total(1).z, 0);
  sum.add({0.25F, 0});
  sum.add({0.125F, 0});
  sum.add({0.25F, -0.0625F});
  EXPECT_EQ(sum.total(1).x, 0.25F);
  EXPECT_EQ(sum.total(1).z, -0.0625F);
  sum.add({-0.25F, 0});
  EXPECT_EQ(sum.total(1).x, 0);
  EXPECT_EQ(sum.total(1).z, -0.0625F);
}

TEST(PushSum, IsNoLongerThanAllowedAndKeepsItsDirection) {
  PushSum sum;
  sum.add({3, 0});
  sum.add({0, -4});
  EXPECT_FLOAT_EQ(sum.total(0.5F).x, 0.3F);
  EXPECT_FLOAT_EQ(sum.total(0.5F).z, -0.4F);
  EXPECT_FLOAT_EQ(sum.total(5).x, 3);
  EXPECT_EQ(sum.total(0).x, 0);
}

void expectPush(const Push& push, float x, float z) {
  EXPECT_NEAR(push.x, x, kRounding);
  EXPECT_NEAR(push.z, z, kRounding);
}

/// One meter long in x, two in z.
RestingBox block() { return restingBox({{}, {0.5F, 0.5F, 1}}, {{2, 1, 3}, {}}); }

TEST(PushOutOfBox, PushesASphereOutOfTheNearestSide) {
  expectPush(pushOutOfBox(block(), {2.55F, 1, 3}, 0.12F), 0.07F + kMargin, 0);
  expectPush(pushOutOfBox(block(), {1.45F, 1.25F, 2.75F}, 0.12F), -0.07F - kMargin, 0);
  expectPush(pushOutOfBox(block(), {2, 1, 4.0625F}, 0.125F), 0, 0.0625F + kMargin);
}

TEST(PushOutOfBox, PushesASphereOverAnEdgeAsFarAsTheEdgeReaches) {
  // 3 cm above and 3 cm aside of the edge: free where it is 4 cm aside.
  expectPush(pushOutOfBox(block(), {2.53F, 1.53F, 3}, 0.05F), 0.01F + kMargin, 0);
  // Aside of a vertical edge: along the diagonal.
  const float aside = 0.03F;
  const float out = (0.05F - std::sqrt(2.0F) * aside + kMargin) / std::sqrt(2.0F);
  expectPush(pushOutOfBox(block(), {2.5F + aside, 1, 4 + aside}, 0.05F), out, out);
}

TEST(PushOutOfBox, PushesACenterInsideOrAboveAwayFromTheMiddle) {
  expectPush(pushOutOfBox(block(), {2.25F, 1, 3}, 0.12F), 0.12F, 0);
  expectPush(pushOutOfBox(block(), {2, 1.55F, 2.5F}, 0.12F), 0, -0.12F);
  // Exactly in the middle any direction will do.
  const Push push = pushOutOfBox(block(), {2, 1, 3}, 0.12F);
  EXPECT_FLOAT_EQ(std::hypot(push.x, push.z), 0.12F);
}

TEST(PushOutOfBox, FreesEverySphereWhoseCenterIsAsideOfAnUprightBox) {
  std::mt19937 random(603);
  int freed = 0;
  for (int round = 0; round < 20000; ++round) {
    Body body = randomBody({}, random);
    body.box.pose.rotation = {};
    body.pose.rotation = yaw(6.28 * uniform(random));
    const Point3 near = body.solid().at(
        {uniform(random) * 2.4 - 1.2, uniform(random) * 2.4 - 1.2, uniform(random) * 2.4 - 1.2});
    const Vec3 center{static_cast<float>(near[0]), static_cast<float>(near[1]),
                      static_cast<float>(near[2])};
    const RestingBox box = body.resting();
    const Vec3 normal = center - nearestPoint(box, center);
    if (!overlaps(box, center, 0.05F) || std::hypot(normal.x, normal.z) < 1e-4F) continue;
    const Push push = pushOutOfBox(box, center, 0.05F);
    ASSERT_FALSE(overlaps(box, {center.x + push.x, center.y, center.z + push.z}, 0.05F));
    ASSERT_LE(std::hypot(push.x, push.z), 0.05F + 2 * kMargin);
    ++freed;
  }
  EXPECT_GT(freed, 2000);
}

/// Random furniture with things on it.
struct Flat {
  BoxRoom room;
  std::vector<Body> bodies;
  RestingObjects objects;

  explicit Flat(std::mt19937& random) : room(furniture(random)), objects(20, 0.12F) {
    const Room within{.x = {0, 3}, .z = {0, 3}};
    bodies.reserve(objects.capacity());
    for (std::uint32_t n = 0; n < objects.capacity(); ++n) {
      bodies.push_back(randomBody(within, random));
      objects.insert(n, bodies.back().resting());
    }
  }

  static std::vector<Block> furniture(std::mt19937& random) {
    std::vector<Block> blocks{{{0, -0.25F, 0}, {3, 0, 3}}};
    for (int n = 0; n < 5; ++n) {
      const Vec3 min{uniformIn(random, 0, 2.5F), uniformIn(random, 0, 1), uniformIn(random, 0, 2)};
      blocks.push_back({min, min + Vec3{0.5F, uniformIn(random, 0.05F, 1), 0.75F}});
    }
    return blocks;
  }

  [[nodiscard]] bool isTaken(const Point3& center, double radius) const {
    return room.isBlocked(center, radius) ||
           std::any_of(bodies.begin(), bodies.end(),
                       [&](const Body& body) { return body.solid().distance(center) < radius; });
  }

  /// Whether a sphere penetrates anything, by brute force; none when rounding decides.
  [[nodiscard]] std::optional<bool> isTaken(const Vec3& center, float radius) const {
    // Grids round heights inwards to 0.06 mm.
    constexpr double kTie = 1e-4;
    const Point3 at = toPoint3(center);
    const bool taken = isTaken(at, static_cast<double>(radius));
    for (const std::size_t axis : {0U, 1U, 2U}) {
      for (const double by : {-kTie, kTie}) {
        Point3 aside = at;
        aside[axis] += by;
        if (isTaken(aside, static_cast<double>(radius)) != taken) return std::nullopt;
      }
    }
    return taken;
  }
};

struct Spheres {
  OwnedBatch batch;
  /// Of each element of the batch, padding included.
  std::vector<std::optional<bool>> taken;
  std::size_t count = 0;
  std::size_t taken_count = 0;
  bool has_ties = false;
};

Spheres randomSpheres(const Flat& flat, std::mt19937& random) {
  Spheres spheres;
  for (std::uint32_t r = 0; r < BoxRoom::kRadii.size(); ++r) {
    if (random() % 3 == 0) continue;
    std::vector<Vec3> centers(1 + random() % 10);
    for (Vec3& center : centers) {
      const bool outside = random() % 50 == 0;
      center = {outside ? 3.25F : uniformIn(random, 0.05F, 2.95F), uniformIn(random, 0.13F, 2),
                uniformIn(random, 0.05F, 2.95F)};
      const auto taken = flat.isTaken(center, BoxRoom::kRadii[r]);
      spheres.has_ties = spheres.has_ties || !taken;
      spheres.taken_count += taken.value_or(false) ? 1U : 0U;
      spheres.taken.push_back(taken);
    }
    spheres.count += centers.size();
    spheres.batch.add(r, BoxRoom::kRadii[r], centers);
    spheres.taken.resize(paddedToLanes(spheres.taken.size()), false);
  }
  return spheres;
}

bool bitOf(const std::vector<std::uint64_t>& bits, std::size_t n) {
  return (bits[n / 64] >> (n % 64) & 1U) != 0;
}

TEST(Penetration, IsWhatBruteForceFinds) {
  constexpr std::uint32_t kSeed = 604;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally all;
  Tally each;
  CollisionScratch scratch(48);
  for (int round = 0; round < (kIsSanitized ? 3 : 15); ++round) {
    const Flat flat(random);
    const Obstacles obstacles{flat.room.scene(), flat.objects};
    for (int n = 0; n < 200; ++n) {
      const Spheres spheres = randomSpheres(flat, random);
      if (spheres.has_ties || spheres.taken.empty()) continue;
      const SphereBatch batch = spheres.batch.view();
      ASSERT_EQ(penetrates(obstacles, batch), spheres.taken_count > 0);
      all.add(spheres.taken_count > 0);
      std::vector<std::uint64_t> bits(2, ~std::uint64_t{0});
      penetrating(obstacles, batch, scratch, bits);
      for (std::size_t sphere = 0; sphere < spheres.taken.size(); ++sphere) {
        ASSERT_EQ(bitOf(bits, sphere), *spheres.taken[sphere]) << "sphere " << sphere;
      }
      each.yes += spheres.taken_count;
      each.no += spheres.count - spheres.taken_count;
    }
  }
  all.expectBothSides();
  each.expectBothSides();
}

TEST(Penetration, OfAPlaceThatTheGridDoesNotKnowIsAssumed) {
  const BoxRoom room({});
  const RestingObjects none(1, 0.12F);
  const Obstacles obstacles{room.scene(), none};
  const auto taken = [&](const Vec3& center) {
    OwnedBatch batch;
    batch.add(1, 0.05F, {center});
    return penetrates(obstacles, batch.view());
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(taken({1, 1, 1}));
  EXPECT_TRUE(taken({-0.01F, 1, 1}));
  EXPECT_TRUE(taken({1, 1, 3.01F}));
  EXPECT_TRUE(taken({1, 3.5F, 1}));
  EXPECT_TRUE(taken({kNan, 1, 1}));
  EXPECT_TRUE(taken({1, kNan, 1}));
  EXPECT_TRUE(taken({1, 1, kInfinity}));
}

TEST(Penetration, PushesAddUpTheSameForSpheresInAnyOrder) {
  std::mt19937 random(605);
  CollisionScratch scratch(48);
  int pushed = 0;
  for (int round = 0; round < 10; ++round) {
    const Flat flat(random);
    for (int n = 0; n < 100; ++n) {
      std::vector<Vec3> centers(12);
      for (Vec3& center : centers) {
        center = {uniformIn(random, 0.5F, 2.5F), uniformIn(random, 0.13F, 1.5F),
                  uniformIn(random, 0.5F, 2.5F)};
      }
      const auto total = [&] {
        OwnedBatch batch;
        batch.add(1, 0.05F, centers);
        PushSum sum;
        pushOutOfObjects(flat.objects, batch.view(), {}, scratch, sum);
        return sum.total(0.1F);
      };
      const Push first = total();
      std::reverse(centers.begin(), centers.end());
      std::swap(centers[2], centers[7]);
      ASSERT_EQ(total().x, first.x);
      ASSERT_EQ(total().z, first.z);
      pushed += first.x != 0 || first.z != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(pushed, 150);
}

}  // namespace
}  // namespace galactic::test::collision_test
