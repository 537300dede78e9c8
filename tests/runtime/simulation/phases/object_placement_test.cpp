// Released objects: small cases by hand, and a brute-force settle in double precision that lowers
// the object in steps of a tenth of a millimeter.
#include "simulation/phases/object_placement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "support/homes/box_room.h"
#include "support/oracles/resting_oracle.h"
#include "support/sanitized.h"

namespace galactic::test::object_placement_test {
namespace {

using simulation::HeldSpheres;
using simulation::holdSpheres;
using simulation::Landing;
using simulation::PlacementScratch;
using simulation::placeObject;
using simulation::RadiusRange;
using simulation::restingBox;
using simulation::RestingObjects;
using simulation::SphereBatch;

/// Grids round heights to 0.06 mm; floats of a few meters are a micrometer apart.
constexpr float kHeightTolerance = 1e-4F;
constexpr float kClearance = 0.001F;

/// An object that owns its spheres.
struct TestObject {
  OrientedBox box;
  std::vector<SetSphere> spheres;

  [[nodiscard]] ObjectModel model() const {
    return {.name = "thing", .box = box, .spheres = spheres, .stable_poses = {}};
  }
};

/// A ball of 5 cm in a box that just holds it.
TestObject ball() { return {{{}, {0.05F, 0.05F, 0.05F}}, {{{0, 0, 0}, 1}}}; }

/// A box of the given size full of spheres of 5 cm at its ends and 1.5 cm at its corners.
TestObject brick(const Vec3& half) {
  TestObject object{{{}, half}, {}};
  const auto corners = [&](std::uint32_t radius_index) {
    const float radius = BoxRoom::kRadii[radius_index];
    for (unsigned corner = 0; corner < 8; ++corner) {
      const auto at = [&](unsigned bit, float size) {
        const float inside = std::max(size - radius, 0.0F);
        return ((corner >> bit) & 1U) != 0 ? inside : -inside;
      };
      object.spheres.push_back({{at(0, half.x), at(1, half.y), at(2, half.z)}, radius_index});
    }
  };
  corners(1);
  corners(0);
  return object;
}

/// A room of 3 x 3 m: a floor, a table, a wall near one side, and two shelf boards.
std::vector<Block> furniture() {
  return {{{0, -0.25F, 0}, {3, 0, 3}},
          {{1, 0.65F, 1}, {2, 0.7F, 2}},
          {{2.6875F, 0, 0}, {2.75F, 3, 3}},
          {{0, 1, 0}, {0.75F, 1.02F, 0.5F}},
          {{0, 1.25F, 0}, {0.75F, 1.27F, 0.5F}}};
}

/// What a placement needs.
class Home {
 public:
  explicit Home(std::vector<Block> blocks, std::size_t most_objects = 40)
      : objects(most_objects, BoxRoom::kRadii.back()),
        room_(std::move(blocks)),
        scratch_(64, BoxRoom::kRadii) {}

  Landing place(const TestObject& object, const Pose& released, std::uint64_t seed = 1) {
    RandomStream random(seed, 0, 0, 0);
    return placeObject({room_.scene(), objects}, object.model(), released, random, options,
                       scratch_);
  }
  Landing placeAt(const TestObject& object, const Vec3& released) {
    return place(object, Pose{released, {}});
  }

  [[nodiscard]] const BoxRoom& room() const { return room_; }

  RestingObjects objects;
  PlacementOptions options;

 private:
  BoxRoom room_;
  PlacementScratch scratch_;
};

void expectLanded(const Landing& landing, const Vec3& at) {
  EXPECT_TRUE(landing.placed);
  EXPECT_EQ(landing.attempts, 1U);
  EXPECT_EQ(landing.pose.translation.x, at.x);
  EXPECT_NEAR(landing.pose.translation.y, at.y, kHeightTolerance);
  EXPECT_EQ(landing.pose.translation.z, at.z);
}

TEST(ObjectPlacement, LowersToTheFloorAndTheTable) {
  Home home(furniture());
  expectLanded(home.placeAt(ball(), {0.5F, 0.9F, 2.5F}), {0.5F, 0.05F + kClearance, 2.5F});
  expectLanded(home.placeAt(ball(), {1.5F, 1.5F, 1.5F}), {1.5F, 0.75F + kClearance, 1.5F});
  expectLanded(home.placeAt(ball(), {1.5F, 0.5F, 1.5F}), {1.5F, 0.05F + kClearance, 1.5F});
}

TEST(ObjectPlacement, KeepsTheRotationOfTheRelease) {
  Home home(furniture());
  const Pose released{{1.5F, 1, 1.5F}, yaw(0.7)};
  const Landing landing = home.place(brick({0.1F, 0.06F, 0.08F}), released);
  EXPECT_TRUE(landing.placed);
  EXPECT_EQ(landing.pose.rotation, released.rotation);
}

TEST(ObjectPlacement, LiftsOutOfTheTableAsFarAsAllowed) {
  Home home(furniture());
  // 4 cm deep in the table's top; 6 cm.
  expectLanded(home.placeAt(ball(), {1.5F, 0.71F, 1.5F}), {1.5F, 0.75F + kClearance, 1.5F});
  const Pose deep{{1.5F, 0.69F, 1.5F}, {}};
  const Landing landing = home.place(ball(), deep);
  EXPECT_FALSE(landing.placed) << "the path of a jitter begins inside the table";
  EXPECT_EQ(landing.attempts, home.options.attempts);
  EXPECT_EQ(landing.pose, deep);
}

TEST(ObjectPlacement, StaysBetweenShelfBoards) {
  Home home(furniture());
  expectLanded(home.placeAt(ball(), {0.375F, 1.15F, 0.25F}), {0.375F, 1.07F + kClearance, 0.25F});
  expectLanded(home.placeAt(ball(), {0.375F, 1.05F, 0.25F}), {0.375F, 1.07F + kClearance, 0.25F});
  // 23 cm between the boards: one of 22.8 cm fits, one of 23.2 cm does not.
  home.options.attempts = 1;
  EXPECT_TRUE(home.placeAt(brick({0.05F, 0.114F, 0.05F}), {0.375F, 1.13F, 0.25F}).placed);
  EXPECT_FALSE(home.placeAt(brick({0.05F, 0.116F, 0.05F}), {0.375F, 1.13F, 0.25F}).placed);
}

TEST(ObjectPlacement, StacksOnRestingObjects) {
  Home home(furniture());
  const TestObject object = ball();
  float height = 0.75F + kClearance;
  for (std::uint32_t n = 0; n < 5; ++n) {
    const Landing landing = home.placeAt(object, {1.5F, 1.5F, 1.5F});
    expectLanded(landing, {1.5F, height, 1.5F});
    home.objects.insert(n, restingBox(object.box, landing.pose));
    height += 0.1F + kClearance;
  }
}

TEST(ObjectPlacement, PutsABoxOnABoxWhoseSpheresDoNotReachItsFaces) {
  Home home(furniture());
  // Spheres end 2 cm above the bottom: on the table they decide, on another box the boxes do.
  TestObject object{{{}, {0.07F, 0.07F, 0.07F}}, {{{0, 0, 0}, 1}}};
  const Landing first = home.placeAt(object, {1.5F, 1.5F, 1.5F});
  expectLanded(first, {1.5F, 0.75F + kClearance, 1.5F});
  home.objects.insert(0, restingBox(object.box, first.pose));
  const Landing second = home.placeAt(object, {1.5F, 1.5F, 1.5F});
  EXPECT_TRUE(second.placed);
  const float gap = second.pose.translation.y - first.pose.translation.y - 0.14F;
  EXPECT_NEAR(gap, 0, kHeightTolerance);
}

TEST(ObjectPlacement, HangsOverTheEdgeOfATable) {
  Home home(furniture());
  // Column centers lie at odd multiples of half a spacing: 2.015625, 1.5625 cm beyond the edge.
  const float beyond = 0.015625F;
  const float height = 0.7F + std::sqrt(0.0025F - beyond * beyond) + kClearance;
  expectLanded(home.placeAt(ball(), {2 + beyond, 1, 1.5F}), {2 + beyond, height, 1.5F});
  expectLanded(home.placeAt(ball(), {2.078125F, 1, 1.5F}), {2.078125F, 0.05F + kClearance, 1.5F});
}

TEST(ObjectPlacement, NeedsSomethingToLandOn) {
  Home home(std::vector<Block>{{{0, -0.25F, 0}, {1.5F, 0, 3}}});
  home.options.attempts = 1;
  EXPECT_TRUE(home.placeAt(ball(), {1.4F, 1, 1}).placed);
  EXPECT_FALSE(home.placeAt(ball(), {2.5F, 1, 1}).placed);
  home.options.attempts = 6;
  for (const Vec3 outside : {Vec3{-1, 1, 1}, {1, 1, 7}, {1, 9, 1}, {1, -2, 1}}) {
    const Landing landing = home.placeAt(ball(), outside);
    EXPECT_FALSE(landing.placed);
    EXPECT_EQ(landing.attempts, 6U);
    EXPECT_EQ(landing.pose.translation, outside);
  }
  EXPECT_FALSE(home.placeAt(ball(), {std::nanf(""), 1, 1}).placed);
  EXPECT_FALSE(home.placeAt(ball(), {1, std::nanf(""), 1}).placed);
}

TEST(ObjectPlacement, JittersAwayFromTheObjectThatIsHit) {
  Home home(std::vector<Block>{{{0, -0.25F, 0}, {3, 0, 3}}});
  const TestObject tall{{{}, {0.05F, 0.3F, 0.05F}}, {}};
  home.objects.insert(0, restingBox(tall.box, {{1.5F, 0.3F, 1.5F}, {}}));
  const Vec3 released{1.55F, 0.3F, 1.5F};
  std::size_t turned_left = 0;
  constexpr std::uint64_t kSeeds = 200;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Landing landing = home.place(ball(), {released, {}}, seed);
    ASSERT_TRUE(landing.placed);
    ASSERT_GE(landing.attempts, 2U);
    const Vec3 way = landing.pose.translation - released;
    const float length = std::sqrt(way.x * way.x + way.z * way.z);
    const float diagonal = 2 * std::sqrt(3.0F) * 0.05F;
    if (landing.attempts > 2) continue;
    EXPECT_GE(length, 0.5F * diagonal - 1e-5F);
    EXPECT_LE(length, diagonal + 1e-5F);
    EXPECT_GE(way.x / length, std::cos(home.options.direction_spread) - 1e-4F);
    turned_left += way.z > 0 ? 1U : 0U;
  }
  EXPECT_GT(turned_left, kSeeds / 10);
  EXPECT_LT(turned_left, kSeeds * 9 / 10);
}

TEST(ObjectPlacement, GetsOutOfAWallAndNeverThroughIt) {
  Home home(furniture());
  // Larger than the way to the other side, and 2 cm in the wall.
  const TestObject object = brick({0.1F, 0.1F, 0.1F});
  std::size_t placed = 0;
  std::size_t at_once = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Landing landing = home.place(object, {{2.6F, 0.5F, 1.5F}, {}}, seed);
    if (!landing.placed) continue;
    ++placed;
    EXPECT_LT(landing.pose.translation.x, 2.6F);
    EXPECT_GT(landing.attempts, 1U);
    if (landing.attempts > 2) continue;
    // The first jitter leads straight out of the wall, but for the spread.
    ++at_once;
    const Vec3 way = landing.pose.translation - Vec3{2.6F, landing.pose.translation.y, 1.5F};
    const float cosine = -way.x / std::sqrt(dot(way, way));
    EXPECT_GE(cosine, std::cos(home.options.direction_spread) - 1e-4F);
  }
  EXPECT_GT(at_once, 100U);
  EXPECT_GT(placed, 180U) << "the way out of the wall is open";
}

TEST(ObjectPlacement, GivesUpWhereEverythingIsBlocked) {
  // A pit that the object fits in exactly, full of another object.
  Home home(std::vector<Block>{{{0, -0.25F, 0}, {3, 0, 3}},
                               {{1.3125F, 0, 1.3125F}, {1.375F, 2, 1.6875F}},
                               {{1.625F, 0, 1.3125F}, {1.6875F, 2, 1.6875F}},
                               {{1.3125F, 0, 1.3125F}, {1.6875F, 2, 1.375F}},
                               {{1.3125F, 0, 1.625F}, {1.6875F, 2, 1.6875F}}});
  const Pose released{{1.5F, 0.3F, 1.5F}, {}};
  EXPECT_TRUE(home.place(ball(), released).placed);
  home.objects.insert(0, restingBox({{}, {0.1F, 0.8F, 0.1F}}, {{1.5F, 0.81F, 1.5F}, {}}));
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Landing landing = home.place(ball(), released, seed);
    EXPECT_FALSE(landing.placed);
    EXPECT_EQ(landing.pose, released);
    EXPECT_EQ(landing.attempts, home.options.attempts);
  }
}

TEST(ObjectPlacement, TouchingNeighborsDoNotBlockEachOther) {
  Home home(furniture());
  home.options.attempts = 1;
  const TestObject object{{{}, {0.06F, 0.06F, 0.06F}}, {{{0, 0, 0}, 1}}};
  home.objects.insert(0, restingBox(object.box, {{1.5F, 0.76F, 1.5F}, {}}));
  EXPECT_TRUE(home.placeAt(object, {1.6195F, 0.761F, 1.5F}).placed) << "0.5 mm overlap";
  EXPECT_FALSE(home.placeAt(object, {1.6165F, 0.761F, 1.5F}).placed) << "3.5 mm overlap";
}

/// Lowers and lifts in small steps, and asks distances only.
class BruteForce {
 public:
  BruteForce(const Home& home, const TestObject& object, const std::vector<Body>& bodies)
      : home_(home), object_(object) {
    solids_.reserve(bodies.size());
    for (const Body& body : bodies) solids_.push_back(body.solid());
  }

  /// Height over the release at which the object rests; none when it finds no place there.
  /// `margin` is kept from everything.
  [[nodiscard]] std::optional<double> settle(const Pose& released, double most_lift,
                                             double margin) const {
    constexpr double kStep = 1e-4;
    double height = 0;
    while (!isFree(released, height, margin)) {
      height += kStep;
      if (height > most_lift) return std::nullopt;
    }
    while (isFree(released, height - kStep, margin)) {
      height -= kStep;
      if (static_cast<double>(released.translation.y) + height < -0.5) return std::nullopt;
    }
    height += static_cast<double>(kClearance);
    return isFree(released, height, margin) ? std::optional(height) : std::nullopt;
  }

 private:
  [[nodiscard]] bool isFree(const Pose& released, double height, double margin) const {
    for (const SetSphere& sphere : object_.spheres) {
      const auto radius = static_cast<double>(BoxRoom::kRadii[sphere.radius_index]);
      Point3 center = toPoint3(released * sphere.center);
      center[1] += height;
      if (home_.room().isBlocked(center, radius + margin)) return false;
      for (const BoxSolid& solid : solids_) {
        if (solid.distance(center) < radius + margin) return false;
      }
    }
    OrientedBox shrunk = object_.box;
    const float less = kClearance - static_cast<float>(margin);
    shrunk.half_extents = shrunk.half_extents - Vec3{less, less, less};
    BoxSolid own(shrunk, released);
    own.shiftUp(height);
    for (const BoxSolid& solid : solids_) {
      if (boxesOverlap(own, solid)) return false;
    }
    return true;
  }

  const Home& home_;
  const TestObject& object_;
  std::vector<BoxSolid> solids_;
};

TEST(ObjectPlacement, RestsWhereBruteForceSettles) {
  // With a little more or less room around everything the outcome must be the same, or the case is
  // one of rounding.
  constexpr double kMargin = 1e-4;
  constexpr double kTolerance = 4e-4;
  std::mt19937 random(421);
  Home home(furniture());
  home.options.attempts = 1;
  Tally placed;
  std::size_t on_objects = 0;
  std::size_t rounding = 0;
  // Sanitizers make brute force thirty times slower, and find what they look for in a few cases.
  constexpr int kCases = kIsSanitized ? 20 : 200;
  for (int n = 0; n < kCases; ++n) {
    home.objects.clear();
    std::vector<Body> bodies;
    for (std::uint32_t body = 0; body < 6; ++body) {
      bodies.push_back(randomBody({.x = {1, 2}, .z = {1, 2}, .least = 0.04F}, random));
      bodies.back().pose.translation.y = uniformIn(random, 0.6F, 0.9F);
      home.objects.insert(body, bodies.back().resting());
    }
    const TestObject object = brick({uniformIn(random, 0.05F, 0.1F), uniformIn(random, 0.05F, 0.1F),
                                     uniformIn(random, 0.05F, 0.1F)});
    Pose released;
    released.translation.x = uniformIn(random, 0.9F, 2.1F);
    released.translation.y = uniformIn(random, 0.7F, 1.2F);
    released.translation.z = uniformIn(random, 0.9F, 2.1F);
    released.rotation = random() % 2 == 0 ? yaw(6.28 * uniform(random)) : randomQuat(random);
    const BruteForce brute(home, object, bodies);
    const auto most_lift = static_cast<double>(home.options.most_lift);
    const std::optional<double> expected = brute.settle(released, most_lift, 0);
    const std::optional<double> tight = brute.settle(released, most_lift - 3e-4, kMargin);
    const std::optional<double> loose = brute.settle(released, most_lift + 3e-4, -kMargin);
    const bool is_rounding = tight.has_value() != loose.has_value() ||
                             (tight && std::abs(*tight - *loose) > 3 * kTolerance);
    if (is_rounding) {
      ++rounding;
      continue;
    }
    const Landing landing = home.place(object, released);
    ASSERT_EQ(landing.placed, expected.has_value()) << n;
    placed.add(landing.placed);
    if (!landing.placed) continue;
    const double height = static_cast<double>(landing.pose.translation.y) -
                          static_cast<double>(released.translation.y);
    ASSERT_NEAR(height, *expected, kTolerance) << n;
    on_objects += landing.pose.translation.y > 0.85F ? 1U : 0U;
  }
  placed.expectBothSides();
  EXPECT_GT(on_objects, kCases / 10U);
  EXPECT_LT(rounding, kCases / 10U);
}

TEST(ObjectPlacement, LeavesNothingPenetratedWhereverItPlaces) {
  std::mt19937 random(422);
  Home home(furniture());
  Tally placed;
  Tally jittered;
  for (int round = 0; round < 60; ++round) {
    home.objects.clear();
    for (std::uint32_t index = 0; index < 30; ++index) {
      const TestObject object =
          brick({uniformIn(random, 0.05F, 0.12F), uniformIn(random, 0.05F, 0.12F),
                 uniformIn(random, 0.05F, 0.12F)});
      Pose released;
      released.translation.x = uniformIn(random, -0.2F, 3.2F);
      released.translation.y = uniformIn(random, -0.2F, 1.5F);
      released.translation.z = uniformIn(random, -0.2F, 3.2F);
      released.rotation = randomQuat(random);
      const Landing landing = home.place(object, released, random());
      placed.add(landing.placed);
      if (!landing.placed) continue;
      jittered.add(landing.attempts > 1);
      HeldSpheres room(64, BoxRoom::kRadii);
      const SphereBatch batch = holdSpheres(object.model(), landing.pose, room);
      EXPECT_FALSE(home.objects.touches(batch));
      for (const RadiusRange& range : batch.ranges) {
        const ColumnGrid& grid = home.room().scene().grids()[range.radius_index];
        for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
          EXPECT_EQ(grid.clearance({batch.x[n], batch.y[n], batch.z[n]}), Clearance::kFree);
        }
      }
      home.objects.insert(index, restingBox(object.box, landing.pose));
    }
  }
  placed.expectBothSides();
  EXPECT_GE(10 * jittered.yes, jittered.no) << jittered.yes;
}

TEST(ObjectPlacement, DependsOnTheStreamAndNotOnTheOrderOfSpheres) {
  std::mt19937 random(423);
  Home home(furniture());
  for (std::uint32_t index = 0; index < 12; ++index) {
    Body body = randomBody({.x = {1, 2}, .z = {1, 2}, .least = 0.05F}, random);
    body.pose.translation.y = uniformIn(random, 0.6F, 0.8F);
    home.objects.insert(index, body.resting());
  }
  Tally jittered;
  std::size_t differing = 0;
  for (std::uint64_t n = 0; n < 300; ++n) {
    const TestObject object = brick({0.08F, 0.06F, 0.1F});
    TestObject shuffled = object;
    std::reverse(shuffled.spheres.begin(), shuffled.spheres.begin() + 8);
    std::rotate(shuffled.spheres.begin() + 8, shuffled.spheres.begin() + 11,
                shuffled.spheres.end());
    Pose released{{}, randomQuat(random)};
    released.translation.x = uniformIn(random, 0.95F, 2.05F);
    released.translation.y = uniformIn(random, 0.72F, 0.95F);
    released.translation.z = uniformIn(random, 0.95F, 2.05F);
    const Landing first = home.place(object, released, n);
    const Landing again = home.place(object, released, n);
    const Landing reordered = home.place(shuffled, released, n);
    const Landing other = home.place(object, released, n + 1000);
    EXPECT_EQ(first.pose, again.pose);
    EXPECT_EQ(first.attempts, again.attempts);
    EXPECT_EQ(first.pose, reordered.pose);
    EXPECT_EQ(first.attempts, reordered.attempts);
    jittered.add(first.attempts > 1);
    differing += first.pose != other.pose ? 1U : 0U;
  }
  jittered.expectBothSides();
  EXPECT_GT(differing, 20U);
}

}  // namespace
}  // namespace galactic::test::object_placement_test
