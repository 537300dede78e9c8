#pragma once
#include <filesystem>

#include "galactic/bake/source_robot.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Reads the <sphere> collision elements of a URDF, as the tools foam and VAMP write them; leaves
/// out other shapes, with a warning. Fails as importRobot does on broken text, and with
/// kInvalidInput if no link has a sphere, or if a sphere is not finite or its radius is not
/// positive.
[[nodiscard]] Result<HandSpheres> readSpherizedRobot(const std::filesystem::path& path);

/// Reads the <link_sphere_approximation> elements of an SRDF (MoveIt). Leaves out links with a
/// single sphere of radius 0, which is how MoveIt says that a link has no spheres. Fails as
/// readSpherizedRobot does.
[[nodiscard]] Result<HandSpheres> readSrdfSpheres(const std::filesystem::path& path);

}  // namespace galactic::bake
