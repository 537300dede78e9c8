// Which camera an option names, and where it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "galactic/world_views.h"
#include "support/homes/small_home.h"

namespace galactic::camera_choice_test {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;

TEST(CameraChoice, KnowsTheCamerasByName) {
  const test::SmallHome home;
  const Robot& robot = home.world().robot();
  const auto head = chooseCamera(robot, {.name = "head"});
  ASSERT_TRUE(head);
  EXPECT_EQ(head->mount.frame, CameraFrame::kLink);
  EXPECT_EQ(head->mount.link, robot.camera()->link);
  EXPECT_EQ(head->mount.vertical_fov, robot.camera()->vertical_fov);
  const auto hand = chooseCamera(robot, {.name = "hand", .fov_degrees = 90});
  ASSERT_TRUE(hand);
  EXPECT_EQ(hand->mount.link, 4U);
  EXPECT_NEAR(hand->mount.vertical_fov, 1.5707963F, 1e-6F);
  EXPECT_EQ(chooseCamera(robot, {.name = "link:hand"})->mount.link, 4U);
  const auto follow = chooseCamera(robot, {.name = "follow"});
  ASSERT_TRUE(follow);
  EXPECT_EQ(follow->mount.frame, CameraFrame::kBase);
  const Pose& pose = follow->mount.frame_from_camera;
  EXPECT_LT(pose.translation.x, 0);
  EXPECT_LT(rotate(pose.rotation, {1, 0, 0}).y, -0.5F);
}

TEST(CameraChoice, FromAboveAheadIsUpInTheImageAndCeilingsAreCutOff) {
  const test::SmallHome home;
  const auto top = chooseCamera(home.world().robot(), {.name = "top"});
  ASSERT_TRUE(top);
  const Pose& pose = top->mount.frame_from_camera;
  EXPECT_NEAR(rotate(pose.rotation, {1, 0, 0}).y, -1, 1e-6F);
  EXPECT_NEAR(rotate(pose.rotation, {0, 1, 0}).x, 1, 1e-6F);
  EXPECT_NEAR(pose.translation.y - top->near, 2.1F, 1e-5F);
}

TEST(CameraChoice, StandsAndLooksAsARecipeWouldHaveIt) {
  const test::SmallHome home;
  const Robot& robot = home.world().robot();
  const auto expect_near = [](const Vec3& found, const Vec3& wanted) {
    EXPECT_NEAR(found.x, wanted.x, 1e-6F);
    EXPECT_NEAR(found.y, wanted.y, 1e-6F);
    EXPECT_NEAR(found.z, wanted.z, 1e-6F);
  };
  const auto hand = chooseCamera(
      robot, {.name = "hand", .position = {0.1F, 0.2F, 0.3F}, .rpy_degrees = {90, 0, 0}});
  ASSERT_TRUE(hand);
  const Pose& rolled = hand->mount.frame_from_camera;
  // Ahead, up and to the right, where a recipe has ahead, to the left and up.
  expect_near(rolled.translation, {0.1F, 0.3F, -0.2F});
  expect_near(rotate(rolled.rotation, {1, 0, 0}), {1, 0, 0});
  expect_near(rotate(rolled.rotation, {0, 1, 0}), {0, 0, 1});
  const auto turned =
      chooseCamera(robot, {.name = "hand", .rpy_degrees = {0, 30, 90}})->mount.frame_from_camera;
  // Pitched down first, then turned to the left.
  const float down = std::sqrt(3.0F) / 2;
  expect_near(rotate(turned.rotation, {1, 0, 0}), {0, -0.5F, -down});
  expect_near(rotate(turned.rotation, {0, 1, 0}), {0, down, -0.5F});
  // Of a camera that has a place of its own, in its own axes: 5 m down from above.
  const auto top = chooseCamera(robot, {.name = "top", .position = {5, 0, 0}, .near = 0.2F});
  expect_near(top->mount.frame_from_camera.translation, {0, 1, 0});
  EXPECT_EQ(top->near, 0.2F);
}

TEST(CameraChoice, RefusesPlacesThatAreNone) {
  const test::SmallHome home;
  const auto refusal = [&](const CameraWish& wish) {
    const auto none = chooseCamera(home.world().robot(), wish);
    return none ? "" : none.error().text();
  };
  EXPECT_EQ(refusal({.name = "hand", .position = {-100, 0, 100}, .rpy_degrees = {-360, 0, 360}}),
            "");
  EXPECT_EQ(refusal({.name = "hand", .position = {0, 0, 101}}),
            "--camera-position: found 101 m, expected -100 to 100");
  EXPECT_EQ(refusal({.name = "hand", .position = {std::nanf(""), 0, 0}}),
            "--camera-position: found nan m, expected -100 to 100");
  EXPECT_EQ(refusal({.name = "hand", .rpy_degrees = {0, -361, 0}}),
            "--camera-rpy: found -361 degrees, expected -360 to 360");
  for (const float near : {-1.0F, 0.009F, 101.0F, std::nanf("")}) {
    EXPECT_THAT(refusal({.name = "hand", .near = near}),
                EndsWith(" m, expected 0.01 to 100, or 0 for what belongs to the camera"));
  }
}

TEST(CameraChoice, ACameraThatLooksAtAPointIsLevel) {
  const RigidTransform along = lookAt({1, 2, 3}, {5, 2, 3});
  EXPECT_EQ(along.x_axis, (Vec3{1, 0, 0}));
  EXPECT_EQ(along.y_axis, (Vec3{0, 1, 0}));
  EXPECT_EQ(along.z_axis, (Vec3{0, 0, 1}));
  EXPECT_EQ(along.origin, (Vec3{1, 2, 3}));
  // 3, 4 and 12 m away: 13.
  const RigidTransform slanted = lookAt({0, 12, 0}, {3, 0, -4});
  EXPECT_NEAR(slanted.x_axis.x, 3.0 / 13, 1e-6);
  EXPECT_NEAR(slanted.x_axis.y, -12.0 / 13, 1e-6);
  EXPECT_EQ(slanted.z_axis.y, 0);
  EXPECT_GT(slanted.y_axis.y, 0);
  EXPECT_TRUE(checkPlaces("", std::array{slanted}));
  // Straight down and up, ahead is up in the image and down.
  EXPECT_EQ(lookAt({1, 2, 3}, {1, 0, 3}).y_axis, (Vec3{1, 0, 0}));
  EXPECT_EQ(lookAt({1, 2, 3}, {1, 4, 3}).y_axis, (Vec3{-1, 0, 0}));
  EXPECT_THAT(
      [] {
        (void)lookAt({1, 2, 3}, {1, 2, 3});
      },
      testing::ThrowsMessage<ErrorException>(
          "lookAt: found the eye (1, 2, 3) and the target (1, 2, 3); expected two points of "
          "which one can be seen from the other"));
}

TEST(CameraChoice, CamerasStandInTheWorldOrOnTheRobot) {
  const test::SmallHome home;
  const Robot& robot = home.world().robot();
  const RigidTransform place = rigidTransform(Pose{{1, 2, 3}, {}});
  const auto camera =
      chooseCamera(robot, {.name = "", .fov_degrees = 60, .world_from_camera = {place}});
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->mount.frame, CameraFrame::kWorld);
  ASSERT_EQ(camera->mount.world_from_camera.size(), 1U);
  EXPECT_EQ(camera->mount.world_from_camera[0].origin, (Vec3{1, 2, 3}));
  EXPECT_NEAR(camera->mount.vertical_fov, std::numbers::pi / 3, 1e-6);
  const auto refusal = [&](const CameraWish& wish) {
    return chooseCamera(robot, wish).error().text();
  };
  EXPECT_EQ(refusal({.name = "hand", .world_from_camera = {place}}),
            "--camera: found hand, expected none: world_from_camera says where the camera stands");
  EXPECT_THAT(refusal({.name = "", .position = {0, 1, 0}, .world_from_camera = {place}}),
              HasSubstr("--camera-position: found a position, expected none"));
  EXPECT_THAT(refusal({.name = "", .rpy_degrees = {0, 1, 0}, .world_from_camera = {place}}),
              HasSubstr("--camera-rpy: found a turn, expected none"));
  RigidTransform mirrored = place;
  mirrored.z_axis = {0, 0, -1};
  EXPECT_EQ(refusal({.name = "", .world_from_camera = {place, mirrored}}),
            "world_from_camera: number 1 is mirrored, expected a rotation: with its determinant 1, "
            "and not -1");
}

TEST(CameraChoice, NumbersCamerasByTheirPlaces) {
  const test::SmallHome home;
  const auto number = [&](const CameraWish& wish) {
    return chooseCamera(home.world().robot(), wish).value().mount.number;
  };
  const std::uint64_t hand = number({.name = "hand"});
  EXPECT_EQ(number({.name = "hand",
                    .fov_degrees = 50,
                    .position = {0, -0.0F, 0},
                    .near = 0.2F,
                    .jitter = {0.1F, 2}}),
            hand);
  EXPECT_NE(number({.name = "head"}), hand);
  EXPECT_NE(number({.name = "hand", .position = {0.1F, 0, 0}}), hand);
  EXPECT_NE(number({.name = "hand", .rpy_degrees = {0.1F, 0, 0}}), hand);
  // It is the same camera by its longer name.
  EXPECT_EQ(number({.name = "link:hand"}), hand);
  const std::array<float, 3> ahead{0.1F, 0, 0};
  EXPECT_EQ(number({.name = "link:hand", .position = ahead}),
            number({.name = "hand", .position = ahead}));
  EXPECT_NE(number({.name = "link:arm"}), hand);
}

TEST(CameraChoice, ALinkThatIsCalledLikeACameraHasAnotherNumber) {
  test::WorldFields fields = test::smallHomeWorld();
  fields.robot.link_names = {"base", "mast", "turret", "arm", "head"};
  const test::SmallHome home(fields);
  const Robot& robot = home.world().robot();
  const CameraMount link = chooseCamera(robot, {.name = "link:head"}).value().mount;
  EXPECT_EQ(link.link, 4U);
  EXPECT_NE(link.number, chooseCamera(robot, {.name = "head"}).value().mount.number);
}

TEST(CameraChoice, RefusesJitterOutOfRange) {
  const test::SmallHome home;
  const auto refusal = [&](const CameraJitter& jitter) {
    const auto none = chooseCamera(home.world().robot(), {.name = "hand", .jitter = jitter});
    return none ? "" : none.error().text();
  };
  const auto or_range = [](const std::string& most) {
    return ", or a range from 0 to " + most + " such as 0.1-0.3";
  };
  EXPECT_EQ(refusal({.camera_jitter = 1, .camera_jitter_degrees = 180}), "");
  EXPECT_EQ(refusal({.camera_jitter = -0.5F}),
            "--camera-jitter: found -0.5 m, expected 0 to 1" + or_range("1"));
  EXPECT_EQ(refusal({.camera_jitter_degrees = 181}),
            "--camera-jitter-degrees: found 181 degrees, expected 0 to 180" + or_range("180"));
  EXPECT_EQ(refusal({.camera_jitter_degrees = std::nanf("")}),
            "--camera-jitter-degrees: found nan-nan degrees, expected 0 to 180" + or_range("180"));
  EXPECT_EQ(refusal({.camera_jitter = {0.1F, 0.3F}}), "");
  EXPECT_EQ(refusal({.camera_jitter = {0.3F, 0.1F}}),
            "--camera-jitter: found 0.3-0.1 m, expected 0 to 1" + or_range("1"));
  EXPECT_EQ(refusal({.camera_jitter_fov = 91}),
            "--camera-jitter-fov: found 91 degrees, expected 0 to 90" + or_range("90"));
  EXPECT_EQ(refusal({.camera_jitter_fov = {-1, 2}}),
            "--camera-jitter-fov: found -1-2 degrees, expected 0 to 90" + or_range("90"));
}

TEST(CameraChoice, RefusesFieldsOfViewThatJitterLeadsOutOfRange) {
  const test::SmallHome home;
  const auto refusal = [&](float fov_degrees, const DrawnNumber& jitter) {
    CameraWish wish{.name = "hand", .fov_degrees = fov_degrees};
    wish.jitter.camera_jitter_fov = jitter;
    const auto none = chooseCamera(home.world().robot(), wish);
    return none ? "" : none.error().text();
  };
  EXPECT_EQ(refusal(60, 59), "");
  EXPECT_EQ(refusal(170, 5), "");
  EXPECT_EQ(refusal(60, {0, 60}),
            "--camera-jitter-fov: found 60 degrees about a field of view of 60 degrees; expected "
            "one that stays 1 to 175");
  EXPECT_EQ(refusal(170, 6),
            "--camera-jitter-fov: found 6 degrees about a field of view of 170 degrees; expected "
            "one that stays 1 to 175");
}

TEST(CameraChoice, RefusesFieldsOfViewThatShowNothing) {
  const test::SmallHome home;
  const Robot& robot = home.world().robot();
  for (const float fov : {0.0F, 1.0F, 175.0F}) {
    EXPECT_TRUE(chooseCamera(robot, {.name = "top", .fov_degrees = fov})) << fov;
  }
  for (const float fov : {-5.0F, 0.9F, 175.1F, 180.0F, 360.0F, std::nanf("")}) {
    const auto none = chooseCamera(robot, {.name = "top", .fov_degrees = fov});
    ASSERT_FALSE(none) << fov;
    EXPECT_EQ(none.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(none.error().where, "--fov");
    EXPECT_THAT(none.error().message,
                EndsWith(" degrees, expected 1 to 175, or 0 for that of the camera"));
  }
}

TEST(CameraChoice, AnUnknownLinkIsRefusedWithThoseThereAre) {
  const test::SmallHome home;
  const auto none =
      chooseCamera(home.world().robot(), {.name = "nose", .options = {.camera = "--debug-camera"}});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(none.error().where, "--debug-camera");
  EXPECT_THAT(none.error().message,
              AllOf(HasSubstr("found no link \"nose\" in helper"),
                    HasSubstr("head, follow, top or one of base, mast, turret, arm, hand")));
  for (const char* empty : {"", "link:"}) {
    EXPECT_THAT(chooseCamera(home.world().robot(), {.name = empty}).error().message,
                HasSubstr("found no link \"\" in helper"));
  }
}

}  // namespace
}  // namespace galactic::camera_choice_test
