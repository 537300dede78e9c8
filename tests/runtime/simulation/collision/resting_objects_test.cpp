// The query of packed bounds against all pairs in double precision, its bookkeeping against a
// model, and its two kernels against each other.
#include "simulation/collision/resting_objects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "support/homes/resting_bodies.h"
#include "support/homes/resting_robot.h"
#include "support/oracles/resting_oracle.h"
#include "support/processor.h"

namespace galactic::test::resting_objects_test {
namespace {

using simulation::avx2Resting;
using simulation::kBandHeight;
using simulation::kBands;
using simulation::kByteCells;
using simulation::kCellEdge;
using simulation::kLanes;
using simulation::LaneGroup;
using simulation::overlaps;
using simulation::portableResting;
using simulation::RadiusRange;
using simulation::RestingBox;
using simulation::RestingKernels;
using simulation::RestingObjects;
using simulation::RestingView;
using simulation::SphereBatch;
using simulation::SphereHit;
using testing::ElementsAre;

/// One to twenty spheres of each radius.
OwnedBatch randomBatch(const std::vector<Body>& bodies, const Room& room, std::mt19937& random) {
  OwnedBatch batch;
  for (std::uint32_t r = 0; r < std::size(kRadii); ++r) {
    std::vector<Vec3> centers(1 + random() % 20);
    for (Vec3& center : centers) center = randomCenter(bodies, room, random);
    batch.add(r, kRadii[r], centers);
  }
  return batch;
}

/// `hits` against the distances of all spheres to all boxes.
void compareWithAllPairs(const RestingObjects& objects, const std::vector<Body>& bodies,
                         const OwnedBatch& batch, Tally& tally) {
  const std::vector<SphereHit> hits = hitsOf(objects, batch.view());
  std::size_t next = 0;
  std::vector<BoxSolid> solids;
  solids.reserve(bodies.size());
  for (const Body& body : bodies) solids.push_back(body.solid());
  for (const RadiusRange& range : batch.view().ranges) {
    for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
      bool any = false;
      for (std::uint32_t object = 0; object < bodies.size(); ++object) {
        const bool found = next < hits.size() && hits[next] == SphereHit{n, object};
        next += found ? 1 : 0;
        any = any || found;
        const double gap =
            solids[object].distance(toPoint3(batch.center(n))) - static_cast<double>(range.radius);
        if (std::abs(gap) < kTies) continue;
        ASSERT_EQ(found, gap < 0) << "sphere " << n << " object " << object << " gap " << gap;
      }
      tally.add(any);
    }
  }
  ASSERT_EQ(next, hits.size()) << "hits out of order, or twice";
  EXPECT_EQ(objects.touches(batch.view()), !hits.empty());
}

TEST(RestingObjects, FindsWhatAllPairsFindInARoomOfThirtyObjects) {
  std::mt19937 random(401);
  const Room room;
  Tally tally;
  for (int round = 0; round < 50; ++round) {
    const std::vector<Body> bodies = randomBodies(room, 30, random);
    const RestingObjects objects = restingAt(bodies);
    for (int n = 0; n < 20; ++n) {
      compareWithAllPairs(objects, bodies, randomBatch(bodies, room, random), tally);
    }
  }
  tally.expectBothSides();
}

TEST(RestingObjects, FindsWhatAllPairsFindForAnyNumberOfObjects) {
  std::mt19937 random(402);
  for (const std::size_t count : {1U, 32U, 33U, 64U, 65U, 200U}) {
    SCOPED_TRACE(count);
    const Room room{.x = {0, 6}, .z = {0, 6}};
    Tally tally;
    for (int n = 0; n < 40; ++n) {
      const std::vector<Body> bodies = randomBodies(room, count, random);
      const RestingObjects objects = restingAt(bodies);
      compareWithAllPairs(objects, bodies, randomBatch(bodies, room, random), tally);
    }
    tally.expectBothSides();
  }
}

TEST(RestingObjects, FindsBoxesOfManyCells) {
  std::mt19937 random(403);
  const Room room{.least = 0.01F, .most = 1.5F};
  Tally tally;
  for (int n = 0; n < 100; ++n) {
    const std::vector<Body> bodies = randomBodies(room, 5, random);
    compareWithAllPairs(restingAt(bodies), bodies, randomBatch(bodies, room, random), tally);
  }
  tally.expectBothSides();
}

TEST(RestingObjects, FindsTheRightOnesInScenesLargerThanTheTorus) {
  std::mt19937 random(404);
  // Four rooms at the same place on the torus, and the numbers of cells negative in one.
  const float size = kCellEdge * kByteCells;
  Tally tally;
  for (int n = 0; n < 100; ++n) {
    std::vector<Body> bodies;
    bodies.reserve(40);
    for (std::uint32_t body = 0; body < 40; ++body) {
      bodies.push_back(randomBody({.x = {0, 1.5F}, .z = {0, 1.5F}}, random));
      bodies.back().pose.translation.x += static_cast<float>(body % 4) * size - size;
      bodies.back().pose.translation.z -= static_cast<float>(body % 3) * size;
      bodies.back().pose.translation.y += static_cast<float>(body % 5) * kBandHeight * kBands;
    }
    compareWithAllPairs(restingAt(bodies), bodies, randomBatch(bodies, {}, random), tally);
  }
  tally.expectBothSides();
}

TEST(RestingObjects, FindsBoxesLongerThanTheTorus) {
  const Body plank{{{}, {20, 0.01F, 0.1F}}, {{0, 1, 0}, yaw(0.3)}};
  const Body pole{{{}, {0.05F, 30, 0.05F}}, {{5, 0, 5}, {}}};
  const RestingObjects objects = restingAt({plank, pole});
  const auto hits = [&](Vec3 center) {
    return hitsOf(objects, OwnedBatch().add(2, 0.12F, {center}).view());
  };
  const double turn = 0.3;
  for (int n = -66; n <= 66; ++n) {
    const float along = 0.3F * static_cast<float>(n);
    const Vec3 on{along * static_cast<float>(std::cos(turn)), 1.1F,
                  -along * static_cast<float>(std::sin(turn))};
    EXPECT_THAT(hits(on), ElementsAre(SphereHit{0, 0})) << along;
    EXPECT_THAT(hits(on + Vec3{0, 0.2F, 0}), ElementsAre()) << along;
  }
  for (int n = -100; n <= 100; ++n) {
    const float height = 0.3F * static_cast<float>(n);
    EXPECT_THAT(hits({5.1F, height, 5}), ElementsAre(SphereHit{0, 1})) << height;
    EXPECT_THAT(hits({5.2F, height, 5}), ElementsAre()) << height;
  }
}

TEST(RestingObjects, WithoutObjectsTouchNothing) {
  std::mt19937 random(405);
  const Room room;
  const RestingObjects objects = restingAt({});
  const OwnedBatch batch = randomBatch({}, room, random);
  EXPECT_FALSE(objects.touches(batch.view()));
  EXPECT_TRUE(hitsOf(objects, batch.view()).empty());
  EXPECT_EQ(objects.nearest({1, 1, 1}, 0.1F), OptionalIndex());
  EXPECT_EQ(objects.fall({1, 1, 1}, 0.1F), std::numeric_limits<float>::infinity());
}

TEST(RestingObjects, TouchingIsNoOverlap) {
  const Body cube{{{}, {0.25F, 0.25F, 0.25F}}, {{1, 1, 1}, {}}};
  const RestingObjects objects = restingAt({cube});
  const auto touches = [&](Vec3 center) {
    return objects.touches(OwnedBatch().add(0, 0.0625F, {center}).view());
  };
  EXPECT_FALSE(touches({1.3125F, 1, 1}));
  EXPECT_TRUE(touches({std::nextafter(1.3125F, 0.0F), 1, 1}));
  EXPECT_FALSE(touches({1, 1.3125F, 1}));
  EXPECT_TRUE(touches({1, 1.3124F, 1}));
  EXPECT_TRUE(touches({1, 1, 1}));
}

TEST(RestingObjects, NumbersThatAreNoneTouchNothing) {
  const Body cube{{{}, {0.25F, 0.25F, 0.25F}}, {{0, 0, 0}, {}}};
  const RestingObjects objects = restingAt({cube});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float odd : {nan, -nan, infinity, -infinity, 3e38F, -3e38F}) {
    for (const Vec3 center : {Vec3{odd, 0, 0}, Vec3{0, odd, 0}, Vec3{0, 0, odd}}) {
      const OwnedBatch batch = OwnedBatch().add(0, 0.1F, {center});
      EXPECT_FALSE(objects.touches(batch.view()));
      EXPECT_TRUE(hitsOf(objects, batch.view()).empty());
      EXPECT_EQ(objects.nearest(center, 0.1F), OptionalIndex());
      // One such sphere hides no other.
      EXPECT_TRUE(objects.touches(OwnedBatch().add(0, 0.1F, {center, {0, 0, 0}}).view()));
    }
  }
}

TEST(RestingObjects, GiveAsManyHitsAsAreTaken) {
  std::mt19937 random(406);
  const Room room{.x = {0, 1}, .z = {0, 1}};
  const std::vector<Body> bodies = randomBodies(room, 150, random);
  const RestingObjects objects = restingAt(bodies);
  const OwnedBatch batch = randomBatch(bodies, room, random);
  const std::vector<SphereHit> all = hitsOf(objects, batch.view());
  ASSERT_GT(all.size(), 20U);
  for (std::size_t most = 0; most <= all.size() + 1; ++most) {
    std::vector<SphereHit> some(most + 1, {77, 77});
    const std::size_t count = objects.hits(batch.view(), std::span(some).first(most));
    ASSERT_EQ(count, std::min(most, all.size()));
    EXPECT_TRUE(
        std::equal(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count), all.begin()));
    EXPECT_EQ(some[count], (SphereHit{77, 77}));
  }
}

TEST(RestingObjects, FollowAnySequenceOfGraspsAndDrops) {
  std::mt19937 random(407);
  const Room room{.x = {0, 3}, .z = {0, 3}};
  constexpr std::uint32_t kObjects = 70;
  RestingObjects objects(kObjects, kLargestRadius);
  std::vector<Body> bodies(kObjects);
  std::vector<bool> resting(kObjects);
  Tally tally;
  for (int change = 0; change < 3000; ++change) {
    if (change % 1000 == 0) {
      objects.clear();
      resting.assign(kObjects, false);
    }
    const auto index = static_cast<std::uint32_t>(random() % kObjects);
    if (resting[index]) {
      objects.remove(index);
    } else {
      bodies[index] = randomBody(room, random);
      objects.insert(index, bodies[index].resting());
    }
    resting[index] = !resting[index];
    if (change % 10 != 0) continue;
    const Vec3 center = randomCenter(bodies, room, random);
    const std::vector<SphereHit> hits =
        hitsOf(objects, OwnedBatch().add(0, kLargestRadius, {center}).view());
    std::set<std::uint32_t> expected;
    for (std::uint32_t n = 0; n < kObjects; ++n) {
      ASSERT_EQ(objects.isResting(n), resting[n]);
      if (resting[n] && overlaps(bodies[n].resting(), center, kLargestRadius)) expected.insert(n);
    }
    std::set<std::uint32_t> found;
    for (const SphereHit& hit : hits) found.insert(hit.object);
    ASSERT_EQ(found, expected);
    tally.add(!found.empty());
  }
  tally.expectBothSides();
  for (std::uint32_t n = 0; n < kObjects; ++n) {
    if (resting[n]) objects.remove(n);
  }
  const RestingView view = objects.view();
  for (std::size_t n = 0; n < view.bounds_count; ++n) {
    EXPECT_EQ(view.bounds[n].resting, 0U);
    EXPECT_EQ(view.bounds[n].everywhere, 0U);
  }
}

/// Eight centers, as near to each other as those of a link, or anywhere.
void addEight(const std::vector<Body>& bodies, const Room& room, bool together,
              std::mt19937& random, std::vector<Vec3>& centers) {
  const Vec3 around = randomCenter(bodies, room, random);
  const auto aside = [&] { return uniformIn(random, -0.2F, 0.2F); };
  for (int lane = 0; lane < 8; ++lane) {
    centers.push_back(together ? around + Vec3{aside(), aside(), aside()}
                               : randomCenter(bodies, room, random));
  }
}

/// Makes one coordinate of sixteen any float at all.
void spoil(std::vector<Vec3>& centers, std::mt19937& random) {
  const auto any = [&] { return std::bit_cast<float>(static_cast<std::uint32_t>(random())); };
  for (Vec3& center : centers) {
    if (random() % 16 == 0) center.x = any();
    if (random() % 16 == 0) center.y = any();
    if (random() % 16 == 0) center.z = any();
  }
}

/// Both kernels on the same groups, in some rounds with centers that are no sensible numbers.
TEST(RestingObjects, AnswerAlikeBitForBitWithBothKernels) {
  if (!detail::hasAvx2()) GTEST_SKIP() << "this processor has no AVX2: nothing to compare";
  std::mt19937 random(408);
  const Room room{.x = {0, 5}, .z = {0, 5}, .beyond = 1};
  Tally tally;
  for (int round = 0; round < 300; ++round) {
    const std::vector<Body> bodies = randomBodies(room, 1 + random() % 90, random);
    const RestingObjects objects = restingAt(bodies);
    const bool together = round % 2 == 0;
    std::vector<Vec3> centers;
    for (std::size_t group = 1 + random() % 20; group > 0; --group) {
      addEight(bodies, room, together, random, centers);
    }
    if (!together) spoil(centers, random);
    const OwnedBatch batch = OwnedBatch().add(0, kRadii[random() % 3], centers);
    const SphereBatch spheres = batch.view();
    for (std::size_t first = 0; first < centers.size() / 8; ++first) {
      LaneGroup portable{.group = first};
      LaneGroup vectorised{.group = first};
      const bool found = portableResting().find_touching(objects.view(), spheres, portable);
      ASSERT_EQ(found, avx2Resting().find_touching(objects.view(), spheres, vectorised));
      if (!found) break;
      ASSERT_EQ(portable.range, vectorised.range);
      ASSERT_EQ(portable.group, vectorised.group);
      ASSERT_EQ(portable.lanes, vectorised.lanes);
      for (unsigned lane = 0; lane < 8; ++lane) tally.add(((portable.lanes >> lane) & 1U) != 0);
    }
  }
  tally.expectBothSides();
}

TEST(RestingObjects, BoundsOfARobotChangeNoAnswer) {
  std::mt19937 random(410);
  std::vector<RestingKernels> kernels{portableResting()};
  if (detail::hasAvx2()) kernels.push_back(avx2Resting());
  Tally tally;
  Tally may_touch;
  for (int round = 0; round < 1000; ++round) {
    // Far from the origin, coordinates are coarse, and cells have any number.
    const float far = round % 4 == 0 ? -700.0F : 0.0F;
    const Room room{.x = {far, far + 8}, .z = {0, 8}};
    std::vector<Body> bodies = randomBodies(room, random() % 20, random);
    // On any storey: bands wrap around, too.
    const float up = uniformIn(random, -3, 3);
    for (Body& body : bodies) body.pose.translation.y += up;
    const RestingObjects objects = restingAt(bodies);
    std::vector<float> radii(1 + random() % 20);
    for (float& radius : radii) radius = kRadii[random() % 3];
    const RobotOfEights robot(robotCenters(radii.size(), bodies, room, random), radii);
    const bool touches = objects.touches(robot.batch());
    tally.add(touches);
    for (const RestingKernels& each : kernels) {
      ASSERT_EQ(each.touches(objects.view(), robot.bounded()), touches) << round;
      const bool may = each.may_touch(objects.view(), robot.all());
      ASSERT_TRUE(may || !touches) << round;
      may_touch.add(may);
    }
  }
  tally.expectBothSides();
  may_touch.expectBothSides();
}

TEST(RestingObjects, BoundsOfARobotHideNoSphereThatJustOverlaps) {
  std::mt19937 random(411);
  const Room room{.x = {0, 3}, .z = {0, 3}};
  for (int round = 0; round < 2000; ++round) {
    const std::vector<Body> bodies = randomBodies(room, 1, random);
    const RestingObjects objects = restingAt(bodies);
    // Just nearer than its radius to the point of the box that is farthest along an axis.
    const RestingBox box = bodies[0].resting();
    const bool along_x = random() % 2 == 0;
    const float side = random() % 2 == 0 ? 1.0F : -1.0F;
    const auto corner = [&](const Vec3& axis, float half) {
      return axis * std::copysign(half, side * (along_x ? axis.x : axis.z));
    };
    Vec3 center = box.center + corner(box.axis_x, box.half_extents.x) +
                  corner(box.axis_y, box.half_extents.y) + corner(box.axis_z, box.half_extents.z);
    const float radius = kRadii[random() % 3];
    (along_x ? center.x : center.z) += side * 0.999F * radius;
    const RobotOfEights robot(std::vector<Vec3>(kLanes, center), {radius});
    ASSERT_TRUE(objects.touches(robot.batch())) << round;
    ASSERT_TRUE(objects.touches(robot.bounded())) << round;
  }
}

TEST(RestingObjects, NearestIsTheOneOfBruteForce) {
  std::mt19937 random(409);
  const Room room{.x = {0, 2}, .z = {0, 2}};
  Tally tally;
  for (int round = 0; round < 50; ++round) {
    const std::vector<Body> bodies = randomBodies(room, 40, random);
    const RestingObjects objects = restingAt(bodies);
    for (int n = 0; n < 100; ++n) {
      const Vec3 center = randomCenter(bodies, room, random);
      const float radius = kRadii[random() % 3];
      OptionalIndex expected;
      double least = static_cast<double>(radius);
      double second = least;
      for (std::uint32_t object = 0; object < bodies.size(); ++object) {
        const double distance = bodies[object].solid().distance(toPoint3(center));
        if (distance < least) {
          second = least;
          least = distance;
          expected = object;
        } else {
          second = std::min(second, distance);
        }
      }
      const OptionalIndex found = objects.nearest(center, radius);
      tally.add(static_cast<bool>(found));
      const bool is_tie = second - least < kTies && least > 0;
      if (is_tie) continue;
      ASSERT_EQ(found, expected) << least << " " << second;
    }
  }
  tally.expectBothSides();
}

TEST(RestingObjects, NearestPrefersTheLowerIndexOfTwoThatHoldTheCenter) {
  const Body cube{{{}, {0.25F, 0.25F, 0.25F}}, {{1, 1, 1}, {}}};
  const RestingObjects objects = restingAt({cube, cube, cube});
  EXPECT_EQ(objects.nearest({1, 1, 1}, 0.015F), 0U);
}

}  // namespace
}  // namespace galactic::test::resting_objects_test
