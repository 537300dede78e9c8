// Where the cameras of views are: on links, on bases, in the world, kept in sight, with jitter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "galactic/debug_views.h"
#include "galactic/world_views.h"
#include "render/render_engine.h"
#include "viewed_home.h"

namespace galactic::view_cameras_test {
namespace {

using test::difference;
using test::kPlaceTolerance;
using CamerasOfAHome = test::ViewedHome;

TEST_F(CamerasOfAHome, TheCameraOfALinkFollowsTheForwardKinematics) {
  const CameraMount mount{.frame = CameraFrame::kLink,
                          .link = 4,
                          .frame_from_camera = {{0.01F, 0.02F, 0.03F}, test::yaw(0.7)},
                          .vertical_fov = 1.25F};
  WorldViews views(*models_, *simulator_, mount);
  for (int n = 0; n < 40; ++n) {
    step();
    views.update(*simulator_);
    ASSERT_EQ(views.views().size(), kEnvs);
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const RenderCamera& camera = views.views()[env].camera;
      EXPECT_EQ(camera.vertical_fov, 1.25F);
      EXPECT_LT(difference(camera.world_from_camera,
                           rigidTransform(links(env)[4] * mount.frame_from_camera)),
                kPlaceTolerance);
    }
  }
}

TEST_F(CamerasOfAHome, TheCameraOfTheBaseStandsOnTheFloor) {
  const CameraMount mount{
      .frame = CameraFrame::kBase, .link = 0, .frame_from_camera = {{-1, 2, 0.5F}, {}}};
  WorldViews views(*models_, *simulator_, mount);
  step();
  views.update(*simulator_);
  for (std::size_t env = 0; env < kEnvs; ++env) {
    Pose base = simulator_->envState(env).world_from_root;
    base.translation.y -= world_->robot().base()->root_height;
    EXPECT_LT(difference(views.views()[env].camera.world_from_camera,
                         rigidTransform(base * mount.frame_from_camera)),
              kPlaceTolerance);
  }
}

TEST_F(CamerasOfAHome, ACameraThatKeepsSightStaysInTheRoom) {
  // 1.3 m behind a robot that stands 0.6 m from the end of the room; both kinds of views.
  CameraMount mount = chooseCamera(world_->robot(), {.name = "follow"})->mount;
  ASSERT_TRUE(mount.keeps_sight);
  const auto inside = [](const RenderCamera& camera) {
    const Vec3& at = camera.world_from_camera.origin;
    return at.x > 0 && at.x < 3 && at.z > 0 && at.z < 3 && at.y > 0.3F;
  };
  const WorldViews views(*models_, *simulator_, mount);
  auto models = DebugModels::from(*world_, {});
  ASSERT_TRUE(models);
  const DebugViews debug_views(*models, *simulator_, mount, 1);
  EXPECT_TRUE(inside(views.views()[0].camera));
  EXPECT_EQ(difference(debug_views.views()[0].camera.world_from_camera,
                       views.views()[0].camera.world_from_camera),
            0);
  mount.keeps_sight = false;
  const WorldViews outside(*models_, *simulator_, mount);
  EXPECT_FALSE(inside(outside.views()[0].camera));
}

TEST_F(CamerasOfAHome, ACameraThatKeepsSightMayLookStraightUpOrDown) {
  // The follow camera looks 38 degrees down by itself. What it looks at is then as far away as
  // numbers go, in either direction.
  for (const float pitch : {-128.0F, -127.99999F, -128.00001F, 52.0F, 51.99999F, 52.00001F}) {
    const auto camera =
        chooseCamera(world_->robot(), {.name = "follow", .rpy_degrees = {0, pitch, 0}});
    ASSERT_TRUE(camera);
    ASSERT_TRUE(camera->mount.keeps_sight);
    const WorldViews views(*models_, *simulator_, camera->mount);
    for (const RenderView& view : views.views()) EXPECT_TRUE(render::canSee(view.camera)) << pitch;
  }
}

TEST_F(CamerasOfAHome, ACameraThatKeepsSightStaysWhereItIsWhenItLooksAway) {
  for (const float yaw : {-180.0F, -120.0F, 100.0F, 180.0F}) {
    CameraMount mount =
        chooseCamera(world_->robot(), {.name = "follow", .rpy_degrees = {0, 0, yaw}})->mount;
    ASSERT_TRUE(mount.keeps_sight);
    const WorldViews views(*models_, *simulator_, mount);
    mount.keeps_sight = false;
    const WorldViews wanted(*models_, *simulator_, mount);
    for (std::size_t env = 0; env < kEnvs; ++env) {
      EXPECT_EQ(difference(views.views()[env].camera.world_from_camera,
                           wanted.views()[env].camera.world_from_camera),
                0)
          << yaw;
    }
  }
}

TEST_F(CamerasOfAHome, ACameraOfTheWorldStaysWhereItIs) {
  const RigidTransform place = rigidTransform(Pose{{1, 2, 3}, test::yaw(1)});
  CameraMount mount{
      .frame = CameraFrame::kWorld, .frame_from_camera = {}, .world_from_camera = {place}};
  WorldViews views(*models_, *simulator_, mount);
  EXPECT_EQ(difference(views.views()[2].camera.world_from_camera, place), 0);
  const std::uint64_t number = views.views()[2].noise.camera;
  EXPECT_EQ(views.views()[1].noise.camera, number);
  // Elsewhere, and in each env elsewhere: from the next update on.
  std::vector<RigidTransform> places(kEnvs, place);
  for (std::size_t env = 1; env < kEnvs; ++env) places[env].origin.y += static_cast<float>(env);
  views.placeCamera(places);
  EXPECT_EQ(difference(views.views()[2].camera.world_from_camera, place), 0);
  views.update(*simulator_);
  for (std::size_t env = 0; env < kEnvs; ++env) {
    EXPECT_EQ(difference(views.views()[env].camera.world_from_camera, places[env]), 0);
    EXPECT_EQ(views.views()[env].noise.camera == number, env == 0);
  }
  mount.number = 5;
  EXPECT_NE(WorldViews(*models_, *simulator_, mount).views()[2].noise.camera, number);
}

TEST_F(CamerasOfAHome, PlacesOfCamerasThatAreNoneAreRefused) {
  const auto refused = [](const auto& call, const std::string& message) {
    EXPECT_THAT(call, testing::ThrowsMessage<ErrorException>(
                          testing::StartsWith("MountedCamera::place: " + message)));
  };
  CameraMount mount{.frame = CameraFrame::kWorld, .frame_from_camera = {}};
  refused([&] { WorldViews(*models_, *simulator_, mount); }, "found 0 places, expected one");
  mount.world_from_camera.resize(kEnvs + 1);
  refused([&] { WorldViews(*models_, *simulator_, mount); }, "found " + std::to_string(kEnvs + 1));
  mount.world_from_camera.resize(kEnvs);
  WorldViews views(*models_, *simulator_, mount);
  mount.world_from_camera[1].y_axis = {0, -1, 0};
  refused([&] { views.placeCamera(mount.world_from_camera); }, "number 1 is mirrored");
  views.update(*simulator_);
  EXPECT_EQ(views.views()[1].camera.world_from_camera.y_axis, (Vec3{0, 1, 0}));
  WorldViews on_robot(*models_, *simulator_, robotCamera(world_->robot()).value());
  refused([&] { on_robot.placeCamera(mount.world_from_camera); }, "found a camera on the robot");
}

TEST_F(CamerasOfAHome, WithJitterTheCameraIsElsewhereInEachEpisodeWithinLimits) {
  constexpr float kMeters = 0.05F;
  constexpr float kDegrees = 4;
  CameraMount mount{.frame = CameraFrame::kLink,
                    .link = 4,
                    .frame_from_camera = {{0.01F, 0.02F, 0.03F}, test::yaw(0.7)}};
  WorldViews plain(*models_, *simulator_, mount);
  mount.jitter = {.camera_jitter = kMeters, .camera_jitter_degrees = kDegrees};
  WorldViews jittered(*models_, *simulator_, mount);
  mount.number = 1;
  WorldViews of_another_camera(*models_, *simulator_, mount);
  const auto offset = [&](const WorldViews& views, std::size_t env) {
    return inverse(plain.views()[env].camera.world_from_camera) *
           views.views()[env].camera.world_from_camera;
  };
  const auto update = [&] {
    for (WorldViews* views : {&plain, &jittered, &of_another_camera}) views->update(*simulator_);
  };
  // Of places and angles: least, most and mean share of the limit.
  std::array<float, 6> least{};
  std::array<float, 6> most{};
  std::array<float, 6> sum{};
  constexpr std::uint64_t kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    simulator_->restart(seed);
    update();
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const RigidTransform moved = offset(jittered, env);
      ASSERT_GT(difference(moved, offset(of_another_camera, env)), 1e-4F);
      // Yaw turns ahead to the left, pitch downwards; roll turns up to the right.
      const float yaw = std::atan2(-moved.x_axis.z, moved.x_axis.x);
      const float pitch = std::asin(-moved.x_axis.y);
      const float roll = std::atan2(moved.z_axis.y, moved.y_axis.y);
      const float radians = kDegrees * 3.14159265F / 180;
      const std::array<float, 6> shares{moved.origin.x / kMeters, moved.origin.y / kMeters,
                                        moved.origin.z / kMeters, roll / radians,
                                        pitch / radians,          yaw / radians};
      for (std::size_t n = 0; n < shares.size(); ++n) {
        least.at(n) = std::min(least.at(n), shares.at(n));
        most.at(n) = std::max(most.at(n), shares.at(n));
        sum.at(n) += shares.at(n);
      }
    }
  }
  constexpr float kRounding = 1e-3F;
  for (std::size_t n = 0; n < 6; ++n) {
    EXPECT_GE(least.at(n), -1 - kRounding);
    EXPECT_LT(least.at(n), -0.9F) << "part " << n;
    EXPECT_GT(most.at(n), 0.9F) << "part " << n;
    EXPECT_LE(most.at(n), 1 + kRounding);
    // Four standard deviations of the mean of so many uniform numbers.
    EXPECT_NEAR(sum.at(n) / (kSeeds * kEnvs), 0, 4 * std::sqrt(1.0F / 3 / (kSeeds * kEnvs)));
  }
  // The same in all of an episode, and as soon as that is begun again.
  const std::vector<std::byte> saved = simulator_->saveState();
  const RigidTransform first = offset(jittered, 0);
  for (int n = 0; n < 5; ++n) {
    step();
    update();
    EXPECT_LT(difference(offset(jittered, 0), first), kPlaceTolerance);
  }
  simulator_->reset(std::vector<std::int32_t>(kEnvs, BatchSimulator::kNextEpisode));
  update();
  EXPECT_GT(difference(offset(jittered, 0), first), 1e-3F);
  ASSERT_TRUE(simulator_->restoreState(saved));
  update();
  EXPECT_EQ(difference(offset(jittered, 0), first), 0);
}

TEST_F(CamerasOfAHome, WithJitterOfItsFieldOfViewTheCameraIsAnotherInEachEpisode) {
  constexpr float kDegrees = 5;
  constexpr float kLimit = kDegrees * 3.14159265F / 180;
  CameraMount mount{.frame = CameraFrame::kLink,
                    .link = 4,
                    .frame_from_camera = {},
                    .vertical_fov = 1,
                    .jitter = {.camera_jitter = 0.05F}};
  WorldViews without(*models_, *simulator_, mount);
  mount.jitter.camera_jitter_fov = kDegrees;
  WorldViews with(*models_, *simulator_, mount);
  mount.jitter.camera_jitter_fov = {0, kDegrees};
  WorldViews drawn(*models_, *simulator_, mount);
  const auto update = [&] {
    for (WorldViews* views : {&without, &with, &drawn}) views->update(*simulator_);
  };
  float sum = 0;
  float least = 0;
  float most = 0;
  constexpr std::uint64_t kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    simulator_->restart(seed);
    update();
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const RenderCamera& camera = with.views()[env].camera;
      ASSERT_EQ(without.views()[env].camera.vertical_fov, 1);
      ASSERT_EQ(difference(camera.world_from_camera, without.views()[env].camera.world_from_camera),
                0);
      const float share = (camera.vertical_fov - 1) / kLimit;
      least = std::min(least, share);
      most = std::max(most, share);
      sum += share;
      // Of a range, the same way, and not further.
      const float own = (drawn.views()[env].camera.vertical_fov - 1) / kLimit;
      ASSERT_GE(own * share, 0);
      ASSERT_LE(std::abs(own), std::abs(share) + 1e-5F);
    }
  }
  constexpr float kRounding = 1e-5F;
  EXPECT_GE(least, -1 - kRounding);
  EXPECT_LT(least, -0.9F);
  EXPECT_GT(most, 0.9F);
  EXPECT_LE(most, 1 + kRounding);
  EXPECT_NEAR(sum / (kSeeds * kEnvs), 0, 4 * std::sqrt(1.0F / 3 / (kSeeds * kEnvs)));
  // The same in all of an episode.
  const float first = with.views()[0].camera.vertical_fov;
  for (int n = 0; n < 5; ++n) {
    step();
    update();
    EXPECT_EQ(with.views()[0].camera.vertical_fov, first);
  }
  simulator_->reset(std::vector<std::int32_t>(kEnvs, BatchSimulator::kNextEpisode));
  update();
  EXPECT_NE(with.views()[0].camera.vertical_fov, first);
}

TEST_F(CamerasOfAHome, EachEpisodeDrawsItsOwnLimitOfTheJitterFromARange) {
  constexpr float kLeast = 0.02F;
  constexpr float kMost = 0.1F;
  CameraMount mount{.frame = CameraFrame::kLink, .link = 4, .frame_from_camera = {}};
  WorldViews plain(*models_, *simulator_, mount);
  mount.jitter = {.camera_jitter = {kLeast, kMost}};
  WorldViews jittered(*models_, *simulator_, mount);
  mount.jitter.camera_jitter = kMost;
  WorldViews widest(*models_, *simulator_, mount);
  float sum = 0;
  constexpr std::uint64_t kSeeds = 200;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    simulator_->restart(seed);
    for (WorldViews* views : {&plain, &jittered, &widest}) views->update(*simulator_);
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const RigidTransform place = inverse(plain.views()[env].camera.world_from_camera);
      const Vec3 moved = (place * jittered.views()[env].camera.world_from_camera).origin;
      const Vec3 most = (place * widest.views()[env].camera.world_from_camera).origin;
      // The same way, not as far: a share of the widest that the episode has drawn.
      const float share = std::sqrt(dot(moved, moved) / dot(most, most));
      ASSERT_GE(share, kLeast / kMost - 1e-3F);
      ASSERT_LE(share, 1 + 1e-3F);
      ASSERT_LT(std::sqrt(dot(moved - most * share, moved - most * share)), 1e-5F);
      sum += share;
    }
  }
  // Four standard deviations of the mean of so many uniform numbers.
  const float spread = (1 - kLeast / kMost) * std::sqrt(1.0F / 12 / (kSeeds * kEnvs));
  EXPECT_NEAR(sum / (kSeeds * kEnvs), (1 + kLeast / kMost) / 2, 4 * spread);
}

}  // namespace
}  // namespace galactic::view_cameras_test
