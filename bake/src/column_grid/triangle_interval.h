#pragma once
#include <array>
#include <optional>

#include "galactic/bake/triangle_mesh.h"

namespace galactic::bake {

using Point = std::array<double, 3>;

/// The corners of a triangle of a mesh.
[[nodiscard]] inline std::array<Point, 3> pointsOf(const TriangleMesh& mesh,
                                                   const Triangle& triangle) {
  std::array<Point, 3> points{};
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3& v = mesh.vertices[triangle[n]];
    points[n] = {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }
  return points;
}

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

/// What intervals on many lines need of one triangle.
struct PreparedTriangle {
  /// From a corner to the next one.
  struct Edge {
    Point from{};
    Point edge{};
    /// In the plane: how far it goes, and its unit direction there; 0 of a vertical edge.
    double run = 0;
    double x = 0;
    double z = 0;
    double length = 0;
    /// Height and length by run.
    double slope = 0;
    double stretch = 0;
  };

  /// Coordinates in a triangle's plane: along its longest edge, and along the altitude on that
  /// edge. In them the corners are (0, 0), (length, 0) and (foot, height). Unlike the cross product
  /// of two edges, this stays perpendicular to the longest edge on needles.
  struct Face {
    Point origin{};
    Point along{};
    Point across{};
    Point normal{};
    double length = 0;
    double foot = 0;
    double height = 0;
  };

  explicit PreparedTriangle(const std::array<Point, 3>& triangle);

  /// What all else is relative to, so that rounding follows the triangle's size, not its place in
  /// the world.
  Point first;
  std::array<Point, 3> corners;
  std::array<Edge, 3> edges;
  /// None when the triangle is too flat to have a normal.
  std::optional<Face> face;
};

/// What intervals over many cells need of one triangle.
struct CellTriangle {
  /// Of an edge, at a right angle to it and to the x or the z axis: how far it goes along the other
  /// one of these, and up. 0 where the edge does not go along that one.
  struct SideNormal {
    double across = 0;
    double up = 0;
  };

  explicit CellTriangle(const std::array<Point, 3>& triangle);

  PreparedTriangle prepared;
  /// By edge: at a right angle to the x axis, and to the z axis.
  std::array<std::array<SideNormal, 2>, 3> side_normals{};
};

/// The same for a center anywhere over the square of half edge `half` around (x, z): the heights at
/// which some center in the square touches.
[[nodiscard]] std::optional<HeightInterval> touchingHeightsOverCell(const CellTriangle& triangle,
                                                                    double x, double z, double half,
                                                                    double radius);

/// Squared distance from `point` to the triangle: the least over its edges, and its plane where the
/// foot lies inside. Safe on needles, where the usual barycentric closest point is not.
[[nodiscard]] double squaredDistance(const Point& point, const std::array<Point, 3>& triangle);

}  // namespace galactic::bake
