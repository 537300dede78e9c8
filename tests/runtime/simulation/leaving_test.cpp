// What the hand lets go of inside the robot does not hold the robot fast, however many objects it
// is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <vector>

#include "simulation/phases/episode_start.h"
#include "simulation/phases/hand.h"
#include "simulation/phases/move.h"
#include "simulation/state/grip_frame.h"
#include "support/homes/small_home.h"
#include "support/oracles/resting_oracle.h"

namespace galactic::test::leaving_test {
namespace {

using namespace galactic::simulation;

constexpr std::uint32_t kObjects = 9;

/// One episode with many objects on the table.
WorldFields crowdedTable() {
  WorldFields world = smallHomeWorld();
  constexpr float kTop = 0.701F;
  constexpr float kApart = 0.102F;
  world.episodes.placements.clear();
  world.episodes.start_positions.clear();
  world.episodes.episodes.clear();
  for (int n = 0; n < static_cast<int>(kObjects); ++n) {
    const float x = 1.1F + kApart * static_cast<float>(n % 3);
    const float z = 1.4F + kApart * static_cast<float>(n / 3);
    world.episodes.placements.push_back({0, {{x, kTop, z}, {}}});
  }
  world.episodes.start_positions = {0, 0.25F};
  world.episodes.episodes = {{.scene = 0,
                              .first_placement = 0,
                              .placement_count = kObjects,
                              .target = 0,
                              .base_position = {0.65F, 0, 1.5F},
                              .base_yaw = 0,
                              .goal = {{1.2F, kTop, 1.2F}, {}}}};
  return world;
}

/// One robot, whose hand holds what a test puts into it.
class Hand {
 public:
  explicit Hand(const Model& model) : model_(model), state_(model, 1), chunk_(model) {
    for (std::size_t n = 0; n < state_.paddedCount(); ++n) beginEpisode(model, state_, n, 0);
  }

  [[nodiscard]] const Env& env() const { return state_.env(0); }
  [[nodiscard]] std::uint32_t slides() const { return state_.counters(0).slid; }
  [[nodiscard]] Vec3 base() const { return state_.base(0); }

  /// Lets go of an object that rested, at `place`.
  void release(std::uint32_t object, const Vec3& place) {
    Env& env = state_.env(0);
    state_.resting(0).remove(object);
    const Pose there{place, {}};
    env.held = static_cast<std::int32_t>(object);
    state_.held(0).grip_from_object = inverse(gripPose(state_.grip(0))) * there;
    // Where the object goes back to if it can rest nowhere.
    state_.placeObject(0, object, there);
    measureHeld(heldModel(model_, env), state_.held(0));
    std::ranges::fill(chunk_.actions(), EnvRow{});
    chunk_.action(kHand, 0) = -1;
    useHands(step());
    ASSERT_LT(env.held, 0);
  }

  /// A step with these actions of the base, apart from the hand.
  void drive(float forward, float turn) {
    std::ranges::fill(chunk_.actions(), EnvRow{});
    chunk_.action(kForward, 0) = forward;
    chunk_.action(kTurn, 0) = turn;
    proposePoses(step());
    followFloor(step());
    placeBodies(step());
    moveRobots(step());
  }

 private:
  [[nodiscard]] ChunkStep step() { return {model_, state_, chunk_, 0}; }

  const Model& model_;
  BatchState state_;
  Chunk chunk_;
};

/// Releases some objects in and around the robot's base.
void releaseAround(Hand& hand, std::mt19937& random) {
  const std::uint32_t count = 2 + static_cast<std::uint32_t>(random() % 4);
  for (std::uint32_t object = 0; object < count; ++object) {
    const Vec3 base = hand.base();
    hand.release(object, {base.x + uniformIn(random, -0.2F, 0.2F), base.y + 0.02F,
                          base.z + uniformIn(random, -0.2F, 0.2F)});
  }
}

class Leaving : public testing::Test {
 protected:
  void SetUp() override {
    path_ = writeWorld(folder_, crowdedTable());
    Result<World> world = World::open(std::span(&path_, 1));
    ASSERT_TRUE(world) << world.error().message;
    world_ = std::make_unique<World>(std::move(*world));
    SimulationOptions options;
    options.envs = 1;
    options.task.kind = TaskKind::kNone;
    Result<Model> model = makeModel(*world_, options);
    ASSERT_TRUE(model) << model.error().message;
    model_ = std::make_unique<Model>(std::move(*model));
  }

  ScratchFolder folder_;
  std::filesystem::path path_;
  std::unique_ptr<World> world_;
  std::unique_ptr<Model> model_;
};

TEST_F(Leaving, ARobotThatStandsStillIsNeverRefusedWhateverItLetGoOf) {
  constexpr std::uint32_t kSeed = 1510;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally several;
  for (int round = 0; round < 400; ++round) {
    Hand hand(*model_);
    releaseAround(hand, random);
    several.add(hand.env().left > 1);
    const std::uint32_t left = hand.env().left;
    hand.drive(0, 0);
    ASSERT_FALSE(hand.env().refused) << "round " << round << ", leaves " << left;
    ASSERT_EQ(hand.slides(), 0U) << "round " << round << ", leaves " << left;
    ASSERT_EQ(hand.env().left, left);
  }
  several.expectBothSides();
}

TEST_F(Leaving, AnObjectThatTheRobotIsFreeOfCountsAgain) {
  constexpr std::uint32_t kSeed = 1511;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Tally left;
  for (int round = 0; round < 200; ++round) {
    Hand hand(*model_);
    releaseAround(hand, random);
    std::uint32_t before = hand.env().left;
    for (int n = 0; n < 5; ++n) {
      hand.drive(uniformIn(random, -1, 1), uniformIn(random, -1, 1));
      // Never more than before: what counts again goes on counting.
      ASSERT_LE(hand.env().left, before);
      before = hand.env().left;
    }
    left.add(before == 0);
  }
  left.expectBothSides();
}

}  // namespace
}  // namespace galactic::test::leaving_test
