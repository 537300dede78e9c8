// Where robots get to: floors, walls, corners, objects, by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

#include "galactic/batch_simulator.h"
#include "simulation/phases/move.h"
#include "support/homes/box_world.h"

namespace galactic::test::move_robots_test {
namespace {

using namespace galactic::simulation;

/// Grids round heights to 0.06 mm.
constexpr float kHeightTolerance = 1e-4F;
constexpr float kRounding = 2e-6F;
/// How far beyond the border of a cell a sphere is pushed, and beyond contact with a box.
constexpr float kMargin = 1e-4F;
constexpr float kEighth = std::numbers::pi_v<float> / 4;
/// A column counts from one border of its cell to the other.
constexpr float kCell = BoxRoom::kSpacing;

struct Action {
  float arm = 0;
  float wrist = 0;
  float forward = 0;
  float turn = 0;
};

/// One cart in a room.
class Drive {
 public:
  Drive(std::vector<Block> blocks, const Start& start, const SlideOptions& slide = {},
        const GroundOptions& ground = {})
      : world_(std::move(blocks), {withTarget(start)}) {
    SimulationOptions options;
    options.envs = 1;
    options.threads = 1;
    options.task.kind = TaskKind::kNone;
    options.task.most_steps = 0;
    options.slide = slide;
    options.ground = ground;
    simulator_.emplace(BatchSimulator::create(world_.world(), options).value());
  }

  EnvState step(const Action& action) {
    const std::array<float, kCartActions> actions{
        action.arm, action.wrist, action.forward, action.turn, 0, 0};
    simulator_->step(actions);
    return state();
  }
  [[nodiscard]] EnvState state() const { return simulator_->envState(0); }
  [[nodiscard]] Vec3 at() const { return state().world_from_root.translation; }
  [[nodiscard]] std::uint64_t slid() const { return simulator_->statistics().slid; }
  [[nodiscard]] std::uint64_t refused() const { return simulator_->statistics().refused; }

  /// The step is refused, and everything stays exactly as it was.
  void expectRefused(const Action& action) {
    const EnvState before = state();
    const std::uint64_t count = refused();
    const EnvState after = step(action);
    EXPECT_EQ(refused(), count + 1);
    EXPECT_EQ(after.world_from_root, before.world_from_root);
    EXPECT_EQ(after.world_from_grip, before.world_from_grip);
    EXPECT_EQ(after.joint_positions, before.joint_positions);
  }

 private:
  /// A target far away, where the start has no objects.
  static Start withTarget(Start start) {
    if (start.objects.empty()) start.objects = {{0.25F, 2.5F, 0.25F}};
    return start;
  }

  BoxWorld world_;
  std::optional<BatchSimulator> simulator_;
};

void expectAt(const Drive& drive, const Vec3& wanted) {
  EXPECT_NEAR(drive.at().x, wanted.x, kRounding);
  EXPECT_NEAR(drive.at().y, wanted.y, kHeightTolerance);
  EXPECT_NEAR(drive.at().z, wanted.z, kRounding);
}

TEST(MoveRobots, GlidesAlongAWallUnderACeilingThatIsLowerThanTheHighestRise) {
  // The slab keeps the base from rising; the robot drives as it does without it.
  const std::vector<Block> walls{plainFloor(), {{2, 0, 0}, {2.1F, 0.8F, 3}}};
  std::vector<Block> roofed = walls;
  roofed.push_back({{0, 0.8F, 0}, {3, 1, 3}});
  const Start start{.base = {1.5F, 0, 1}, .yaw = -0.5F};
  Drive open(walls, start);
  Drive low(roofed, start, {}, {.most_rise = 0.85F});
  for (int n = 0; n < 12; ++n) {
    open.step({.forward = 1});
    low.step({.forward = 1});
    expectAt(low, open.at());
  }
  EXPECT_GT(low.slid(), 3U);
  EXPECT_EQ(low.refused(), open.refused());
}

TEST(MoveRobots, DrivesOverAFlatFloor) {
  Drive drive({plainFloor()}, {.base = {1.5F, 0, 1.5F}});
  drive.step({.forward = 1});
  expectAt(drive, {1.6F, 0, 1.5F});
  drive.step({.forward = -0.5F});
  expectAt(drive, {1.55F, 0, 1.5F});
  EXPECT_EQ(drive.slid() + drive.refused(), 0U);
}

TEST(MoveRobots, StandsOnAFloorAtAnotherHeight) {
  Drive drive({{{0, 0, 0}, {3, 0.7F, 3}}}, {.base = {1.5F, 0.7F, 1.5F}});
  drive.step({.forward = 1});
  expectAt(drive, {1.6F, 0.7F, 1.5F});
  Drive dropped({{{0, 0, 0}, {3, 0.7F, 3}}}, {.base = {1.5F, 1.1F, 1.5F}});
  expectAt(dropped, {1.5F, 0.7F, 1.5F});
}

TEST(MoveRobots, ClimbsALowStepAndComesDownAgain) {
  Drive drive({plainFloor(), {{1.6F, 0, 0}, {3, 0.03F, 3}}}, {.base = {1.5F, 0, 1.5F}});
  drive.step({.forward = 1});
  drive.step({.forward = 1});
  expectAt(drive, {1.7F, 0.03F, 1.5F});
  drive.step({.forward = -1});
  drive.step({.forward = -1});
  expectAt(drive, {1.5F, 0, 1.5F});
  EXPECT_EQ(drive.slid() + drive.refused(), 0U);
}

TEST(MoveRobots, StopsInFrontOfAHighStep) {
  // Lower than the cart's ball: it is the base that may not stand there.
  Drive drive({plainFloor(), {{1.6F, 0, 0}, {3, 0.08F, 3}}}, {.base = {1.55F, 0, 1.5F}});
  drive.step({.forward = 1});
  expectAt(drive, {51 * kCell - kMargin, 0, 1.5F});
  EXPECT_EQ(drive.slid(), 1U);
}

TEST(MoveRobots, RefusesADeepDropAndTakesAShallowOne) {
  const Block upper{{0, -0.5F, 0}, {1.6F, 0, 3}};
  Drive deep({upper, {{1.6F, -0.5F, 0}, {3, -0.06F, 3}}}, {.base = {1.55F, 0, 1.5F}});
  deep.expectRefused({.arm = 1, .wrist = 1, .forward = 1, .turn = 0.25F});
  Drive shallow({upper, {{1.6F, -0.5F, 0}, {3, -0.04F, 3}}}, {.base = {1.55F, 0, 1.5F}});
  shallow.step({.forward = 1});
  expectAt(shallow, {1.65F, -0.04F, 1.5F});
}

TEST(MoveRobots, StaysInsideTheGrid) {
  Drive drive({plainFloor()}, {.base = {2.95F, 0, 1.5F}});
  drive.expectRefused({.arm = 1, .forward = 1});
  drive.step({.forward = -1});
  expectAt(drive, {2.85F, 0, 1.5F});
}

/// Columns from 1.88 m on are blocked for the cart's ball: cells from 1.875 m on.
constexpr Block kWall{{2, 0, 0}, {2.1F, 2, 3}};
constexpr float kFreeBefore = 1.875F;

TEST(MoveRobots, SlidesAlongAWall) {
  Drive drive({plainFloor(), kWall}, {.base = {1.8F, 0, 1.5F}, .yaw = -kEighth});
  const float diagonal = 0.1F / std::sqrt(2.0F);
  drive.step({.forward = 1});
  expectAt(drive, {1.8F + diagonal, 0, 1.5F + diagonal});
  EXPECT_EQ(drive.slid(), 0U);
  drive.step({.forward = 1});
  expectAt(drive, {kFreeBefore - kMargin, 0, 1.5F + 2 * diagonal});
  EXPECT_EQ(drive.slid(), 1U);
  drive.step({.forward = 1});
  expectAt(drive, {kFreeBefore - kMargin, 0, 1.5F + 3 * diagonal});
}

TEST(MoveRobots, StaysWhereItIsWhenItMayNotSlide) {
  Drive drive({plainFloor(), kWall}, {.base = {1.85F, 0, 1.5F}, .yaw = -kEighth}, {.attempts = 0});
  drive.expectRefused({.arm = 0.1F, .wrist = 1, .forward = 1, .turn = 0.1F});
  EXPECT_EQ(drive.slid(), 0U);
}

TEST(MoveRobots, GoesIntoACornerAndStaysThere) {
  const Block other{{0, 0, 2}, {3, 2, 2.1F}};
  Drive drive({plainFloor(), kWall, other}, {.base = {1.86F, 0, 1.86F}, .yaw = -kEighth});
  for (int step = 0; step < 3; ++step) {
    drive.step({.wrist = 1, .forward = 1});
    expectAt(drive, {kFreeBefore - kMargin, 0, kFreeBefore - kMargin});
  }
  EXPECT_EQ(drive.slid(), 3U);
  drive.step({.forward = -1});
  EXPECT_LT(drive.at().x, 1.81F);
}

TEST(MoveRobots, IsPushedByAllThatItPenetratesAtOnce) {
  // The cart touches one wall, its arm another. Cells of the arm's ball end at 1.9375 m.
  const Block side{{0, 0, 2}, {1.7F, 2, 2.1F}};
  Drive drive({plainFloor(), kWall, side}, {.base = {1.5F, 0, 1.85F}});
  drive.step({.arm = 1});
  drive.step({.arm = 0.5F});
  EXPECT_EQ(drive.slid(), 1U);
  expectAt(drive, {1.9375F - kMargin - 0.45F, 0, 1.85F});
  drive.step({.turn = -1});
  drive.step({.forward = -1});
  drive.step({.turn = 1});
  EXPECT_EQ(drive.refused(), 0U);
}

TEST(MoveRobots, StopsAtAnObject) {
  // The cube reaches from 1.9 to 2.1 m, as high as the cart's ball.
  Drive drive({plainFloor()}, {.base = {1.7F, 0, 1.5F}, .objects = {{2, 0.2F, 1.5F}}});
  drive.step({.forward = 1});
  expectAt(drive, {1.78F - kMargin, 0, 1.5F});
  EXPECT_EQ(drive.slid(), 1U);
}

/// The arm's end gets 9 cm deep into a cube, whose sides push it 5 cm at a time.
Start beforeACube() { return {.base = {1.69F, 0, 1.5F}, .objects = {{2, 0.2F, 1.5F}}}; }

TEST(MoveRobots, JittersUpToThreeTimes) {
  Drive drive({plainFloor()}, beforeACube());
  const EnvState state = drive.step({.arm = 1});
  EXPECT_EQ(drive.slid(), 1U);
  EXPECT_FLOAT_EQ(state.joint_positions[0], 0.3F);
  // 5 cm, 5 cm, and 4 cm out of contact.
  expectAt(drive, {1.85F - 0.3F - kMargin, 0, 1.5F});
}

TEST(MoveRobots, StaysWhereItIsWhenTheJittersDoNotSuffice) {
  Drive drive({plainFloor()}, beforeACube(), {.attempts = 2});
  drive.expectRefused({.arm = 1, .wrist = 1});
}

TEST(MoveRobots, NeverJittersFartherThanOneStepAtATime) {
  // The same way out in jitters of 4 cm: after three, 2 cm are missing.
  Drive drive({plainFloor()}, beforeACube(), {.step = 0.04F});
  drive.expectRefused({.arm = 1});
  Drive longer({plainFloor()}, beforeACube(), {.attempts = 4, .step = 0.04F});
  longer.step({.arm = 1});
  expectAt(longer, {1.85F - 0.3F - kMargin, 0, 1.5F});
}

TEST(MoveRobots, IsPushedTowardsItsBaseInThePublishedVariant) {
  // The arm's ball may be before 1.9375 m; it is 4 cm further, then 8.
  const SlideOptions published{
      .attempts = 5, .direction = SlideDirection::kTowardsBase, .step = 0.05F};
  Drive drive({plainFloor(), kWall}, {.base = {1.6775F, 0, 1.5F}}, published);
  drive.step({.arm = 1});
  EXPECT_EQ(drive.slid(), 1U);
  expectAt(drive, {1.6275F, 0, 1.5F});
  Drive twice({plainFloor(), kWall}, {.base = {1.7175F, 0, 1.5F}}, published);
  twice.step({.arm = 1});
  expectAt(twice, {1.6175F, 0, 1.5F});
}

TEST(MoveRobots, BeginsWithTheLastSphereAndThenWithTheFirstInThePublishedVariant) {
  const SlideOptions published{
      .attempts = 8, .direction = SlideDirection::kTowardsBase, .step = 0.05F};
  // The cart's ball is 5 mm in the wall, the arm's 10 cm: the arm gives the direction, and its
  // first push frees the cart.
  Drive drive({plainFloor(), kWall}, {.base = {1.85F, 0, 1.5F}}, published);
  drive.step({.arm = 0.5F, .forward = 0.35F});
  EXPECT_EQ(drive.slid(), 1U);
  expectAt(drive, {1.785F, 0, 1.5F});
  // 7 cm in, the cart is still in the wall when it is asked first, and has no direction.
  Drive deeper({plainFloor(), kWall}, {.base = {1.85F, 0, 1.5F}}, published);
  deeper.expectRefused({.arm = 0.5F, .forward = 1});
}

TEST(MoveRobots, IsNotPushedTowardsItsBaseByTheBaseItself) {
  const SlideOptions published{
      .attempts = 5, .direction = SlideDirection::kTowardsBase, .step = 0.05F};
  Drive drive({plainFloor(), kWall}, {.base = {1.85F, 0, 1.5F}}, published);
  drive.expectRefused({.forward = 1});
}

TEST(MoveRobots, PushesAnArmOutAlongTheDriveWhereTheDriveIsNotToBlame) {
  // The arm's ball is blocked from 1.95 m on, and would come to 2.03.
  Drive drive({plainFloor(), {{2, 0, 0}, {2.1F, 2, 3}}}, {.base = {1.6F, 0, 1.5F}});
  drive.step({.arm = 1});
  const float before = drive.at().x;
  drive.step({.arm = 0.5F, .forward = -0.2F});
  EXPECT_EQ(drive.refused(), 0U);
  EXPECT_EQ(drive.slid(), 1U);
  EXPECT_LT(drive.at().x, before - 0.06F);
  EXPECT_NEAR(drive.at().z, 1.5F, kRounding);
}

}  // namespace
}  // namespace galactic::test::move_robots_test
