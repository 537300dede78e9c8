#pragma once
#include <array>
#include <optional>

#include "galactic/pose.h"
#include "galactic/shapes.h"

namespace galactic::simulation {

/// A resting object as the narrow phase reads it: one cache line.
struct alignas(64) RestingBox {
  /// World frame, meters.
  Vec3 center;
  /// No point of the box lies further than this above or below the center, meters. Rounded up, so
  /// that the test of heights rejects no sphere that the test of distances accepts.
  float half_height = 0;
  /// The box's axes as unit vectors of the world frame.
  Vec3 axis_x{1, 0, 0};
  Vec3 axis_y{0, 1, 0};
  Vec3 axis_z{0, 0, 1};
  /// Half the edge lengths along the axes, meters.
  Vec3 half_extents;
};
static_assert(sizeof(RestingBox) == 64);

/// The oriented box of an object at `world_from_object`. Rotations that are not quite of unit
/// length are normalized.
[[nodiscard]] RestingBox restingBox(const OrientedBox& box, const Pose& world_from_object) noexcept;

/// How far the box reaches from its center along the world's axes: half the size of its
/// axis-aligned bounds, meters, rounded to nearest.
[[nodiscard]] Vec3 halfBounds(const RestingBox& box) noexcept;

/// The point of the box nearest to `point`, both in the world frame; `point` itself if it is
/// inside.
[[nodiscard]] Vec3 nearestPoint(const RestingBox& box, const Vec3& point) noexcept;

/// Squared distance from `point` (world frame) to the box, square meters: 0 inside, NaN if a
/// coordinate is NaN.
[[nodiscard]] float squaredDistance(const RestingBox& box, const Vec3& point) noexcept;

/// Whether sphere and box overlap: distance from center to box < radius (touching is no overlap).
/// False if a coordinate is NaN.
[[nodiscard]] bool overlaps(const RestingBox& box, const Vec3& center, float radius) noexcept;

/// The heights (world Y of its center) at which a ball of `radius` on the vertical line at (x, z)
/// overlaps the box; none if it misses. The ball overlaps where its center lies in the box grown by
/// the radius: three boxes, each longer by the radius at the ends of one axis, twelve cylinders
/// around the edges and eight balls around the corners. Their union is convex, so a vertical line
/// intersects it in one interval: the hull of its intersections with the parts.
[[nodiscard]] std::optional<Span> overlapHeights(const RestingBox& box, float x, float z,
                                                 float radius) noexcept;

/// How far a ball of `radius` can move from `from` along the unit vector `along` before it overlaps
/// the box, meters: 0 if it does so at the start, none if it passes by. Uses the same parts of the
/// grown box as overlapHeights().
[[nodiscard]] std::optional<double> wayToOverlap(const RestingBox& box, const Vec3& from,
                                                 const std::array<double, 3>& along,
                                                 float radius) noexcept;

/// How far `moving` has to be shifted up (negative: down) to overlap `fixed`: an interval of
/// shifts, meters; none if it misses. The shifts are those at which none of the fifteen axes of the
/// separating-axis test (Gottschalk, Lin, Manocha 1996) separates the boxes; each axis rules out
/// all but one interval.
[[nodiscard]] std::optional<Span> overlapShifts(const RestingBox& moving,
                                                const RestingBox& fixed) noexcept;

}  // namespace galactic::simulation
