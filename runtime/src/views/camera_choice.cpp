#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include "galactic/drawn_number.h"
#include "galactic/world_views.h"
#include "support/random_stream.h"
#include "views/camera_offset.h"

namespace galactic {
namespace {

constexpr float kRadiansPerDegree = std::numbers::pi_v<float> / 180;

/// A camera at `place` that looks ahead and `degrees` down.
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
  // Anything higher than this would hide the robot, so the near plane cuts it off.
  constexpr float kHighestShown = 2.1F;
  return {{.frame = CameraFrame::kBase,
           .link = 0,
           .frame_from_camera = pitchedDown({0, kHeight, 0}, kStraightDown),
           .vertical_fov = kFov * kRadiansPerDegree},
          kHeight - kHighestShown};
}

/// Whether `name` is a camera other than a link of the robot.
bool isNoLink(std::string_view name) { return name == "head" || name == "follow" || name == "top"; }

/// The link in the name of a camera, which is `link:NAME` or just NAME.
std::string_view linkIn(std::string_view name) {
  constexpr std::string_view kPrefix = "link:";
  return name.starts_with(kPrefix) ? name.substr(kPrefix.size()) : name;
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
    return fail(ErrorCode::kInvalidInput, wish.options.camera,
                fmt::format("head is the camera of the robot's recipe, and that of {} has none; "
                            "take follow, top or one of its links",
                            robot.name()));
  }
  const std::string_view link_name = linkIn(name);
  const std::optional<std::uint32_t> link = robot.findLink(link_name);
  if (!link) {
    return fail(ErrorCode::kInvalidInput, wish.options.camera,
                fmt::format("found no link \"{}\" in {}; expected head, follow, top or one of {}",
                            link_name, robot.name(), linkNames(robot)));
  }
  return ChosenCamera{{.frame = CameraFrame::kLink, .link = *link, .frame_from_camera = {}}};
}

Result<ChosenCamera> cameraInWorld(const CameraWish& wish) {
  const CameraOptionNames& names = wish.options;
  const auto refuse = [&](const std::string& option, const std::string& found) {
    return fail(ErrorCode::kInvalidInput, option,
                fmt::format("found {}, expected none: {} says where the camera stands", found,
                            names.places));
  };
  constexpr std::array<float, 3> kNone{};
  if (!wish.name.empty()) return refuse(names.camera, wish.name);
  if (wish.position != kNone) return refuse(names.position, "a position");
  if (wish.rpy_degrees != kNone) return refuse(names.rpy, "a turn");
  if (const Result<void> checked = checkPlaces(names.places, wish.world_from_camera); !checked) {
    return tl::unexpected<Error>(checked.error());
  }
  return ChosenCamera{{.frame = CameraFrame::kWorld,
                       .frame_from_camera = {},
                       .world_from_camera = wish.world_from_camera}};
}

/// A number for the camera. Cameras in the same place on the same link have the same number, even
/// if one is called `link:NAME` and one NAME; other cameras have other numbers.
std::uint64_t numberOf(const CameraWish& wish) {
  const std::string_view link = linkIn(wish.name);
  const std::string_view name = isNoLink(link) ? wish.name : link;
  std::uint64_t number = 0;
  for (const char one : name) number = mix(number ^ static_cast<unsigned char>(one)) + 1;
  for (const std::array<float, 3>& three : {wish.position, wish.rpy_degrees}) {
    // 0 and -0 are the same place.
    for (const float one : three) number = mix(number ^ std::bit_cast<std::uint32_t>(one + 0)) + 1;
  }
  return number;
}

/// False for NaN, since comparisons with NaN are false.
bool isWithin(float value, float least, float most) { return value >= least && value <= most; }

/// The error message for a place; empty if nothing is wrong with it.
std::string faultOf(const RigidTransform& place) {
  const auto& [x, y, z, origin] = place;
  for (const float meters : {origin.x, origin.y, origin.z}) {
    if (isWithin(meters, -kFarthestPlace, kFarthestPlace)) continue;
    return fmt::format("stands at ({}, {}, {}) m, expected {} to {}", origin.x, origin.y, origin.z,
                       -kFarthestPlace, kFarthestPlace);
  }
  for (const float square : {dot(x, x), dot(y, y), dot(z, z)}) {
    if (isWithin(square, 1 - kMostSkew, 1 + kMostSkew)) continue;
    return fmt::format(
        "has an axis of the length {}, expected 1: a rotation and a place, without "
        "a scale",
        std::sqrt(square));
  }
  for (const float product : {dot(x, y), dot(y, z), dot(z, x)}) {
    if (isWithin(product, -kMostSkew, kMostSkew)) continue;
    return fmt::format("has axes whose dot product is {}, expected 0: they stand at right angles",
                       std::abs(product));
  }
  if (dot(cross(x, y), z) > 0) return {};
  return "is mirrored, expected a rotation: with its determinant 1, and not -1";
}

Result<void> checkNumbers(const CameraWish& wish) {
  const auto refuse = [](const std::string& option, const std::string& message) {
    return fail(ErrorCode::kInvalidInput, option, message);
  };
  if (wish.fov_degrees != 0 && !isWithin(wish.fov_degrees, kLeastFovDegrees, kMostFovDegrees)) {
    return refuse(wish.options.fov,
                  fmt::format("found a vertical field of view of {} degrees, expected {} to {}, or "
                              "0 for that of the camera",
                              wish.fov_degrees, kLeastFovDegrees, kMostFovDegrees));
  }
  if (wish.near != 0 && !isWithin(wish.near, kLeastNear, kMostNear)) {
    return refuse(wish.options.near, fmt::format("found {} m, expected {} to {}, or 0 for what "
                                                 "belongs to the camera",
                                                 wish.near, kLeastNear, kMostNear));
  }
  for (const float meters : wish.position) {
    if (isWithin(meters, -kFarthestCamera, kFarthestCamera)) continue;
    return refuse(wish.options.position, fmt::format("found {} m, expected {} to {}", meters,
                                                     -kFarthestCamera, kFarthestCamera));
  }
  for (const float degrees : wish.rpy_degrees) {
    if (isWithin(degrees, -kMostCameraTurn, kMostCameraTurn)) continue;
    return refuse(wish.options.rpy, fmt::format("found {} degrees, expected {} to {}", degrees,
                                                -kMostCameraTurn, kMostCameraTurn));
  }
  return {};
}

/// Checks the jitter of a camera with the field of view `fov`, radians.
Result<void> checkJitter(const CameraWish& wish, float fov) {
  const CameraOptionNames& names = wish.options;
  struct Named {
    const std::string& option;
    const char* unit;
  };
  // In the order of kCameraJitterOptions.
  const std::array<Named, kCameraJitterOptions.size()> told{
      {{names.jitter, "m"}, {names.jitter_degrees, "degrees"}, {names.jitter_fov, "degrees"}}};
  for (std::size_t n = 0; n < told.size(); ++n) {
    const SensorOption<CameraJitter>& option = kCameraJitterOptions.at(n);
    const DrawnNumber& value = wish.jitter.*option.value;
    const Span within{0, option.most};
    if (isDrawnWithin(value, within)) continue;
    return fail(ErrorCode::kInvalidInput, told.at(n).option,
                fmt::format("found {} {}, expected {}", drawnText(value), told.at(n).unit,
                            wantedDrawn(within)));
  }
  const float off = wish.jitter.camera_jitter_fov.most;
  if (off == 0) return {};
  const float degrees = fov / kRadiansPerDegree;
  // Rounding errors must not make a difference.
  constexpr float kAbout = 1e-3F;
  if (isWithin(degrees - off, kLeastFovDegrees - kAbout, kMostFovDegrees) &&
      isWithin(degrees + off, kLeastFovDegrees, kMostFovDegrees + kAbout)) {
    return {};
  }
  return fail(ErrorCode::kInvalidInput, names.jitter_fov,
              fmt::format("found {} degrees about a field of view of {:.4g} degrees; expected one "
                          "that stays {} to {}",
                          off, degrees, kLeastFovDegrees, kMostFovDegrees));
}

}  // namespace

Result<void> checkPlaces(const std::string& where,
                         std::span<const RigidTransform> world_from_camera) {
  for (std::size_t n = 0; n < world_from_camera.size(); ++n) {
    const std::string fault = faultOf(world_from_camera[n]);
    if (fault.empty()) continue;
    return fail(ErrorCode::kInvalidInput, where,
                world_from_camera.size() == 1 ? fault : fmt::format("number {} {}", n, fault));
  }
  return {};
}

Result<ChosenCamera> chooseCamera(const Robot& robot, const CameraWish& wish) {
  Result<ChosenCamera> camera =
      wish.world_from_camera.empty() ? cameraOf(robot, wish) : cameraInWorld(wish);
  if (!camera) return camera;
  if (const Result<void> checked = checkNumbers(wish); !checked) {
    return tl::unexpected<Error>(checked.error());
  }
  camera->mount.frame_from_camera =
      camera->mount.frame_from_camera * cameraOffset(wish.position, wish.rpy_degrees);
  camera->mount.jitter = wish.jitter;
  camera->mount.number = numberOf(wish);
  if (wish.fov_degrees != 0) camera->mount.vertical_fov = wish.fov_degrees * kRadiansPerDegree;
  if (wish.near != 0) camera->near = wish.near;
  if (const Result<void> checked = checkJitter(wish, camera->mount.vertical_fov); !checked) {
    return tl::unexpected<Error>(checked.error());
  }
  return camera;
}

}  // namespace galactic
