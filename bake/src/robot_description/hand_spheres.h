#pragma once
#include <filesystem>

#include "galactic/bake/source_robot.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The <sphere> collision elements of a URDF, as the tools foam and VAMP write them; other shapes
/// are left out with a warning. Fails as importRobot does on broken text, and with kInvalidInput
/// when no link has a sphere or a sphere is not finite or has no positive radius.
[[nodiscard]] Result<HandSpheres> readSpherizedRobot(const std::filesystem::path& path);

/// The <link_sphere_approximation> elements of an SRDF (MoveIt). MoveIt's way to say that a link
/// has no spheres, a single one of radius 0, leaves the link out. Fails as readSpherizedRobot.
[[nodiscard]] Result<HandSpheres> readSrdfSpheres(const std::filesystem::path& path);

}  // namespace galactic::bake
