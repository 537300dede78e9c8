#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include "galactic/world_views.h"

namespace galactic {
namespace {

constexpr float kRadiansPerDegree = std::numbers::pi_v<float> / 180;

/// A camera that looks ahead and down.
Pose pitchedDown(const Vec3& place, float degrees) {
  const float half = -0.5F * degrees * kRadiansPerDegree;
  return {place, {.x = 0, .y = 0, .z = std::sin(half), .w = std::cos(half)}};
}

ChosenCamera followCamera() {
  const Vec3 place{-1.3F, 1.9F, 0};
  constexpr float kDown = 38;
  constexpr float kFov = 70;
  return {{.frame = CameraFrame::kBase,
           .link = 0,
           .frame_from_camera = pitchedDown(place, kDown),
           .vertical_fov = kFov * kRadiansPerDegree,
           .keeps_sight = true}};
}

ChosenCamera topCamera() {
  constexpr float kHeight = 6;
  constexpr float kStraightDown = 90;
  constexpr float kFov = 60;
  // What is higher than this hides the robot.
  constexpr float kHighestShown = 2.1F;
  return {{.frame = CameraFrame::kBase,
           .link = 0,
           .frame_from_camera = pitchedDown({0, kHeight, 0}, kStraightDown),
           .vertical_fov = kFov * kRadiansPerDegree},
          kHeight - kHighestShown};
}

std::string linkNames(const Robot& robot) {
  std::string names;
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    names += fmt::format("{}{}", link == 0 ? "" : ", ", robot.linkName(link));
  }
  return names;
}

Result<ChosenCamera> cameraOf(const Robot& robot, const CameraWish& wish) {
  const std::string_view name = wish.name;
  if (name == "follow") return followCamera();
  if (name == "top") return topCamera();
  if (name == "head") {
    if (const std::optional<CameraMount> mount = robotCamera(robot)) return ChosenCamera{*mount};
    return fail(ErrorCode::kInvalidInput, wish.option,
                fmt::format("head is the camera of the robot's recipe, and that of {} has none; "
                            "take follow, top or one of its links",
                            robot.name()));
  }
  constexpr std::string_view kLinkPrefix = "link:";
  const std::string_view link_name =
      name.starts_with(kLinkPrefix) ? name.substr(kLinkPrefix.size()) : name;
  const std::optional<std::uint32_t> link = robot.findLink(link_name);
  if (!link) {
    return fail(ErrorCode::kInvalidInput, wish.option,
                fmt::format("found no link {} in {}; expected head, follow, top or one of {}",
                            link_name, robot.name(), linkNames(robot)));
  }
  return ChosenCamera{{.frame = CameraFrame::kLink, .link = *link, .frame_from_camera = {}}};
}

}  // namespace

Result<ChosenCamera> chooseCamera(const Robot& robot, const CameraWish& wish) {
  Result<ChosenCamera> camera = cameraOf(robot, wish);
  if (!camera || wish.fov_degrees == 0) return camera;
  // A comparison with NaN is false.
  if (!(wish.fov_degrees >= kLeastFovDegrees && wish.fov_degrees <= kMostFovDegrees)) {
    return fail(ErrorCode::kInvalidInput, wish.fov_option,
                fmt::format("found a vertical field of view of {} degrees, expected {} to {}, or 0 "
                            "for that of the camera",
                            wish.fov_degrees, kLeastFovDegrees, kMostFovDegrees));
  }
  camera->mount.vertical_fov = wish.fov_degrees * kRadiansPerDegree;
  return camera;
}

}  // namespace galactic
