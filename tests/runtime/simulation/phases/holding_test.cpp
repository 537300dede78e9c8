// What the hand holds is kept out of the scene, too, wherever the robot is moved to, except for
// what was in the scene already when the hand took it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <random>
#include <vector>

#include "simulation/collision/collision.h"
#include "simulation/phases/slide.h"
#include "simulation/simulator/saved_state.h"
#include "support/homes/box_world.h"
#include "support/homes/one_robot.h"
#include "support/oracles/resting_oracle.h"

namespace galactic::test::holding_test {
namespace {

using namespace galactic::simulation;

/// A corridor from x = 0.1 m to 0.9 m, in which a cart with a cube can hardly turn, and a room from
/// there to x = 2 m.
std::vector<Block> blocks() {
  return {plainFloor(),
          {{0, 0, 0}, {0.1F, 2, 3}},
          {{0.9F, 0, 0}, {1, 2, 3}},
          {{2, 0, 0}, {2.1F, 2, 3}}};
}
const Start kStart{.base = {0.5F, 0, 0.5F}, .objects = {{1.5F, 0.5F, 2.5F}}};

/// The cart with a mast, so that maps know of heights at which the cube is held.
RobotPackFields cartWithMast() {
  RobotPackFields robot = cartRobot();
  robot.spheres.insert(robot.spheres.begin() + 1, {{0, 1, 0}, 2});
  robot.groups[0].sphere_count += 1;
  for (std::size_t n = 1; n < robot.groups.size(); ++n) robot.groups[n].first_sphere += 1;
  return robot;
}

const Model& cartModel() {
  static const BoxWorld world(blocks(), cartWithMast(), episodesFrom({kStart}));
  static const Model model = modelOfOne(world.world());
  return model;
}

/// A cart that a test puts somewhere, with a cube in its hand.
class Cart : public OneRobot {
 public:
  Cart() : OneRobot(cartModel()) {}

  /// The cube is in the hand, so far away from it.
  void hold(const Vec3& away) {
    if (env().held < 0) take(0, kStart.objects[0]);
    holdAt(away);
  }

  Hindrance hindranceHere() {
    lookAtAll(step());
    return hindranceAsSeen(step(), 0);
  }
  Hindrance hindranceAlone() { return hindranceOf(step(), 0); }
  bool slide(Hindrance met) { return slideClear(step(), 0, met); }

  /// As the columns themselves say.
  bool heldIsInScene() { return penetrates(obstaclesOf(step(), 0), heldSpheres(step(), 0)); }
  [[nodiscard]] bool clearsScene() { return chunk().seenHeld(0).clears_scene; }

  /// Goes on from what another one saves.
  void restore(const Cart& other) {
    constexpr std::array<std::uint32_t, 1> kEnv{0};
    const auto bytes = saveEnvs(model(), other.state(), kEnv, 0);
    const Result<SavedState> saved = readState(model(), bytes);
    ASSERT_TRUE(saved) << saved.error().message;
    restoreEnv(model(), state(), 0, saved->envs[0]);
  }
};

TEST(Holding, IsLookedAtWhereTheCandidateIsNow) {
  Cart cart;
  cart.hold({0.3F, 0.1F, 0});
  cart.put(1.3F, 2);
  EXPECT_EQ(cart.hindranceHere(), Hindrance::kNone);
  EXPECT_TRUE(cart.clearsScene());
  // Then in the wall.
  cart.put(1.7F, 2);
  EXPECT_EQ(cart.hindranceAlone(), Hindrance::kHeld);
  EXPECT_FALSE(cart.clearsScene());
  EXPECT_EQ(cart.hindranceHere(), Hindrance::kHeld);
}

TEST(Holding, IsFreeAfterEachSlide) {
  constexpr std::uint32_t kSeed = 1512;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  Cart cart;
  Tally slides;
  Tally sure;
  for (int round = 0; round < 20000; ++round) {
    cart.hold({uniformIn(random, -0.6F, 0.6F), uniformIn(random, 0.05F, 0.3F),
               uniformIn(random, -0.6F, 0.6F)});
    cart.put(uniformIn(random, 0.1F, 0.9F), uniformIn(random, 0.2F, 2.8F));
    const Hindrance met = cart.hindranceHere();
    sure.add(cart.clearsScene());
    if (met == Hindrance::kNone) {
      ASSERT_FALSE(cart.heldIsInScene()) << "round " << round;
      continue;
    }
    const bool is_free = cart.slide(met);
    slides.add(is_free);
    ASSERT_FALSE(is_free && cart.heldIsInScene()) << "round " << round;
  }
  slides.expectBothSides();
  sure.expectBothSides();
}

TEST(Holding, IsPushedOutAlongTheDriveWhereTheDriveIsNotToBlame) {
  Cart cart;
  cart.hold({0.3F, 0.1F, 0});
  ASSERT_TRUE(cart.move(1.45F, 2));
  // As if the arm had reached into the wall while the cart drove back a little.
  cart.holdAt({0.5F, 0.1F, 0});
  cart.put(1.43F, 2);
  const Hindrance met = cart.hindranceHere();
  ASSERT_EQ(met, Hindrance::kHeld);
  EXPECT_TRUE(cart.slide(met));
  EXPECT_FALSE(cart.heldIsInScene());
  EXPECT_LT(cart.chunk().base(0).x, 1.42F);
}

/// Moves a robot whose cube was in the wall when it was taken.
void leaveTheWall(Cart& cart) {
  // What was in the wall does not count; deeper in, more of it would be.
  EXPECT_TRUE(cart.env().ignores);
  EXPECT_TRUE(cart.move(1.5F, 2));
  EXPECT_TRUE(cart.env().ignores);
  EXPECT_FALSE(cart.move(1.65F, 2));
  // Free once, it counts again.
  EXPECT_TRUE(cart.move(1.3F, 2));
  EXPECT_FALSE(cart.env().ignores);
  EXPECT_FALSE(cart.move(1.5F, 2));
}

TEST(Holding, WhatWasInTheSceneWhenItWasTakenCountsOnceItIsFree) {
  Cart cart;
  ASSERT_TRUE(cart.move(1.5F, 2));
  cart.take(0, {1.95F, 0.5F, 2});
  leaveTheWall(cart);
}

TEST(Holding, WhatDoesNotCountYetIsSavedAndRestored) {
  Cart cart;
  ASSERT_TRUE(cart.move(1.5F, 2));
  cart.take(0, {1.95F, 0.5F, 2});
  Cart other;
  other.restore(cart);
  leaveTheWall(other);
}

}  // namespace
}  // namespace galactic::test::holding_test
