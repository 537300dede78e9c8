#pragma once
#include <cstddef>
#include <cstdint>

namespace galactic::simulation {

/// Spheres are handled eight at a time.
inline constexpr std::size_t kLanes = 8;

/// Numbers that bound centers: least and most x, then y, then z, meters.
inline constexpr std::size_t kBounds = 6;

/// These of a set of spheres, and the last two again: one vector.
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
  /// Spheres; the arrays go on to paddedToLanes(count) with copies of the last one, so that whole
  /// lanes can be read and an extra lane changes no answer.
  std::uint32_t count = 0;
};

/// A span of ranges, but a plain one: kernels read it, which instantiate no library templates.
struct RadiusRanges {
  const RadiusRange* first = nullptr;
  std::size_t count = 0;

  constexpr RadiusRanges() = default;
  /// Of a vector, a span, or an array of them. Implicit, as those of a std::span are.
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

/// The spheres of one env's robot, or of the object that it holds: centers in the world frame as
/// three arrays, radius by radius.
struct SphereBatch {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  /// Ascending `first`, no two of one radius.
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

/// The spheres of one env's robot by eights, with bounds, which spare most looks at them.
struct BoundedSpheres {
  /// World frame, meters; spheres 8 g to 8 g + 7 are group g.
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t group_count = 0;
  /// Of each group, meters, padded to lanes.
  const float* radii = nullptr;
  /// Of their centers, as BodyArrays::bounds.
  const float* bounds = nullptr;
  /// From one bound to the next: groups, padded to lanes.
  std::size_t bounds_stride = 0;
  /// Of all centers.
  const CenterBounds* all = nullptr;
};

}  // namespace galactic::simulation
