// The search for a way of the base, on floors made for it.
#include "scripted/floor_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "scripted_world.h"

namespace galactic::test::floor_search_test {
namespace {

using scripted::BaseRoute;
using scripted::FloorSearch;
using scripted::Joints;
using Verdict = FloorSearch::Verdict;

/// A room of 4 m by 3 m, cut at x = 2 m by a wall with a door of `door` meters at z = 1.5 m.
MeshBuilder twoRooms(float door) {
  MeshBuilder room = madeRoom(4, 3);
  constexpr float kMiddle = 1.5F;
  room.box({1.95F, 0, 0}, {2.05F, 2.5F, kMiddle - door / 2});
  room.box({1.95F, 0, kMiddle + door / 2}, {2.05F, 2.5F, 3});
  return room;
}

/// A blind alley: walls on three sides of the straight way from (0.5, 1.5) to (3.5, 1.5).
MeshBuilder deadEnd() {
  MeshBuilder room = madeRoom(4, 3);
  room.box({2.2F, 0, 0.7F}, {2.3F, 2.5F, 2.3F});
  room.box({1, 0, 0.7F}, {2.3F, 2.5F, 0.8F});
  room.box({1, 0, 2.2F}, {2.3F, 2.5F, 2.3F});
  return room;
}

/// One robot on one floor, with where it wants to go.
class Floor {
 public:
  Floor(const MeshBuilder& room, const Vec3& from, const Vec3& to,
        const RobotPackFields& robot = stickRobot())
      : made_(stickWorld(room.build(), from, to, to, robot)), scene_(made_.world(), {}) {
    EnvState state;
    state.objects = {{to, {}}};
    state.world_from_root.translation = from;
    const auto start = made_.world().robot().startPositions();
    joints_.assign(start.begin(), start.end());
    state.joint_positions = joints_;
    scene_.update(state);
    start_ = {from, 0.3F};
    target_ = to;
  }

  FloorSearch::Answer search() {
    return search([](const BasePlace&) { return Verdict::kAccepted; });
  }
  FloorSearch::Answer search(const FloorSearch::Judge& judge) {
    FloorSearch search(scene_, made_.world().robot());
    return search.search(start_, joints_, {.point = target_}, judge);
  }
  /// With this much memory, once and from a little further on each time.
  FloorSearch::Answer searchWithin(std::size_t most_bytes, int times = 1) {
    FloorSearch search(scene_, made_.world().robot(), most_bytes);
    FloorSearch::Answer answer;
    for (int n = 0; n < times; ++n) {
      BasePlace from = start_;
      from.position.x += 0.02F * static_cast<float>(n);
      answer = search.search(from, joints_, {.point = target_},
                             [](const BasePlace&) { return Verdict::kAccepted; });
      EXPECT_LE(search.memoryBytes(), 2 * most_bytes);
    }
    return answer;
  }

  /// Checks that each leg is a turn or a drive, and that no pose on the way penetrates anything.
  /// Returns meters driven.
  float follow(const BaseRoute& route) {
    // Finer than actions, so some poses here were not looked at; the radius of the base's sphere
    // and the cells of the grid let through this much.
    constexpr float kBetween = 0.02F;
    float driven = 0;
    BasePlace at = start_;
    scene_.setJoints(joints_);
    for (const BasePlace& next : route) {
      const Vec3 way = next.position - at.position;
      const float length = std::sqrt(way.x * way.x + way.z * way.z);
      const float turn = std::fabs(std::remainder(next.yaw - at.yaw, 6.2831853F));
      EXPECT_TRUE(length < 1e-3F || turn < 1e-3F) << "a leg turns and drives at once";
      if (length > 1e-3F) {
        const Vec3 heading = headingOf(at.yaw);
        EXPECT_NEAR(std::fabs(dot(way, heading)), length, 1e-3F) << "a drive sideways";
      }
      const int pieces = 1 + static_cast<int>(length / kBetween);
      for (int n = 1; n <= pieces; ++n) {
        const float share = static_cast<float>(n) / static_cast<float>(pieces);
        EXPECT_TRUE(scene_.isFree({at.position + way * share, next.yaw}));
      }
      driven += length;
      at = next;
    }
    return driven;
  }

 private:
  ScriptedWorld made_;
  PlanningScene scene_;
  Joints joints_;
  BasePlace start_;
  Vec3 target_;
};

constexpr Vec3 kWest{0.53F, 0, 0.57F};
constexpr Vec3 kEast{3.4F, 0.5F, 2.4F};

TEST(FloorSearch, GoesThroughADoor) {
  Floor floor(twoRooms(0.7F), kWest, kEast);
  const FloorSearch::Answer answer = floor.search();
  ASSERT_EQ(answer.outcome, FloorSearch::Outcome::kFound);
  const float straight = 2.9F;
  const float driven = floor.follow(answer.route);
  EXPECT_GT(driven, straight - 1.0F);
  EXPECT_LT(driven, 2 * straight);
  const Vec3 end = answer.route.back().position;
  EXPECT_LE(std::hypot(end.x - kEast.x, end.z - kEast.z), 1.0F + 1e-4F);
}

TEST(FloorSearch, GoesThroughADoorOnlyAFinerLatticeFits) {
  // Centers of the base's sphere of 12 cm fit through 1 to 4 cm here: one in ten coarse doors.
  int found = 0;
  for (int n = 0; n < 5; ++n) {
    Floor floor(twoRooms(0.32F + 0.02F * static_cast<float>(n)), kWest, kEast);
    const FloorSearch::Answer answer = floor.search();
    if (answer.outcome != FloorSearch::Outcome::kFound) continue;
    ++found;
    floor.follow(answer.route);
  }
  EXPECT_GE(found, 3);
}

TEST(FloorSearch, NeedsNoMoreRoomForRobotsOfSmallSteps) {
  // A lattice of cells of a micrometer would have 10^13 of them, or as many headings.
  RobotPackFields slow = stickRobot();
  slow.base->forward_step = 1e-6F;
  RobotPackFields turns_slowly = stickRobot();
  turns_slowly.base->turn_step = 1e-9F;
  for (const RobotPackFields& robot : {slow, turns_slowly}) {
    Floor floor(twoRooms(0.7F), kWest, kEast, robot);
    const FloorSearch::Answer answer = floor.search();
    ASSERT_EQ(answer.outcome, FloorSearch::Outcome::kFound);
    EXPECT_LT(floor.follow(answer.route), 6.0F);
  }
}

TEST(FloorSearch, SaysThatThereIsNoWay) {
  Floor floor(twoRooms(0.2F), kWest, kEast);
  EXPECT_EQ(floor.search().outcome, FloorSearch::Outcome::kNoWay);
}

TEST(FloorSearch, GetsOutOfADeadEnd) {
  const Vec3 to{3.6F, 0.5F, 1.5F};
  Floor floor(deadEnd(), {1.6F, 0, 1.5F}, to);
  const FloorSearch::Answer answer = floor.search();
  ASSERT_EQ(answer.outcome, FloorSearch::Outcome::kFound);
  // Out to x < 1 m and round the walls.
  EXPECT_GT(floor.follow(answer.route), 2.5F);
}

TEST(FloorSearch, TellsPlacesThatAreNotWantedFromNoWay) {
  const ScriptedWorld made = stickWorld(madeRoom(3, 3).build(), kWest, {2, 0.5F, 2}, {});
  PlanningScene scene(made.world(), {});
  EnvState state;
  const auto start = made.world().robot().startPositions();
  state.objects = {{{2, 0.5F, 2}, {}}};
  state.joint_positions = {start.begin(), start.end()};
  scene.update(state);
  FloorSearch search(scene, made.world().robot());
  int offers = 0;
  const auto answer = search.search({kWest, 0}, {start.begin(), start.end()},
                                    {.point = {2, 0.5F, 2}}, [&](const BasePlace& place) {
                                      ++offers;
                                      const Vec3 way = Vec3{2, 0, 2} - place.position;
                                      const float distance = std::sqrt(dot(way, way));
                                      EXPECT_GE(distance, 0.35F - 1e-4F);
                                      EXPECT_LE(distance, 1.0F + 1e-4F);
                                      return Verdict::kRejected;
                                    });
  EXPECT_EQ(answer.outcome, FloorSearch::Outcome::kNotAccepted);
  EXPECT_GT(offers, 10);
}

TEST(FloorSearch, OffersPlacesWithTheTargetOnTheWantedSide) {
  // Offered headings are up to 0.87 rad off, and rounded to a turn's step.
  constexpr float kMostBeside = 0.87F + 0.03F;
  const Vec3 to{2, 0.5F, 2};
  for (const float bearing : {0.0F, -1.5707963F, 2.0F}) {
    const ScriptedWorld made = stickWorld(madeRoom(4, 4).build(), kWest, to, {});
    PlanningScene scene(made.world(), {});
    EnvState state;
    const auto start = made.world().robot().startPositions();
    state.objects = {{to, {}}};
    state.joint_positions = {start.begin(), start.end()};
    scene.update(state);
    FloorSearch search(scene, made.world().robot());
    int offers = 0;
    const auto answer = search.search(
        {kWest, 0}, {start.begin(), start.end()}, {.point = to, .bearing = bearing},
        [&](const BasePlace& place) {
          ++offers;
          const Vec3 way = to - place.position;
          const float seen = std::atan2(-way.z, way.x) - place.yaw;
          EXPECT_LE(std::fabs(std::remainder(seen - bearing, 6.2831853F)), kMostBeside);
          return Verdict::kRejected;
        });
    EXPECT_EQ(answer.outcome, FloorSearch::Outcome::kNotAccepted);
    EXPECT_GT(offers, 100);
  }
}

TEST(FloorSearch, OffersNothingMoreOnAnyLatticeToAJudgeWhoHasEnough) {
  Floor floor(twoRooms(0.7F), kWest, kEast);
  int offers = 0;
  const FloorSearch::Answer answer = floor.search([&](const BasePlace&) {
    ++offers;
    return offers < 5 ? Verdict::kRejected : Verdict::kEnough;
  });
  EXPECT_EQ(answer.outcome, FloorSearch::Outcome::kGivenUp);
  EXPECT_TRUE(answer.route.empty());
  EXPECT_EQ(offers, 5);
}

TEST(FloorSearch, KeepsToItsMemoryAndSearchesAsFarAsThatSuffices) {
  // A cell of 10 cm takes some 150 bytes, with headings 0.1 rad apart; the whole hall has 40,000.
  MeshBuilder hall = madeRoom(20, 20);
  Floor near(hall, {10.03F, 0, 10.02F}, {11.5F, 0.5F, 11.5F});
  constexpr std::size_t kSome = 400'000;
  const FloorSearch::Answer answer = near.searchWithin(kSome, 12);
  ASSERT_EQ(answer.outcome, FloorSearch::Outcome::kFound);
  Floor far(hall, {1.03F, 0, 1.02F}, {18.5F, 0.5F, 18.5F});
  EXPECT_EQ(far.searchWithin(kSome).outcome, FloorSearch::Outcome::kNoWay);
  EXPECT_EQ(far.searchWithin(FloorSearch::kMostBytes).outcome, FloorSearch::Outcome::kFound);
}

TEST(FloorSearch, EndsWhereTheAnswerTurnedThePlace) {
  Floor floor(twoRooms(0.7F), kWest, kEast);
  constexpr float kTurn = 0.123F;
  float offered = 0;
  const FloorSearch::Answer answer = floor.search([&](BasePlace& place) {
    offered = place.yaw;
    place.yaw += kTurn;
    return Verdict::kAccepted;
  });
  ASSERT_EQ(answer.outcome, FloorSearch::Outcome::kFound);
  EXPECT_EQ(answer.route.back().yaw, offered + kTurn);
  floor.follow(answer.route);
}

}  // namespace
}  // namespace galactic::test::floor_search_test
