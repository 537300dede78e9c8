// What hinders a candidate, and which of several hindrances is told.
#include "simulation/phases/contacts.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/homes/box_world.h"
#include "support/homes/one_robot.h"

namespace galactic::test::contacts_test {
namespace {

using namespace galactic::simulation;

/// A wall from x = 2 m on, a step of 10 cm before z = 0.5 m, and a cube at (1, 2.5).
std::vector<Block> blocks() {
  return {plainFloor(), {{2, 0, 0}, {2.1F, 2, 3}}, {{0, 0, 0}, {3, 0.1F, 0.5F}}};
}
const Start kStart{.base = {1, 0, 1.5F}, .objects = {{1, 0.2F, 2.5F}}};

const Model& cartModel() {
  static const BoxWorld world(blocks(), {kStart});
  static const Model model = modelOfOne(world.world());
  return model;
}

/// The cart, which a test puts somewhere and asks what hinders it there.
class Cart : public OneRobot {
 public:
  Cart() : OneRobot(cartModel()) {}

  /// As a look at one candidate says, and as one at all of a chunk does.
  Hindrance hindrance() {
    const Hindrance alone = hindranceOf(step(), 0);
    lookAtAll(step());
    EXPECT_EQ(hindranceAsSeen(step(), 0), alone);
    EXPECT_EQ(isFree(step(), 0), alone == Hindrance::kNone);
    return alone;
  }
};

TEST(Hindrance, IsNoneInTheOpen) {
  Cart cart;
  cart.put(1, 1.5F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kNone);
}

TEST(Hindrance, IsTheFloorFirst) {
  Cart cart;
  cart.put(1, 0.3F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kRise);
  // Outside, nothing is known of a floor.
  cart.put(-0.1F, 1.5F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kDrop);
  // The wall is there, too.
  cart.put(1.95F, 0.3F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kRise);
}

TEST(Hindrance, IsTheSceneThatBlocksSpheresOfTheRobot) {
  Cart cart;
  cart.put(1.95F, 1.5F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kScene);
  EXPECT_NE(cart.chunk().seen(0).blocked, 0U);
  EXPECT_NE(cart.chunk().seen(0).unsure, 0U);
}

TEST(Hindrance, IsAnObjectWhereTheSceneIsFarAway) {
  Cart cart;
  cart.put(1, 2.35F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kObject);
  cart.put(1, 2.1F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kNone);
}

TEST(Hindrance, IsWhatTheHandHoldsWhereTheRobotItselfIsFree) {
  Cart cart;
  cart.put(1, 2.1F);
  cart.take(0, kStart.objects[0]);
  cart.holdAt({0.5F, -0.1F, 0});
  cart.put(1.2F, 1.5F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kNone);
  // It is in the wall, half a meter ahead of the robot.
  cart.put(1.5F, 1.5F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kHeld);
  // So is the robot.
  cart.put(1.95F, 1.5F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kScene);
}

TEST(Hindrance, OfACandidateLeavesNothingBehindForAnother) {
  Cart cart;
  cart.put(1.95F, 1.5F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kScene);
  cart.put(1, 1.5F);
  EXPECT_EQ(cart.hindrance(), Hindrance::kNone);
  EXPECT_EQ(cart.chunk().seen(0).blocked, 0U);
  EXPECT_EQ(cart.chunk().seen(0).unsure, 0U);
}

}  // namespace
}  // namespace galactic::test::contacts_test
