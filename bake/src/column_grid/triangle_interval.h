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
/// strictly closer than `radius` to the triangle; none if there are none. They form one open
/// interval because triangle and ball are convex: the hull of the intervals of its corners
/// (spheres), edges (cylinders) and face (two offset planes). This is the scalar double-precision
/// reference for the vectorized engine.
[[nodiscard]] std::optional<HeightInterval> touchingHeights(const std::array<Point, 3>& triangle,
                                                            double x, double z, double radius);

/// The quantities of a triangle that all vertical lines share.
struct PreparedTriangle {
  /// From a corner to the next one.
  struct Edge {
    Point from{};
    Point edge{};
    /// Horizontal length and unit direction in the ground plane; 0 for a vertical edge.
    double run = 0;
    double x = 0;
    double z = 0;
    double length = 0;
    /// Rise per `run`, and `length` per `run`.
    double slope = 0;
    double stretch = 0;
  };

  /// Coordinates in a triangle's plane: along its longest edge, and along the altitude on that
  /// edge. The corners are at (0, 0), (length, 0) and (foot, height). Unlike a cross product of two
  /// edges, the normal stays perpendicular to the longest edge even on needles.
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

  /// The origin of all other members, so that rounding depends on the triangle's size and not on
  /// its position in the world.
  Point first;
  std::array<Point, 3> corners;
  std::array<Edge, 3> edges;
  /// None when the triangle is too flat to have a normal.
  std::optional<Face> face;
};

/// The quantities of a triangle that all cells share.
struct CellTriangle {
  /// The direction perpendicular to an edge and to the x or the z axis: its component along the
  /// other of these two axes, and upward. 0 if the edge does not extend along that other axis.
  struct SideNormal {
    double across = 0;
    double up = 0;
  };

  explicit CellTriangle(const std::array<Point, 3>& triangle);

  PreparedTriangle prepared;
  /// For each edge, the normals perpendicular to the x axis and to the z axis.
  std::array<std::array<SideNormal, 2>, 3> side_normals{};
};

/// The heights at which a ball touches the triangle with its center anywhere in the square of half
/// edge `half` around (x, z).
[[nodiscard]] std::optional<HeightInterval> touchingHeightsOverCell(const CellTriangle& triangle,
                                                                    double x, double z, double half,
                                                                    double radius);

/// Squared distance from `point` to the triangle: the least over its edges and, if the foot lies
/// inside, its plane. Safe on needles, unlike the usual barycentric closest point.
[[nodiscard]] double squaredDistance(const Point& point, const std::array<Point, 3>& triangle);

}  // namespace galactic::bake
