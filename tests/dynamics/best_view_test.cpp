// Where the camera stands that shows what a moment is about.
#include "dynamics/report/best_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "galactic/batch_simulator.h"
#include "support/homes/small_home_models.h"

namespace galactic::test::best_view_test {
namespace {

using dynamics::BestView;
using dynamics::PictureSubject;
using dynamics::Still;

/// Where the target of the first episode is.
constexpr Vec3 kTarget{1.15F, 0.75F, 1.5F};
/// The sides of a niche around it that are walled up.
enum Side : std::size_t { kFront, kBack, kLeft, kRight, kSides };

/// A roof over the target and a wall on each side but those that are open.
std::vector<Block> nicheWithout(const std::vector<Side>& open) {
  constexpr float kNear = 0.12F;
  constexpr float kFar = 0.17F;
  constexpr float kBottom = 0.7F;
  constexpr float kTop = 1.1F;
  const auto [x, y, z] = kTarget;
  const std::array<Block, kSides> walls{
      {{{x - kFar, kBottom, z - kFar}, {x - kNear, kTop, z + kFar}},
       {{x + kNear, kBottom, z - kFar}, {x + kFar, kTop, z + kFar}},
       {{x - kFar, kBottom, z - kFar}, {x + kFar, kTop, z - kNear}},
       {{x - kFar, kBottom, z + kNear}, {x + kFar, kTop, z + kFar}}}};
  std::vector<Block> niche{{{x - kFar, kTop, z - kFar}, {x + kFar, kTop + 0.05F, z + kFar}}};
  for (std::size_t side = 0; side < kSides; ++side) {
    if (std::ranges::find(open, side) == open.end()) niche.push_back(walls[side]);
  }
  return niche;
}

/// The small home with these blocks besides.
WorldFields homeWith(const std::vector<Block>& more) {
  WorldFields world = smallHomeWorldWithModels();
  std::vector<Block> blocks{{{0, -0.25F, 0}, {3, 0, 3}}, {{1, 0, 1}, {2, 0.7F, 2}}};
  std::vector<std::pair<std::uint32_t, RenderSurface>> models{
      {0, boxModel({{0, 0, 0}, {3, 2.5F, 3}}, 0, true)}, {0, boxModel(blocks[1], 1)}};
  for (const Block& block : more) {
    blocks.push_back(block);
    models.emplace_back(0, boxModel(block, 1));
  }
  world.scene = BoxRoom(blocks).fields(world.objects.radii);
  world.scene.render_meshes = modelsOf(models, {kRoomColor, kTableColor});
  return world;
}

/// The first episode of such a home as it begins.
class Seen {
 public:
  explicit Seen(const std::vector<Side>& open) : Seen(nicheWithout(open)) {}
  explicit Seen(const std::vector<Block>& blocks) : home_(homeWith(blocks)) {
    SimulationOptions options;
    options.envs = 1;
    options.threads = 1;
    options.body_transforms = true;
    auto simulator = BatchSimulator::create(home_.world(), options).value();
    simulator.reset(std::vector<std::int32_t>{0});
    best_ = BestView::create(home_.world(), simulator).value();
    still_ = best_->take(simulator);
  }

  [[nodiscard]] BestView& best() { return *best_; }
  [[nodiscard]] const Still& still() const { return still_; }

  /// Pixels of this color.
  [[nodiscard]] std::size_t count(std::uint32_t color, const Still& still,
                                  const RenderCamera& camera) {
    const DrawnImage image = best_->draw(still, camera);
    std::size_t found = 0;
    for (std::size_t n = 0; n < image.color.size(); n += sizeof(color)) {
      if (std::memcmp(&image.color[n], &color, sizeof(color)) == 0) ++found;
    }
    return found;
  }

 private:
  SmallHome home_;
  std::unique_ptr<BestView> best_;
  Still still_;
};

const PictureSubject kTheTarget{.objects = {1}};
/// Of a box of 10 cm, 1.2 m away.
constexpr std::size_t kWholeMug = 1200;

TEST(TheBestView, LooksIntoANicheFromItsOpenSide) {
  int hidden_behind_the_robot = 0;
  for (const Side open : {kFront, kBack, kLeft, kRight}) {
    SCOPED_TRACE(open);
    Seen seen(std::vector<Side>{open});
    const Still& still = seen.still();
    if (seen.count(kMugColor, still, still.view.camera) == 0) ++hidden_behind_the_robot;
    const auto cameras = seen.best().camerasFor({&still, &still}, kTheTarget);
    EXPECT_GT(seen.count(kMugColor, still, cameras[0]), kWholeMug / 2);
    const Vec3 way = cameras[0].world_from_camera.origin - kTarget;
    const std::array<float, kSides> outwards{-way.x, way.x, -way.z, way.z};
    EXPECT_GT(outwards[open], 0.5F);
    EXPECT_EQ(cameras[0].world_from_camera.origin, cameras[1].world_from_camera.origin);
    // Once more, it is the same.
    const auto again = seen.best().camerasFor({&still, &still}, kTheTarget);
    EXPECT_EQ(again[0].world_from_camera.origin, cameras[0].world_from_camera.origin);
  }
  // The camera that follows the robot sees into some of them.
  EXPECT_GE(hidden_behind_the_robot, 2);
}

TEST(TheBestView, ShowsAnObjectElsewhereWithoutTheRobot) {
  Seen seen(std::vector<Block>{});
  const Still& still = seen.still();
  ASSERT_FALSE(still.view.attached.empty());
  const Pose aside{{1.5F, 0.701F, 1.5F}, {}};
  const Still other = BestView::withoutRobot(still, 1, aside);
  EXPECT_TRUE(other.view.attached.empty());
  EXPECT_EQ(other.posed[*other.places[1]].world_from_model, aside);
  EXPECT_EQ(other.posed[*other.places[0]].world_from_model,
            still.posed[*still.places[0]].world_from_model);
}

TEST(TheBestView, ShowsBothWorlds) {
  // Open on two sides in the first; in the second the target lies on the table, behind the niche.
  for (const auto& [open, behind] : {std::pair(kFront, Vec3{1.5F, 0.701F, 1.5F}),
                                     std::pair(kLeft, Vec3{1.15F, 0.701F, 1.85F})}) {
    Seen seen(std::vector<Side>{open, kBack});
    const Still& simulated = seen.still();
    Still dynamic = simulated;
    dynamic.posed[1].world_from_model = {behind, {}};
    const auto cameras = seen.best().camerasFor({&simulated, &dynamic}, kTheTarget);
    EXPECT_GT(seen.count(kMugColor, simulated, cameras[0]), kWholeMug / 3);
    EXPECT_GT(seen.count(kMugColor, dynamic, cameras[1]), kWholeMug / 3);
    // The same way to look.
    constexpr float kRounding = 1e-5F;
    EXPECT_GT(dot(cameras[0].world_from_camera.x_axis, cameras[1].world_from_camera.x_axis),
              1 - kRounding);
  }
}

TEST(TheBestView, ShowsALinkOrWhatIsFixedToIt) {
  Seen seen(std::vector<Side>{kFront, kBack, kLeft, kRight});
  const Still& still = seen.still();
  // The hand, and the mast, which has nothing to show.
  const auto hand = seen.best().camerasFor({&still, &still}, {.link = 4});
  EXPECT_GT(seen.count(kHandColor, still, hand[0]), 100U);
  const auto mast = seen.best().camerasFor({&still, &still}, {.link = 1});
  EXPECT_EQ(mast[0].world_from_camera.origin, still.view.camera.world_from_camera.origin);
}

TEST(TheBestView, IsNotFromInsideOfSomething) {
  // Surfaces are not seen from behind: a camera in one of these would see the target.
  const std::vector<Block> walls{{{0, 0, 0}, {3, 2.4F, 0.9F}},
                                 {{0, 0, 2.1F}, {3, 2.4F, 3}},
                                 {{1.9F, 0, 0.9F}, {3, 2.4F, 2.1F}}};
  Seen seen(walls);
  const Still& still = seen.still();
  const auto cameras = seen.best().camerasFor({&still, &still}, kTheTarget);
  EXPECT_GT(seen.count(kMugColor, still, cameras[0]), kWholeMug / 2);
  const Vec3 place = cameras[0].world_from_camera.origin;
  EXPECT_TRUE(place.x < 1.9F && place.z > 0.9F && place.z < 2.1F);
}

TEST(TheBestView, FollowsTheRobotWhereNothingIsSeen) {
  Seen seen(std::vector<Side>{});
  const Still& still = seen.still();
  const auto cameras = seen.best().camerasFor({&still, &still}, kTheTarget);
  EXPECT_EQ(seen.count(kMugColor, still, cameras[0]), 0U);
  EXPECT_EQ(cameras[0].world_from_camera.origin, still.view.camera.world_from_camera.origin);
}

}  // namespace
}  // namespace galactic::test::best_view_test
