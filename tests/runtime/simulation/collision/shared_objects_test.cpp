// Objects that envs share until one of them changes, against all pairs and against objects of an
// env's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "simulation/collision/resting_objects.h"
#include "support/homes/resting_bodies.h"
#include "support/homes/resting_robot.h"
#include "support/oracles/resting_oracle.h"
#include "support/processor.h"

namespace galactic::test::shared_objects_test {
namespace {

using simulation::avx2Resting;
using simulation::LaneGroup;
using simulation::overlaps;
using simulation::portableResting;
using simulation::RestingBox;
using simulation::RestingKernels;
using simulation::RestingObjects;
using simulation::SphereHit;

/// The fastest that this processor can run.
RestingKernels restingKernelsHere() {
  return detail::hasAvx2() ? avx2Resting() : portableResting();
}

/// One env's share of objects that others have, too, and what is to be found in it.
struct Sharer {
  Sharer() : objects(kMost, kLargestRadius), now(kMost) {}

  void begin(const RestingObjects& start, const std::vector<Body>& bodies) {
    objects.share(start.view());
    std::ranges::copy(bodies, now.begin());
    resting.assign(kMost, false);
    std::fill_n(resting.begin(), bodies.size(), true);
  }

  /// A hand takes an object, or lays one down somewhere.
  void change(const Room& room, std::mt19937& random) {
    const auto index = static_cast<std::uint32_t>(random() % now.size());
    if (resting[index]) {
      objects.remove(index);
    } else {
      now[index] = randomBody(room, random);
      objects.insert(index, now[index].resting());
    }
    resting[index] = !resting[index];
  }

  /// Compares what is found around a center with a look at all of them; whether anything was.
  [[nodiscard]] bool check(const Vec3& center) const {
    const OwnedBatch sphere = OwnedBatch().add(0, kLargestRadius, {center});
    std::set<std::uint32_t> expected;
    for (std::uint32_t n = 0; n < now.size(); ++n) {
      EXPECT_EQ(objects.isResting(n), resting[n]);
      if (resting[n] && overlaps(now[n].resting(), center, kLargestRadius)) expected.insert(n);
    }
    std::set<std::uint32_t> found;
    for (const SphereHit& hit : hitsOf(objects, sphere.view())) found.insert(hit.object);
    EXPECT_EQ(found, expected);
    LaneGroup at;
    EXPECT_EQ(portableResting().find_touching(objects.view(), sphere.view(), at), !found.empty());
    EXPECT_EQ(static_cast<bool>(objects.nearest(center, kLargestRadius)), !found.empty());
    return !found.empty();
  }

  /// Compares what is found with what objects find that were never shared.
  void compare(const RestingObjects& own, const RobotOfEights& robot, const Vec3& center) const {
    for (const RestingKernels& kernels : {portableResting(), restingKernelsHere()}) {
      EXPECT_EQ(kernels.touches(objects.view(), robot.bounded()),
                kernels.touches(own.view(), robot.bounded()));
      EXPECT_EQ(kernels.may_touch(objects.view(), robot.all()),
                kernels.may_touch(own.view(), robot.all()));
    }
    EXPECT_EQ(objects.fall(center, kLargestRadius), own.fall(center, kLargestRadius));
    const auto heights = [](const RestingObjects& from, const Span& between) {
      std::vector<float> seen;
      from.forEachBetween(between, [&](const RestingBox&, float y) { seen.push_back(y); });
      return seen;
    };
    const Span between{center.y, center.y + 0.3F};
    EXPECT_EQ(heights(objects, between), heights(own, between));
  }

  /// The same objects, all of them its own.
  [[nodiscard]] RestingObjects owned() const {
    RestingObjects own(kMost, kLargestRadius);
    for (std::uint32_t n = 0; n < kMost; ++n) {
      if (resting[n]) own.insert(n, now[n].resting());
    }
    return own;
  }

  /// Half of which are there at first, in fewer packs.
  static constexpr std::size_t kMost = 140;

  RestingObjects objects;
  std::vector<Body> now;
  std::vector<bool> resting;
};

TEST(SharedObjects, ChangeForOneEnvAlone) {
  std::mt19937 random(409);
  const Room room{.x = {0, 3}, .z = {0, 3}};
  const std::vector<Body> bodies = randomBodies(room, Sharer::kMost / 2, random);
  const RestingObjects start = restingAt(bodies);
  std::vector<Sharer> sharers;
  for (int n = 0; n < 3; ++n) sharers.emplace_back().begin(start, bodies);
  Tally tally;
  for (int round = 0; round < 3000; ++round) {
    Sharer& sharer = sharers[random() % sharers.size()];
    // Most episodes end before much has moved.
    if (random() % 4 == 0) {
      sharer.begin(start, bodies);
    } else {
      sharer.change(room, random);
    }
    for (const Sharer& each : sharers) {
      const Vec3 center = randomCenter(each.now, room, random);
      tally.add(each.check(center));
      const RobotOfEights robot(robotCenters(1, each.now, room, random), {kRadii[random() % 3]});
      each.compare(each.owned(), robot, center);
    }
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  tally.expectBothSides();
}

TEST(SharedObjects, AreOneForAllEnvsUntilOneComesToRest) {
  std::mt19937 random(411);
  const Room room{.x = {0, 3}, .z = {0, 3}};
  const std::vector<Body> bodies = randomBodies(room, 5, random);
  const RestingObjects start = restingAt(bodies);
  std::vector<Sharer> sharers(2);
  for (Sharer& sharer : sharers) sharer.begin(start, bodies);
  // In a hand.
  sharers[1].objects.remove(3);
  for (const Sharer& sharer : sharers) {
    EXPECT_EQ(sharer.objects.view().bounds, start.view().bounds);
    EXPECT_EQ(sharer.objects.view().boxes, start.view().boxes);
  }
  sharers[1].objects.insert(3, bodies[3].resting());
  EXPECT_NE(sharers[1].objects.view().bounds, start.view().bounds);
  EXPECT_NE(sharers[1].objects.view().boxes, start.view().boxes);
  sharers[1].begin(start, bodies);
  EXPECT_EQ(sharers[1].objects.view().bounds, start.view().bounds);
  EXPECT_EQ(sharers[1].objects.view().boxes, start.view().boxes);
}

}  // namespace
}  // namespace galactic::test::shared_objects_test
