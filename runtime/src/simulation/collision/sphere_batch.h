#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace galactic::simulation {

/// Spheres are handled eight at a time.
inline constexpr std::size_t kLanes = 8;

/// Numbers that bound centers: least and most x, then y, then z, meters.
inline constexpr std::size_t kBounds = 6;

/// The next multiple of kLanes.
[[nodiscard]] constexpr std::size_t paddedToLanes(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

/// The spheres of one radius in a SphereBatch.
struct RadiusRange {
  /// Index into the working set.
  std::uint32_t radius_index = 0;
  /// Meters.
  float radius = 0;
  /// A multiple of kLanes.
  std::uint32_t first = 0;
  /// Spheres; the arrays go on to paddedToLanes(count) with copies of the last one, so that whole
  /// lanes can be read and an extra lane changes no answer.
  std::uint32_t count = 0;
};

/// The spheres of one env's robot, or of the object that it holds: centers in the world frame as
/// three arrays, radius by radius.
struct SphereBatch {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  /// Ascending `first`, no two of one radius.
  std::span<const RadiusRange> ranges;
};

}  // namespace galactic::simulation
