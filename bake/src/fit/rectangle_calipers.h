#pragma once
#include <span>
#include <vector>

namespace galactic::bake::fit {

/// A point or direction in a plane.
struct Vec2d {
  double x = 0;
  double y = 0;

  friend constexpr bool operator==(const Vec2d&, const Vec2d&) = default;
};

/// Stores the corners of the convex hull of `points` in `polygon`, counter-clockwise and without
/// collinear ones: two for collinear points, one for equal points. Sorts `points`. (Andrew's
/// monotone chain, 1979.)
void convexPolygon(std::vector<Vec2d>& points, std::vector<Vec2d>& polygon);

/// The unit direction of a side of the rectangle of least area around the convex `polygon`
/// (counter-clockwise, from convexPolygon()). It is the direction of one of the polygon's edges;
/// (1, 0) for a single corner. Sides shorter than `min_side` count as that long. (Freeman and
/// Shapira 1975, by rotating calipers as in Toussaint 1983: linear time.)
[[nodiscard]] Vec2d leastRectangleDirection(std::span<const Vec2d> polygon, double min_side);

}  // namespace galactic::bake::fit
