// Rays and swept spheres, against walks along them in small steps.
#include "galactic/ray_caster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "galactic/planning_scene.h"
#include "support/homes/box_room.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/task_twins.h"
#include "support/oracles/resting_oracle.h"

namespace galactic::test::ray_caster_test {
namespace {

constexpr std::uint32_t kSeed = 47;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// How far a walk goes at a time, meters.
constexpr double kStep = 2e-3;
/// Of distances that are floats, and of boxes whose axes are; meters.
constexpr double kRounding = 2e-5;

/// Lines with what they point to.
struct Lines {
  std::vector<Vec3> origins;
  std::vector<Vec3> directions;
  std::vector<float> lengths;

  [[nodiscard]] CastLines view() const { return {origins, directions, lengths}; }
  void add(const Vec3& origin, const Vec3& direction, float length = kInfinity) {
    origins.push_back(origin);
    directions.push_back(direction);
    lengths.push_back(length);
  }
  [[nodiscard]] Point3 at(std::size_t n, double way) const {
    const Point3 direction = toPoint3(directions[n]);
    const double whole = std::hypot(direction[0], direction[1], direction[2]);
    Point3 point = toPoint3(origins[n]);
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] += direction[axis] / whole * way;
    return point;
  }
};

Vec3 randomDirection(std::mt19937& random) {
  const Quat q = randomQuat(random);
  return rotate(q, {1, 0, 0}) * uniformIn(random, 0.1F, 5);
}

/// Anywhere in a room of BoxRoom, above its floor.
Lines randomLines(std::size_t count, std::mt19937& random) {
  Lines lines;
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 origin{uniformIn(random, 0.1F, 2.9F), uniformIn(random, 0.1F, 1.5F),
                      uniformIn(random, 0.1F, 2.9F)};
    const bool is_level = random() % 4 == 0;
    Vec3 direction = randomDirection(random);
    if (is_level) direction.y = 0;
    lines.add(origin, direction, uniformIn(random, 0, 3));
  }
  return lines;
}

Vec3 toVec3(const Point3& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

std::vector<CastHit> rays(const RayCaster& caster, const Lines& lines, std::uint32_t threads = 1) {
  std::vector<CastHit> hits(lines.origins.size());
  caster.castRays(lines.view(), hits, threads);
  return hits;
}

std::vector<CastHit> sweeps(const RayCaster& caster, float radius, const Lines& lines,
                            std::uint32_t threads = 1) {
  std::vector<CastHit> hits(lines.origins.size());
  caster.sweepSpheres(radius, lines.view(), hits, threads);
  return hits;
}

CastHit ray(const RayCaster& caster, const Vec3& origin, const Vec3& direction,
            float length = kInfinity) {
  Lines lines;
  lines.add(origin, direction, length);
  return rays(caster, lines).front();
}

TEST(RayCaster, SweepsThroughASceneAsFarAsQueriesSayFree) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  const BoxRoom room = furnishedRoom(random, 12);
  const RayCaster caster(room.scene());
  for (const ColumnGrid& grid : room.scene().grids()) {
    const Lines lines = randomLines(2000, random);
    const std::vector<CastHit> hits = sweeps(caster, grid.radius(), lines);
    int stopped = 0;
    int passed = 0;
    for (std::size_t n = 0; n < hits.size(); ++n) {
      const auto distance = static_cast<double>(hits[n].distance);
      const auto clearance = [&](double way) { return grid.clearance(toVec3(lines.at(n, way))); };
      EXPECT_EQ(hits[n].index, -1);
      for (double way = 0; way < distance - kRounding; way += kStep) {
        ASSERT_EQ(clearance(way), Clearance::kFree) << n << " at " << way;
      }
      if (hits[n].end == CastEnd::kNothing) {
        ++passed;
        ASSERT_EQ(hits[n].distance, lines.lengths[n]);
        continue;
      }
      if (hits[n].end != CastEnd::kScene) continue;
      ++stopped;
      // Flat ways come within the margin of a contact long before it.
      const Point3 from = lines.at(n, 0);
      const double rise = std::abs(lines.at(n, 1)[1] - from[1]);
      const double slack = kRounding + (rise > 0 ? 1e-5 / rise : 0);
      bool ends_there = false;
      for (int part = 0; part <= 200 && !ends_there; ++part) {
        ends_there = clearance(distance + slack * part / 200) == Clearance::kBlocked;
      }
      ASSERT_TRUE(ends_there) << n << " after " << distance;
    }
    const auto count = static_cast<int>(hits.size());
    std::printf("r = %g m: %d of %d stopped, %d passed\n", static_cast<double>(grid.radius()),
                stopped, count, passed);
    EXPECT_GT(stopped, count / 10);
    EXPECT_GT(passed, count / 10);
  }
  // Rays see the scene as the smallest spheres do.
  const Lines lines = randomLines(500, random);
  EXPECT_EQ(rays(caster, lines), sweeps(caster, room.scene().grids().front().radius(), lines));
}

TEST(RayCaster, SaysWhereTheGridEnds) {
  const BoxRoom room(std::vector<Block>{{{0, -0.4F, 0}, {3, 0, 3}}});
  const RayCaster caster(room.scene());
  const CastHit aside = ray(caster, {1, 1, 1}, {10, 0, 0});
  EXPECT_EQ(aside, (CastHit{2, CastEnd::kOutside}));
  const CastHit above = ray(caster, {1, 1, 1}, {0, 0.5F, 0});
  EXPECT_EQ(above.end, CastEnd::kOutside);
  EXPECT_NEAR(above.distance, 2, 1e-3F);
  EXPECT_EQ(ray(caster, {-1, 1, 1}, {1, 0, 0}), (CastHit{0, CastEnd::kOutside}));
  EXPECT_EQ(ray(caster, {1e30F, 1, 1}, {1, 0, 0}), (CastHit{0, CastEnd::kOutside}));
  const CastHit below = ray(caster, {1, 1, 1}, {0, -1e-30F, 0});
  EXPECT_EQ(below.end, CastEnd::kScene);
  EXPECT_NEAR(below.distance, 1 - 0.015F, 2e-4F);
  EXPECT_EQ(ray(caster, {1, -0.1F, 1}, {0, 1, 0}), (CastHit{0, CastEnd::kScene}));
  // Nowhere to go is a way, too.
  EXPECT_EQ(ray(caster, {1, 1, 1}, {0, 1, 0}, 0), (CastHit{0, CastEnd::kNothing}));
  EXPECT_EQ(ray(caster, {1, -0.1F, 1}, {0, 1, 0}, 0), (CastHit{0, CastEnd::kScene}));
  EXPECT_EQ(ray(caster, {1, 1, 1}, {3e38F, 3e38F, 0}, 0.5F), (CastHit{0.5F, CastEnd::kNothing}));
}

SimulationOptions oneEnv() {
  SimulationOptions options;
  options.envs = 1;
  options.threads = 1;
  options.order = EpisodeOrder::kLinear;
  options.task.most_steps = 0;
  return options;
}

/// An episode of three objects, elsewhere.
class RayCasterInTheSmallHome : public testing::Test {
 protected:
  RayCasterInTheSmallHome() : simulator_(simulatorOf(home_.world(), oneEnv())) {
    simulator_.reset(std::vector<std::int32_t>{1});
  }
  [[nodiscard]] EnvState state() const { return simulator_.envState(0); }
  [[nodiscard]] const World& world() const { return home_.world(); }
  [[nodiscard]] const Placement& placement(std::size_t n) const {
    return world().episodes().placements(world().episodes().episodes()[1])[n];
  }

  SmallHome home_;
  BatchSimulator simulator_;
};

TEST_F(RayCasterInTheSmallHome, FindsObjectsWhereTheyAre) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  Tally meets;
  std::array<int, 3> objects{};
  for (int round = 0; round < 12; ++round) {
    EnvState now = state();
    ASSERT_EQ(now.objects.size(), objects.size());
    std::vector<BoxSolid> solids;
    for (std::size_t n = 0; n < objects.size(); ++n) {
      // Close to each other, over the floor beside the table.
      now.objects[n] = {{uniformIn(random, 0.3F, 0.8F), uniformIn(random, 0.2F, 0.7F),
                         uniformIn(random, 0.3F, 0.8F)},
                        randomQuat(random)};
      solids.emplace_back(world().objectOf(placement(n)).box, now.objects[n]);
    }
    const RayCaster caster(world(), now);
    const RayCaster empty(world().scenes()[0]);
    Lines lines;
    for (int n = 0; n < 300; ++n) {
      const Vec3 origin{uniformIn(random, 0.15F, 0.95F), uniformIn(random, 0.15F, 0.9F),
                        uniformIn(random, 0.15F, 0.95F)};
      const Vec3 target{uniformIn(random, 0.3F, 0.8F), uniformIn(random, 0.2F, 0.7F),
                        uniformIn(random, 0.3F, 0.8F)};
      lines.add(origin, target - origin, uniformIn(random, 0, 2));
    }
    for (const float radius : {0.0F, 0.05F, 0.12F}) {
      const auto cast = [&](const RayCaster& by) {
        return radius == 0 ? rays(by, lines) : sweeps(by, radius, lines);
      };
      const std::vector<CastHit> hits = cast(caster);
      const std::vector<CastHit> without = cast(empty);
      for (std::size_t n = 0; n < hits.size(); ++n) {
        const auto distance = static_cast<double>(hits[n].distance);
        const auto apart = [&](std::size_t object, double way) {
          return solids[object].distance(lines.at(n, way)) - static_cast<double>(radius);
        };
        // Nothing is nearer.
        for (double way = 0; way < distance - kRounding; way += kStep) {
          for (std::size_t object = 0; object < solids.size(); ++object) {
            ASSERT_GT(apart(object, way), -kRounding) << n << " at " << way;
          }
        }
        meets.add(hits[n].end == CastEnd::kObject);
        if (hits[n].end != CastEnd::kObject) {
          ASSERT_EQ(hits[n], without[n]);
          continue;
        }
        ASSERT_LE(hits[n].distance, without[n].distance);
        const auto index = static_cast<std::size_t>(hits[n].index);
        ++objects[index];
        const double there = apart(index, distance);
        ASSERT_LT(there, kRounding) << n;
        ASSERT_TRUE(distance == 0 || there > -kRounding) << n;
      }
    }
  }
  meets.expectBothSides();
  for (const int count : objects) EXPECT_GT(count, 100);
}

TEST_F(RayCasterInTheSmallHome, SeesTheRobotWhereItIsAskedTo) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  const EnvState now = state();
  const Robot& robot = world().robot();
  PlanningScene links(world(), oneEnv());
  links.update(now);
  links.setJoints(now.joint_positions);
  struct Ball {
    std::int32_t link;
    Vec3 center;
    float radius;
  };
  std::vector<Ball> balls;
  for (const SphereGroup& group : robot.groups()) {
    const Pose pose = now.world_from_root * links.rootFromLinks()[group.link];
    for (const SetSphere& sphere : group.spheres) {
      balls.push_back({static_cast<std::int32_t>(group.link), pose * sphere.center,
                       robot.radii()[sphere.radius_index]});
    }
  }
  const RayCaster seen(world(), now, CastRobot::kIsSeen);
  const RayCaster unseen(world(), now);
  Lines lines;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 origin{uniformIn(random, 0.15F, 0.95F), uniformIn(random, 0.15F, 1.2F),
                      uniformIn(random, 0.9F, 2.2F)};
    const Vec3 at = balls[random() % balls.size()].center;
    const Vec3 target = at + randomDirection(random) * 0.05F;
    lines.add(origin, target - origin);
  }
  Tally meets;
  for (const float radius : {0.0F, 0.05F}) {
    const std::vector<CastHit> hits = radius == 0 ? rays(seen, lines) : sweeps(seen, 0.05F, lines);
    const std::vector<CastHit> others =
        radius == 0 ? rays(unseen, lines) : sweeps(unseen, 0.05F, lines);
    for (std::size_t n = 0; n < hits.size(); ++n) {
      ASSERT_NE(others[n].end, CastEnd::kRobot);
      meets.add(hits[n].end == CastEnd::kRobot);
      const auto distance = static_cast<double>(hits[n].distance);
      const auto nearest = [&](double way, std::int32_t link) {
        double least = 1e9;
        for (const Ball& ball : balls) {
          if (link >= 0 && ball.link != link) continue;
          const Point3 p = lines.at(n, way);
          const Point3 c = toPoint3(ball.center);
          least =
              std::min(least, std::hypot(p[0] - c[0], p[1] - c[1], p[2] - c[2]) -
                                  static_cast<double>(ball.radius) - static_cast<double>(radius));
        }
        return least;
      };
      for (double way = 0; way < distance - kRounding; way += 2 * kStep) {
        ASSERT_GT(nearest(way, -1), -kRounding) << n << " at " << way;
      }
      if (hits[n].end != CastEnd::kRobot) {
        ASSERT_EQ(hits[n], others[n]);
        continue;
      }
      ASSERT_LT(nearest(distance, hits[n].index), kRounding) << n;
    }
  }
  meets.expectBothSides();
}

TEST_F(RayCasterInTheSmallHome, TakesWhatIsHeldForAPartOfTheRobot) {
  for (int n = 0; n < 150 && state().held < 0; ++n) {
    simulator_.step(fetch(state(), state().target));
  }
  const EnvState now = state();
  ASSERT_EQ(now.held, static_cast<std::int32_t>(now.target));
  const Vec3 middle = now.objects[now.target] * Vec3{0, 0.05F, 0};
  const Vec3 from = middle + Vec3{0, 0.4F, 0};
  const CastHit hit = ray({world(), now, CastRobot::kIsSeen}, from, {0, -1, 0});
  EXPECT_EQ(hit.end, CastEnd::kObject);
  EXPECT_EQ(hit.index, now.held);
  EXPECT_NEAR(hit.distance, 0.4F - 0.05F, 1e-4F);
  const CastHit through = ray({world(), now}, from, {0, -1, 0});
  EXPECT_NE(through.index, now.held);
  EXPECT_GT(through.distance, hit.distance);
}

TEST_F(RayCasterInTheSmallHome, KeepsTheWorldAndKnowsItsOneObjectWithoutDistractors) {
  SimulationOptions options = oneEnv();
  options.task.distractors = false;
  std::optional<RayCaster> caster;
  Vec3 above;
  {
    const SmallHome other;
    BatchSimulator simulator = simulatorOf(other.world(), options);
    const EnvState now = simulator.envState(0);
    ASSERT_EQ(now.objects.size(), 1U);
    above = now.objects[0].translation + Vec3{0, 0.5F, 0};
    caster.emplace(other.world(), now);
  }
  const RayCaster copy = *caster;
  caster.reset();
  EXPECT_EQ(ray(copy, above, {0, -1, 0}).index, 0);
  EXPECT_NEAR(ray(copy, above, {0, -1, 0}).distance, 0.4F, 1e-4F);
}

TEST_F(RayCasterInTheSmallHome, AnswersTheSameInAnyThreadAndAnyBatch) {
  std::mt19937 random(kSeed);
  const RayCaster caster(world(), state(), CastRobot::kIsSeen);
  const Lines lines = randomLines(1500, random);
  const std::vector<CastHit> one = rays(caster, lines);
  EXPECT_EQ(one, rays(caster, lines, 3));
  EXPECT_EQ(one, rays(caster, lines, 0));
  EXPECT_EQ(sweeps(caster, 0.05F, lines), sweeps(caster, 0.05F, lines, 3));
  for (std::size_t n = 0; n < one.size(); n += 50) {
    EXPECT_EQ(ray(caster, lines.origins[n], lines.directions[n], lines.lengths[n]), one[n]);
  }
  EXPECT_TRUE(rays(caster, {}).empty());
}

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const ErrorException& refused) {
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidInput);
    return refused.error().where + ": " + refused.error().message;
  }
  return "";
}

TEST_F(RayCasterInTheSmallHome, FindsSpheresFreeThatTouchNothing) {
  SimulationOptions options;
  options.envs = 1;
  const BatchSimulator batch = BatchSimulator::create(world(), options).value();
  const RayCaster caster(world(), batch.envState(0), CastRobot::kIsSeen);
  std::minstd_rand random(7);
  std::uniform_real_distribution<float> number(-0.2F, 3.2F);
  Lines lines;
  constexpr std::size_t kCount = 2000;
  for (std::size_t n = 0; n < kCount; ++n) {
    lines.add({number(random), number(random) * 0.4F, number(random)}, {0, -1, 0});
  }
  std::ranges::fill(lines.lengths, 0.0F);
  for (const float radius : world().radii()) {
    std::vector<CastHit> hits(kCount);
    caster.sweepSpheres(radius, lines.view(), hits);
    std::vector<std::uint8_t> free(kCount, 2);
    caster.areSpheresFree(radius, lines.origins, free, 2);
    std::size_t count = 0;
    for (std::size_t n = 0; n < kCount; ++n) {
      EXPECT_EQ(free[n], hits[n].end == CastEnd::kNothing ? 1 : 0);
      count += free[n];
    }
    EXPECT_GE(count, kCount / 10);
    EXPECT_LE(count, kCount - kCount / 10);
  }
  std::vector<std::uint8_t> free(1, 2);
  const std::vector<Vec3> nowhere{{1, std::nanf(""), 1}};
  EXPECT_EQ(refusal([&] { caster.areSpheresFree(0.05F, nowhere, free); }),
            "RayCaster::areSpheresFree: centers[0] holds a number that is not finite");
  EXPECT_EQ(refusal([&] { caster.areSpheresFree(0.05F, lines.origins, free); }),
            "RayCaster::areSpheresFree: \"free\" has the length 1, expected 2000");
  EXPECT_EQ(refusal([&] { caster.areSpheresFree(0.03F, std::span(lines.origins).first(1), free); }),
            "RayCaster::areSpheresFree: found the radius 0.03 m, expected one that the scene has a "
            "grid for: 0.016, 0.05, 0.12");
  EXPECT_EQ(free[0], 2);
}

TEST_F(RayCasterInTheSmallHome, RefusesWhatIsNoLine) {
  const RayCaster caster(world().scenes()[0]);
  const auto refused = [&](const Vec3& origin, const Vec3& direction, float length) {
    Lines lines;
    lines.add({1, 1, 1}, {1, 0, 0});
    lines.add(origin, direction, length);
    std::vector<CastHit> hits(2, CastHit{77});
    const std::string text = refusal([&] { caster.castRays(lines.view(), hits); });
    EXPECT_EQ(hits[0].distance, 77) << "nothing is written";
    return text;
  };
  const float nan = std::nanf("");
  EXPECT_EQ(refused({nan, 1, 1}, {1, 0, 0}, 1),
            "RayCaster::castRays: origins[1] holds a number that is not finite");
  EXPECT_EQ(refused({1, kInfinity, 1}, {1, 0, 0}, 1),
            "RayCaster::castRays: origins[1] holds a number that is not finite");
  EXPECT_EQ(refused({1, 1, 1}, {1, nan, 0}, 1),
            "RayCaster::castRays: directions[1] holds a number that is not finite");
  EXPECT_EQ(refused({1, 1, 1}, {1, 0, -kInfinity}, 1),
            "RayCaster::castRays: directions[1] holds a number that is not finite");
  EXPECT_EQ(refused({1, 1, 1}, {0, -0.0F, 0}, 1),
            "RayCaster::castRays: directions[1] is zero, and leads nowhere");
  EXPECT_EQ(refused({1, 1, 1}, {0, 1, 0}, -1),
            "RayCaster::castRays: lengths[1] is -1, expected 0 or more meters");
  EXPECT_EQ(refused({1, 1, 1}, {0, 1, 0}, nan),
            "RayCaster::castRays: lengths[1] is nan, expected 0 or more meters");
}

TEST_F(RayCasterInTheSmallHome, RefusesCallsThatDoNotFit) {
  const RayCaster caster(world().scenes()[0]);
  Lines lines;
  lines.add({1, 1, 1}, {1, 0, 0});
  std::vector<CastHit> hits(1);
  const auto sweep = [&](float radius) {
    return refusal([&] { caster.sweepSpheres(radius, lines.view(), hits); });
  };
  EXPECT_EQ(sweep(0.05F), "");
  EXPECT_EQ(sweep(0.03F),
            "RayCaster::sweepSpheres: found the radius 0.03 m, expected one that the scene has a "
            "grid for: 0.016, 0.05, 0.12");
  EXPECT_THAT(sweep(std::nanf("")), testing::HasSubstr("found the radius nan m"));
  hits.resize(2);
  EXPECT_EQ(sweep(0.05F), "RayCaster::sweepSpheres: \"hits\" has the length 2, expected 1");
  lines.lengths.push_back(1);
  EXPECT_EQ(sweep(0.05F), "RayCaster::sweepSpheres: \"lengths\" has the length 2, expected 1");
  lines.directions.clear();
  EXPECT_EQ(sweep(0.05F), "RayCaster::sweepSpheres: \"directions\" has the length 0, expected 1");
}

TEST_F(RayCasterInTheSmallHome, CastsInAllEnvsAsInEachOfThem) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937 random(kSeed);
  SimulationOptions options;
  options.envs = 3;
  options.order = EpisodeOrder::kLinear;
  const BatchSimulator batch = BatchSimulator::create(world(), options).value();
  constexpr std::size_t kEach = 200;
  const Lines lines = randomLines(batch.envCount() * kEach, random);
  for (const CastRobot robot : {CastRobot::kIsUnseen, CastRobot::kIsSeen}) {
    std::vector<CastHit> wanted_rays;
    std::vector<CastHit> wanted_sweeps;
    std::set<CastEnd> ends;
    for (std::size_t env = 0; env < batch.envCount(); ++env) {
      const RayCaster caster(world(), batch.envState(env), robot);
      Lines own;
      for (std::size_t n = env * kEach; n < (env + 1) * kEach; ++n) {
        own.add(lines.origins[n], lines.directions[n], lines.lengths[n]);
      }
      for (const CastHit& hit : rays(caster, own)) {
        wanted_rays.push_back(hit);
        ends.insert(hit.end);
      }
      for (const CastHit& hit : sweeps(caster, 0.05F, own)) wanted_sweeps.push_back(hit);
    }
    EXPECT_TRUE(ends.contains(CastEnd::kObject)) << "else objects play no part";
    EXPECT_EQ(ends.contains(CastEnd::kRobot), robot == CastRobot::kIsSeen);
    for (const std::uint32_t threads : {0U, 1U, 2U, 7U}) {
      std::vector<CastHit> hits(lines.origins.size());
      castRaysInEnvs(batch, lines.view(), hits, robot, threads);
      EXPECT_EQ(hits, wanted_rays) << threads;
      sweepSpheresInEnvs(batch, 0.05F, lines.view(), hits, robot, threads);
      EXPECT_EQ(hits, wanted_sweeps) << threads;
    }
  }
}

TEST_F(RayCasterInTheSmallHome, RefusesLinesThatDoNotFitTheEnvs) {
  SimulationOptions options;
  options.envs = 2;
  const BatchSimulator batch = BatchSimulator::create(world(), options).value();
  Lines lines;
  std::vector<CastHit> hits;
  const auto cast = [&] { return refusal([&] { castRaysInEnvs(batch, lines.view(), hits); }); };
  EXPECT_EQ(cast(), "") << "no line in any env";
  lines.add({1, 1, 1}, {1, 0, 0});
  hits.resize(1, CastHit{77});
  EXPECT_EQ(cast(), "castRaysInEnvs: found 1 lines for 2 envs, expected as many for each");
  lines.add({1, 1, 1}, {0, 0, 0});
  hits.resize(2, CastHit{77});
  EXPECT_EQ(cast(), "castRaysInEnvs: directions[1] is zero, and leads nowhere");
  EXPECT_EQ(hits[0].distance, 77) << "nothing is written";
  lines.directions[1] = {1, 0, 0};
  EXPECT_EQ(refusal([&] { sweepSpheresInEnvs(batch, 0.03F, lines.view(), hits); }),
            "sweepSpheresInEnvs: found the radius 0.03 m, expected one that the scene has a grid "
            "for: 0.016, 0.05, 0.12");
  EXPECT_EQ(hits[0].distance, 77) << "nothing is written";
}

TEST_F(RayCasterInTheSmallHome, RefusesBatchesInAHalfStep) {
  SimulationOptions options;
  options.envs = 40;
  options.threads = 2;
  BatchSimulator batch = BatchSimulator::create(world(), options).value();
  Lines lines;
  for (std::size_t n = 0; n < batch.envCount(); ++n) lines.add({1, 1, 1}, {1, 0, 0});
  std::vector<CastHit> hits(lines.origins.size(), CastHit{77});
  const std::vector<float> actions(batch.envCount() * batch.actionCount());
  batch.beginStep(actions);
  for (const std::uint32_t threads : {1U, 4U}) {
    const std::string message = "found a step that has begun; end it first, with endStep()";
    EXPECT_EQ(
        refusal([&] { castRaysInEnvs(batch, lines.view(), hits, CastRobot::kIsUnseen, threads); }),
        "castRaysInEnvs: " + message);
    EXPECT_EQ(refusal([&] {
                sweepSpheresInEnvs(batch, 0.05F, lines.view(), hits, CastRobot::kIsUnseen, threads);
              }),
              "sweepSpheresInEnvs: " + message);
  }
  EXPECT_EQ(hits, std::vector<CastHit>(hits.size(), CastHit{77})) << "nothing is written";
  batch.endStep();
  castRaysInEnvs(batch, lines.view(), hits);
  EXPECT_NE(hits[0].distance, 77);
}

}  // namespace
}  // namespace galactic::test::ray_caster_test
