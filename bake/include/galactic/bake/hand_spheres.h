#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// A sphere placed by hand or by another tool, of any radius. Meters.
struct HandSphere {
  std::array<double, 3> center{};
  double radius = 0;

  friend bool operator==(const HandSphere&, const HandSphere&) = default;
};

/// The spheres of one link, in the link's frame: Y up, X forward.
struct LinkSpheres {
  std::string link;
  std::vector<HandSphere> spheres;

  friend bool operator==(const LinkSpheres&, const LinkSpheres&) = default;
};

struct HandSpheres {
  /// In the order of the file; links without spheres are left out.
  std::vector<LinkSpheres> links;
  /// One sentence each: collision elements that are no spheres.
  std::vector<std::string> warnings;
};

/// The <sphere> collision elements of a URDF, as the tools foam and VAMP write them; other shapes
/// are left out with a warning. Fails as importUrdf does on broken text, and with kInvalidInput
/// when no link has a sphere or a sphere is not finite or has no positive radius.
[[nodiscard]] Result<HandSpheres> readSpherizedUrdf(const std::filesystem::path& path);

/// The <link_sphere_approximation> elements of an SRDF (MoveIt). MoveIt's way to say that a link
/// has no spheres, a single one of radius 0, leaves the link out. Fails as readSpherizedUrdf.
[[nodiscard]] Result<HandSpheres> readSrdfSpheres(const std::filesystem::path& path);

}  // namespace galactic::bake
