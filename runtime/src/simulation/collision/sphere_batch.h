#pragma once
#include <cstddef>
#include <cstdint>

namespace galactic::simulation {

/// Spheres are handled eight at a time.
inline constexpr std::size_t kLanes = 8;

/// The numbers of bounds of centers: least and most x, then y, then z, meters.
inline constexpr std::size_t kBounds = 6;

/// The bounds of a set of spheres, with the last two repeated to fill a vector.
struct alignas(32) CenterBounds {
  float values[kLanes] = {};
};

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
  /// The number of spheres. The arrays are padded to paddedToLanes(count) with copies of the last
  /// one, so that whole groups can be read and an extra lane changes no answer.
  std::uint32_t count = 0;
};

/// A plain span of ranges, for the kernels, which must instantiate no library templates.
struct RadiusRanges {
  const RadiusRange* first = nullptr;
  std::size_t count = 0;

  constexpr RadiusRanges() = default;
  /// From a vector, a span, or an array of ranges. Implicit, like the constructors of std::span.
  // NOLINTBEGIN(google-explicit-constructor)
  template <class Ranges>
  constexpr RadiusRanges(const Ranges& ranges) : first(ranges.data()), count(ranges.size()) {}
  // NOLINTEND(google-explicit-constructor)

  [[nodiscard]] constexpr const RadiusRange* begin() const { return first; }
  [[nodiscard]] constexpr const RadiusRange* end() const { return first + count; }
  [[nodiscard]] constexpr std::size_t size() const { return count; }
  [[nodiscard]] constexpr bool empty() const { return count == 0; }
  [[nodiscard]] constexpr const RadiusRange& operator[](std::size_t n) const { return first[n]; }
};

/// The spheres of one env's robot, or of the object that it holds: their centers in the world frame
/// as three arrays, sorted by radius.
struct SphereBatch {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  /// Sorted by `first`; no two have the same radius.
  RadiusRanges ranges;
};

/// Eight spheres of one radius, side by side in a SphereBatch.
struct EightSpheres {
  /// Index into the working set.
  std::uint32_t radius_index = 0;
  /// Meters.
  float radius = 0;
  /// Which of the eight are spheres, as bits; the others repeat the last one.
  unsigned spheres = 0;
};

/// The spheres of one env's robot in groups of eight, with bounds, which make most looks at the
/// spheres unnecessary.
struct BoundedSpheres {
  /// World frame, meters; spheres 8 g to 8 g + 7 are group g.
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t group_count = 0;
  /// The radius of each group, meters, padded to lanes.
  const float* radii = nullptr;
  /// The bounds of the groups' centers, laid out as BodyArrays::bounds.
  const float* bounds = nullptr;
  /// From one bound to the next: the number of groups, padded to lanes.
  std::size_t bounds_stride = 0;
  /// The bounds of all centers.
  const CenterBounds* all = nullptr;
};

}  // namespace galactic::simulation
