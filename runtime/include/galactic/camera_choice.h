#pragma once
#include <string>

#include "galactic/error.h"
#include "galactic/robot.h"
#include "galactic/world_views.h"

namespace galactic {

/// A camera and what is cut off in front of it.
struct ChosenCamera {
  CameraMount mount;
  /// Meters.
  float near = 0.05F;
};

/// What a user says of a camera.
struct CameraWish {
  /// "head": that of the robot's recipe. "follow": behind and above the base, or
  /// from where nothing stands between. "top": straight down
  /// on the base, without what is higher than a robot, ceilings above all. Or a link of the robot
  /// ("NAME", or "link:NAME" where it has one of these names), looking along its +X.
  std::string name;
  /// Between the lower and the upper edge; 0: what belongs to the camera.
  float fov_degrees = 0;
  /// What errors call the option.
  std::string option = "--camera";
};

/// Fails with kInvalidInput when the robot has no such link, or its recipe no camera.
[[nodiscard]] Result<ChosenCamera> chooseCamera(const Robot& robot, const CameraWish& wish);

}  // namespace galactic
