#pragma once
#include <array>
#include <optional>

namespace galactic::bake {

using Point = std::array<double, 3>;

/// An interval of heights in double precision.
struct HeightInterval {
  double lo = 0;
  double hi = 0;
};

/// The heights at which the center of a ball of `radius` on the vertical line through (x, z) is
/// strictly closer than `radius` to the triangle; none if there are none. It is one open interval
/// because triangle and ball are convex: the hull of what its corners (spheres), edges (cylinders)
/// and face (two offset planes) give. Scalar double-precision reference of the vectorised engine.
[[nodiscard]] std::optional<HeightInterval> touchingHeights(const std::array<Point, 3>& triangle,
                                                            double x, double z, double radius);

/// The same for a center anywhere over the square of half edge `half` around (x, z): the heights at
/// which some center in the square touches.
[[nodiscard]] std::optional<HeightInterval> touchingHeightsOverCell(
    const std::array<Point, 3>& triangle, double x, double z, double half, double radius);

/// Squared distance from `point` to the triangle: the least over its edges, and its plane where the
/// foot lies inside. Safe on needles, where the usual barycentric closest point is not.
[[nodiscard]] double squaredDistance(const Point& point, const std::array<Point, 3>& triangle);

}  // namespace galactic::bake
