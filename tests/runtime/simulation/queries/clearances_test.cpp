// How far a PlanningScene says that the robot's spheres are from what surrounds them, against what
// it calls free, and against all columns and boxes of the small home.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "galactic/robot.h"
#include "runtime/simulation/queries/planned_home.h"
#include "support/oracles/resting_oracle.h"

namespace galactic::test::clearances_test {
namespace {

/// Heights keep clear of contacts by some millionths of the room's; the rest is rounding.
constexpr float kTolerance = 1e-4F;
constexpr float kMost = 0.3F;
constexpr std::size_t kPositions = 4;
constexpr std::size_t kBaseNumbers = 4;

float leastOf(std::span<const SphereClearance> clearances) {
  return std::ranges::min_element(clearances, {}, &SphereClearance::distance)->distance;
}

double beyond(double at, double lo, double hi) { return std::max({lo - at, at - hi, 0.0}); }

/// The nearest place in a grid that is free, or is not: in all columns, in double precision.
double distanceInGrid(const ColumnGrid& grid, const Point3& p, bool free, bool is_level) {
  const auto edge = [&](float min, std::uint32_t n) {
    return static_cast<double>(min) + static_cast<double>(grid.spacing()) * n;
  };
  double nearest = std::numeric_limits<double>::infinity();
  // Around the grid, nothing is free.
  if (!free) {
    nearest = std::min(
        {p[0] - edge(grid.layout().min_x, 0), edge(grid.layout().min_x, grid.columnsX()) - p[0],
         p[2] - edge(grid.layout().min_z, 0), edge(grid.layout().min_z, grid.columnsZ()) - p[2]});
  }
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      std::vector<Span> spans(grid.spanCount(i, k));
      grid.spans(i, k, spans);
      double y = free ? std::numeric_limits<double>::infinity() : 0;
      for (const Span& span : spans) {
        const auto lo = static_cast<double>(span.lo);
        const auto hi = static_cast<double>(span.hi);
        if (free) y = std::min(y, beyond(p[1], lo, hi));
        if (!free && p[1] >= lo && p[1] <= hi) y = std::min(p[1] - lo, hi - p[1]);
      }
      if (is_level && y > 0) continue;
      const double x = beyond(p[0], edge(grid.layout().min_x, i), edge(grid.layout().min_x, i + 1));
      const double z = beyond(p[2], edge(grid.layout().min_z, k), edge(grid.layout().min_z, k + 1));
      nearest = std::min(nearest, std::hypot(x, y, z));
    }
  }
  return nearest;
}

class Clearances : public PlanningSceneInTheSmallHome {
 protected:
  /// The nearest thing to a sphere in the scene, by all columns of its grid.
  [[nodiscard]] double sceneDistance(const Vec3& center, std::size_t radius_index,
                                     bool is_level) const {
    const ColumnGrid& grid = scene_.scene().grids()[radius_index];
    const bool is_free = grid.clearance(center) == Clearance::kFree;
    const double distance = distanceInGrid(grid, toPoint3(center), !is_free, is_level);
    return (is_free ? 1 : -1) * std::min(distance, static_cast<double>(kMost));
  }
  /// The center of a sphere of the robot, with these joints and there.
  [[nodiscard]] Vec3 centerOf(const SphereGroup& group, const SetSphere& sphere,
                              const BasePlace& base) const {
    return scene_.worldFromRoot(base) * (scene_.rootFromLinks()[group.link] * sphere.center);
  }
  /// Of a pose near the table and its objects.
  static DrawnPoses posesAtTheTable(std::uint32_t seed, std::size_t count) {
    DrawnPoses drawn(seed);
    drawn.add(count);
    for (BasePlace& base : drawn.bases) {
      base.position = {drawn.between(0.5F, 0.95F), 0, drawn.between(1.1F, 1.9F)};
      base.yaw = drawn.between(-0.5F, 0.5F);
    }
    return drawn;
  }
};

TEST_F(Clearances, AreNegativeExactlyWhereAPoseIsNotFree) {
  constexpr std::size_t kCount = 1500;
  for (const bool holds : {false, true}) {
    if (holds) fetchTarget();
    DrawnPoses drawn(11);
    drawn.add(kCount);
    std::size_t free = 0;
    std::size_t unsure = 0;
    for (std::size_t n = 0; n < kCount; ++n) {
      scene_.setJoints(drawn[n].joints);
      const float least = leastOf(scene_.clearances(drawn.bases[n], kMost));
      const bool is_free = scene_.isFree(drawn.bases[n]);
      free += is_free ? 1U : 0U;
      unsure += std::fabs(least) <= kTolerance ? 1U : 0U;
      if (std::fabs(least) <= kTolerance) continue;
      EXPECT_EQ(least > 0, is_free) << n << ": " << least;
    }
    EXPECT_GE(free, kLeastShare * kCount);
    EXPECT_LE(free, (1 - kLeastShare) * kCount);
    EXPECT_LE(unsure, kCount / 100);
  }
}

TEST_F(Clearances, AreThoseToTheNearestOfAllColumnsAndBoxes) {
  constexpr std::size_t kCount = 60;
  const Robot& robot = home_.world().robot();
  const DrawnPoses drawn = posesAtTheTable(12, kCount);
  std::size_t objects = 0;
  std::size_t scenes = 0;
  std::size_t penetrating = 0;
  for (std::size_t n = 0; n < kCount; ++n) {
    scene_.setJoints(drawn[n].joints);
    const BasePlace& base = drawn.bases[n];
    const std::span<const SphereClearance> found = scene_.clearances(base, kMost);
    ASSERT_EQ(found.size(), robot.spheres().size());
    ASSERT_EQ(found.size(), scene_.sphereCount());
    std::size_t sphere = 0;
    for (const SphereGroup& group : robot.groups()) {
      for (const SetSphere& own : group.spheres) {
        const Vec3 center = centerOf(group, own, base);
        const auto radius = static_cast<double>(robot.radii()[own.radius_index]);
        // Nothing moves the base's sphere up or down.
        double expected = sceneDistance(center, own.radius_index, group.link == 0);
        CastEnd nearest =
            expected < static_cast<double>(kMost) ? CastEnd::kScene : CastEnd::kNothing;
        std::int32_t index = -1;
        bool is_inside = false;
        for (std::size_t object = 0; object < scene_.objectCount(); ++object) {
          const OrientedBox box = scene_.objectBox(object);
          const double outside = BoxSolid(box, {}).distance(toPoint3(center));
          is_inside |= outside == 0;
          if (outside - radius >= expected) continue;
          expected = outside - radius;
          nearest = CastEnd::kObject;
          index = static_cast<std::int32_t>(object);
        }
        const SphereClearance& answer = found[sphere++];
        if (is_inside) {
          EXPECT_LE(static_cast<double>(answer.distance), -radius);
          continue;
        }
        EXPECT_NEAR(static_cast<double>(answer.distance), expected,
                    static_cast<double>(kTolerance));
        EXPECT_EQ(answer.nearest, nearest);
        EXPECT_EQ(answer.index, index);
        objects += nearest == CastEnd::kObject ? 1U : 0U;
        scenes += nearest == CastEnd::kScene ? 1U : 0U;
        penetrating += expected < 0 ? 1U : 0U;
      }
    }
  }
  EXPECT_GE(objects, kCount / 10);
  EXPECT_GE(scenes, kCount / 10);
  EXPECT_GE(penetrating, kCount / 10);
}

/// Poses that differ from one in one number.
class Shifted {
 public:
  Shifted(const RobotPose& pose, std::size_t number, float by)
      : base_(pose.base), joints_(pose.joints.begin(), pose.joints.end()) {
    if (number >= kBaseNumbers) {
      joints_[number - kBaseNumbers] += by;
      return;
    }
    float* const numbers[] = {&base_.position.x, &base_.position.y, &base_.position.z, &base_.yaw};
    *numbers[number] += by;
  }
  [[nodiscard]] RobotPoses poses() const { return {std::span(&base_, 1), joints_}; }

 private:
  BasePlace base_;
  std::vector<float> joints_;
};

TEST_F(Clearances, ChangeWithBaseAndJointsAsTheirGradientsSay) {
  constexpr std::size_t kCount = 150;
  constexpr float kStep = 1e-3F;
  /// What rounding does to a difference quotient with that step, and what curvature does.
  constexpr float kDerivativeTolerance = 0.02F;
  fetchTarget();
  const std::size_t spheres = scene_.sphereCount();
  ASSERT_EQ(spheres, 4U) << "three of the robot, one of what it holds";
  const DrawnPoses drawn = posesAtTheTable(13, kCount);
  std::vector<SphereClearance> found(kCount * spheres);
  std::vector<float> bases(found.size() * kBaseNumbers);
  std::vector<float> joints(found.size() * kPositions);
  scene_.clearances(drawn.poses(), kMost, found, {bases, joints});
  const auto distances = [&](const Shifted& shifted) {
    std::vector<SphereClearance> there(spheres);
    scene_.clearances(shifted.poses(), kMost, there);
    return there;
  };
  std::size_t same = 0;
  std::size_t asked = 0;
  std::size_t moving = 0;
  for (std::size_t n = 0; n < kCount; ++n) {
    for (std::size_t number = 0; number < kBaseNumbers + kPositions; ++number) {
      const auto before = distances({drawn[n], number, -kStep});
      const auto after = distances({drawn[n], number, kStep});
      for (std::size_t s = 0; s < spheres; ++s) {
        const std::size_t row = n * spheres + s;
        // The base's sphere stays on the floor: nothing is said of its height.
        if (number == 1 && s == 0) continue;
        const float quotient = (after[s].distance - before[s].distance) / (2 * kStep);
        const float derivative = number < kBaseNumbers
                                     ? bases[row * kBaseNumbers + number]
                                     : joints[row * kPositions + number - kBaseNumbers];
        // Elsewhere there is a kink: another thing, or another cell, is nearest.
        same += std::fabs(quotient - derivative) < kDerivativeTolerance ? 1U : 0U;
        moving += std::fabs(derivative) > kDerivativeTolerance ? 1U : 0U;
        ++asked;
      }
    }
  }
  EXPECT_GE(static_cast<double>(same), 0.95 * static_cast<double>(asked));
  EXPECT_GE(static_cast<double>(moving), kLeastShare * static_cast<double>(asked));
}

TEST_F(Clearances, OfManyPosesAreThoseOfEach) {
  fetchTarget();
  constexpr std::size_t kCount = 300;
  DrawnPoses drawn(14);
  drawn.add(kCount);
  const std::size_t spheres = scene_.sphereCount();
  std::vector<SphereClearance> found(kCount * spheres);
  std::vector<float> bases(found.size() * kBaseNumbers);
  const Pose grip = scene_.rootFromGrip();
  scene_.clearances(drawn.poses(), kMost, found, {.bases = bases});
  EXPECT_EQ(scene_.rootFromGrip(), grip);
  for (std::size_t n = 0; n < kCount; ++n) {
    scene_.setJoints(drawn[n].joints);
    const std::span<const SphereClearance> each = scene_.clearances(drawn.bases[n], kMost);
    EXPECT_TRUE(std::ranges::equal(each, std::span(found).subspan(n * spheres, spheres))) << n;
  }
  for (const std::uint32_t threads : {2U, 0U}) {
    std::vector<SphereClearance> again(found.size());
    std::vector<float> bases_again(bases.size());
    scene_.clearances(drawn.poses(), kMost, again, {.bases = bases_again}, threads);
    EXPECT_EQ(again, found);
    EXPECT_EQ(bases_again, bases);
  }
  scene_.clearances({}, kMost, {});
}

TEST_F(Clearances, LeaveOutTheFloorUnderSpheresThatKeepTheirHeight) {
  // The base's sphere of 12 cm nearly touches the floor in the middle of a free place.
  const BasePlace base{{0.5F, 0, 0.5F}, 0};
  const SphereClearance standing = scene_.clearances(base, 0.2F)[0];
  EXPECT_EQ(standing.nearest, CastEnd::kNothing);
  EXPECT_EQ(standing.distance, 0.2F);
  // Toward the wall, it comes nearer; below the floor, there is no way out to the side.
  const SphereClearance near = scene_.clearances({{0.15F, 0, 0.5F}, 0}, 0.2F)[0];
  EXPECT_EQ(near.nearest, CastEnd::kScene);
  EXPECT_EQ(near.direction, (Vec3{1, 0, 0}));
  const SphereClearance sunk = scene_.clearances({{0.5F, -0.1F, 0.5F}, 0}, 0.2F)[0];
  EXPECT_EQ(sunk.nearest, CastEnd::kScene);
  EXPECT_EQ(sunk.distance, -0.2F);
  EXPECT_EQ(sunk.direction, Vec3{});
}

TEST_F(Clearances, LeaveOutSpheresThatDoNotCount) {
  fetchTarget();
  const std::size_t held = scene_.sphereCount() - 1;
  BasePlace base = scene_.baseOf(state());
  base.position.y -= 0.5F;
  EXPECT_LT(scene_.clearances(base, kMost)[held].distance, 0);
  scene_.ignorePenetrating(base);
  EXPECT_EQ(scene_.clearances(base, kMost)[held].distance, kMost);
  EXPECT_EQ(scene_.clearances(base, kMost)[held].nearest, CastEnd::kNothing);
}

TEST_F(Clearances, AreRefusedForWhatMakesNoSense) {
  const BasePlace here = scene_.baseOf(state());
  const std::string name = "PlanningScene::clearances: ";
  for (const auto& [most, found] : {std::pair{0.0F, "0"},
                                    {-1.0F, "-1"},
                                    {std::nanf(""), "nan"},
                                    {std::numeric_limits<float>::infinity(), "inf"}}) {
    EXPECT_EQ(refusalOf([&, most = most] { static_cast<void>(scene_.clearances(here, most)); }),
              name + "found most " + found + ", expected meters above 0 and at most 1e+06");
  }
  BasePlace nowhere = here;
  nowhere.yaw = std::nanf("");
  nowhere.position = {1, 2, 3};
  EXPECT_EQ(refusalOf([&] { static_cast<void>(scene_.clearances(nowhere, 1)); }),
            name +
                "found base at (1, 2, 3) with the yaw nan, expected finite numbers of at most "
                "1e+06");
  const std::vector<BasePlace> bases{here, nowhere};
  const std::vector<float> joints(2 * kPositions);
  std::vector<SphereClearance> answers(6);
  EXPECT_EQ(refusalOf([&] {
              scene_.clearances({bases, joints}, 1, answers);
            }),
            name +
                "found bases[1] at (1, 2, 3) with the yaw nan, expected finite numbers of at "
                "most 1e+06");
  const std::vector<BasePlace> good(2, here);
  EXPECT_EQ(refusalOf([&] {
              scene_.clearances({good, joints}, 1, std::span(answers).first(5));
            }),
            name + "\"clearances\" has the length 5, expected 6");
  std::vector<float> numbers(23);
  EXPECT_EQ(refusalOf([&] {
              scene_.clearances({good, joints}, 1, answers, {.bases = numbers});
            }),
            name + "\"gradients.bases\" has the length 23, expected 24");
  EXPECT_EQ(refusalOf([&] {
              scene_.clearances({good, joints}, 1, answers, {.joints = numbers});
            }),
            name + "\"gradients.joints\" has the length 23, expected 24");
  EXPECT_EQ(refusalOf([&] {
              scene_.clearances({good, std::span(joints).first(7)}, 1, answers);
            }),
            name + "\"joints\" has the length 7, expected 8");
  EXPECT_EQ(answers, std::vector<SphereClearance>(6));
  PlanningScene empty(home_.world(), oneEnv());
  EXPECT_EQ(refusalOf([&] { static_cast<void>(empty.sphereCount()); }),
            "PlanningScene::sphereCount: found no env; take one over first, with update()");
}

}  // namespace
}  // namespace galactic::test::clearances_test
