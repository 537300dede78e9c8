// What a hand grasps, against all pairs in double precision.
#include "simulation/collision/grasp_query.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "support/homes/resting_bodies.h"
#include "support/oracles/resting_oracle.h"

namespace galactic::test::grasp_query_test {
namespace {

using simulation::nearestToGrasp;
using simulation::RestingObjects;

constexpr std::uint32_t kSeed = 1123;

/// Bodies whose hulls are their boxes without some corners: planes through random directions that
/// leave 30 to 100 % of the box's extent.
struct Things {
  std::vector<Body> bodies;
  std::vector<std::vector<HullPlane>> planes;
  std::vector<ObjectModel> models;

  Things(const Room& room, std::size_t count, std::mt19937& random)
      : bodies(randomBodies(room, count, random)), planes(count), models(count) {
    for (std::size_t n = 0; n < count; ++n) {
      const Vec3& half = bodies[n].box.half_extents;
      const Pose& object_from_box = bodies[n].box.pose;
      // A third of them are from packs without planes.
      for (int k = 0; k < (n % 3 == 0 ? 0 : 20); ++k) {
        Vec3 way{uniformIn(random, -1, 1), uniformIn(random, -1, 1), uniformIn(random, -1, 1)};
        way = way * (1 / std::sqrt(dot(way, way)));
        const float reach =
            half.x * std::fabs(way.x) + half.y * std::fabs(way.y) + half.z * std::fabs(way.z);
        const Vec3 normal = rotate(object_from_box.rotation, way);
        planes[n].push_back({normal, dot(normal, object_from_box.translation) +
                                         reach * uniformIn(random, 0.3F, 1)});
      }
      models[n].box = bodies[n].box;
      models[n].hull_planes = planes[n];
    }
  }

  /// In double precision.
  [[nodiscard]] double distance(std::size_t n, const Vec3& point) const {
    double most = bodies[n].solid().distance(toPoint3(point));
    const Vec3 local = inverse(bodies[n].pose) * point;
    for (const HullPlane& plane : planes[n]) {
      const auto product = [](float a, float b) {
        return static_cast<double>(a) * static_cast<double>(b);
      };
      most =
          std::max(most, product(plane.normal.x, local.x) + product(plane.normal.y, local.y) +
                             product(plane.normal.z, local.z) - static_cast<double>(plane.offset));
    }
    return most;
  }
};

TEST(AGraspQuery, FindsTheNearestByBoxAndPlanes) {
  std::mt19937 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  const Room room{.x = {0, 2}, .z = {0, 2}};
  Tally found_any;
  Tally same_as_box;
  for (int round = 0; round < 50; ++round) {
    const Things things(room, 40, random);
    const RestingObjects resting = restingAt(things.bodies);
    const auto model = [&](std::uint32_t n) -> const ObjectModel& { return things.models[n]; };
    const auto pose = [&](std::uint32_t n) -> const Pose& { return things.bodies[n].pose; };
    for (int n = 0; n < 100; ++n) {
      const Vec3 center = randomCenter(things.bodies, room, random);
      const float radius = kRadii[random() % 3];
      OptionalIndex expected;
      auto least = static_cast<double>(radius);
      double second = least;
      for (std::uint32_t object = 0; object < things.bodies.size(); ++object) {
        const double distance = things.distance(object, center);
        if (distance < least) {
          second = least;
          least = distance;
          expected = object;
        } else {
          second = std::min(second, distance);
        }
      }
      const auto found = nearestToGrasp(resting, {center, radius}, GraspShape::kHull, model, pose);
      const auto by_box = nearestToGrasp(resting, {center, radius}, GraspShape::kBox, model, pose);
      ASSERT_EQ(by_box, resting.nearest(center, radius)) << "the published rule";
      found_any.add(static_cast<bool>(found));
      if (by_box) same_as_box.add(found == by_box);
      if (second - least < kTies && least > 0) continue;
      ASSERT_EQ(found, expected) << least << " " << second;
    }
  }
  found_any.expectBothSides();
  same_as_box.expectBothSides();
}

}  // namespace
}  // namespace galactic::test::grasp_query_test
