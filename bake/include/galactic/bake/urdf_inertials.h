#pragma once
#include <array>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/error.h"

namespace galactic::bake {

/// The <inertial> of a link as the file states it, which may be impossible: nothing is checked. In
/// the URDF's frame (Z up, but for furniture), unlike what importUrdf returns.
struct LinkInertial {
  /// Of the link.
  std::string link;
  /// Kilograms.
  double mass = 0;
  /// Center of mass in the link's frame, meters.
  std::array<double, 3> center{};
  /// xx, yy, zz, xy, xz, yz about the center, along the axes of the link's frame; kg m^2.
  std::array<double, 6> moments{};
};

/// The masses of a URDF, in the order of its links; links without <inertial> are left out. Baking
/// needs none of it: packs hold no masses. Fails as importUrdf does on what cannot be read.
/// Deterministic; thread-safe.
[[nodiscard]] Result<std::vector<LinkInertial>> readInertials(
    const std::filesystem::path& path, std::chrono::seconds time_limit = std::chrono::seconds(60));

}  // namespace galactic::bake
