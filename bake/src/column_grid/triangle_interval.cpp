#include "column_grid/triangle_interval.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace galactic::bake {
namespace {

// A triangle grown by a ball is the union of convex pieces: a ball at each corner, a cylinder along
// each edge, and the prism that the face sweeps when it moves by the radius along its normal. A
// vertical line meets each piece in one interval, and the hull of these intervals is the result.
// The ends of every piece lie within rounding of the grown triangle, however thin or steep the
// triangle is. What a badly conditioned piece loses, its neighbors cover.

using Corners = std::array<Point, 3>;

/// A triangle whose altitude is smaller than this share of its longest edge has no usable normal.
/// Its edges cover it to within far less than rounding.
constexpr double kFlatness = 1e-12;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Point plusScaled(const Point& a, double factor, const Point& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The triangle with its first corner at the origin, so that rounding depends on the triangle's
/// size and not on its position in the world.
Corners relativeToFirstCorner(const Corners& triangle) {
  return {Point{0, 0, 0}, minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0])};
}

/// A vertical line.
struct Line {
  double x = 0;
  double z = 0;
};

/// The smallest interval that holds everything added to it.
struct Hull {
  double lo = std::numeric_limits<double>::infinity();
  double hi = -std::numeric_limits<double>::infinity();

  void add(double from, double to) {
    lo = std::min(lo, from);
    hi = std::max(hi, to);
  }
};

/// The part of a line that satisfies all conditions so far.
struct Clip {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();

  /// Keeps the heights t with constant + slope * t > 0.
  void keepPositive(double constant, double slope) {
    if (slope > 0) {
      lo = std::max(lo, -constant / slope);
    } else if (slope < 0) {
      hi = std::min(hi, -constant / slope);
    } else if (!(constant > 0)) {
      hi = -std::numeric_limits<double>::infinity();
    }
  }
};

using Edge = PreparedTriangle::Edge;
using Face = PreparedTriangle::Face;

/// None when the triangle is too flat to have a normal.
std::optional<Face> makeFace(const Corners& triangle) {
  std::size_t longest = 0;
  double longest_squared = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point edge = minus(triangle[(k + 1) % 3], triangle[k]);
    if (const double squared = dot(edge, edge); squared > longest_squared) {
      longest = k;
      longest_squared = squared;
    }
  }
  if (!(longest_squared > 0)) return std::nullopt;
  Face frame;
  frame.origin = triangle[longest];
  frame.length = std::sqrt(longest_squared);
  const Point edge = minus(triangle[(longest + 1) % 3], frame.origin);
  for (std::size_t c = 0; c < 3; ++c) frame.along[c] = edge[c] / frame.length;
  const Point apex = minus(triangle[(longest + 2) % 3], frame.origin);
  frame.foot = dot(apex, frame.along);
  Point altitude = plusScaled(apex, -frame.foot, frame.along);
  // Orthogonalize again: on a needle, the rounding of the first subtraction is as large as the
  // altitude.
  altitude = plusScaled(altitude, -dot(altitude, frame.along), frame.along);
  frame.height = std::sqrt(dot(altitude, altitude));
  if (!(frame.height > kFlatness * frame.length)) return std::nullopt;
  for (std::size_t c = 0; c < 3; ++c) frame.across[c] = altitude[c] / frame.height;
  frame.normal = cross(frame.along, frame.across);
  return frame;
}

Edge makeEdge(const Point& from, const Point& to) {
  Edge made{.from = from, .edge = minus(to, from)};
  const Point& edge = made.edge;
  made.length = std::sqrt(dot(edge, edge));
  made.run = std::sqrt(edge[0] * edge[0] + edge[2] * edge[2]);
  if (!(made.run > 0)) return made;
  made.x = edge[0] / made.run;
  made.z = edge[2] / made.run;
  made.slope = edge[1] / made.run;
  made.stretch = made.length / made.run;
  return made;
}

/// Ball around a corner.
void addCorner(const Point& corner, Line line, double radius, Hull& hull) {
  const double dx = line.x - corner[0];
  const double dz = line.z - corner[2];
  const double rest = radius * radius - dx * dx - dz * dz;
  if (!(rest > 0)) return;
  const double half = std::sqrt(rest);
  hull.add(corner[1] - half, corner[1] + half);
}

/// Cylinder along an edge, cut off perpendicularly at both ends. A vertical edge adds nothing,
/// because the balls at its corners have the same hull.
void addEdge(const Edge& edge, Line line, double radius, Hull& hull) {
  if (!(edge.run > 0)) return;
  const double qx = line.x - edge.from[0];
  const double qz = line.z - edge.from[2];
  // The common perpendicular of the edge and a vertical line is horizontal.
  const double aside = qz * edge.x - qx * edge.z;
  const double rest = radius * radius - aside * aside;
  if (!(rest > 0)) return;
  const double along = qx * edge.x + qz * edge.z;
  const double middle = edge.from[1] + along * edge.slope;
  const double half = std::sqrt(rest) * edge.stretch;
  Clip clip{middle - half, middle + half};
  // Between the planes perpendicular to the edge through its ends.
  const double rise = edge.edge[1];
  const double start = along * edge.run - edge.from[1] * rise;
  clip.keepPositive(start, rise);
  clip.keepPositive(edge.length * edge.length - start, -rise);
  if (clip.lo < clip.hi) hull.add(clip.lo, clip.hi);
}

/// Prism that the face sweeps when it moves by the radius to both sides along its normal.
void addFace(const Face& face, Line line, double radius, Hull& hull) {
  const Point foot = minus({line.x, 0, line.z}, face.origin);
  const double off = dot(face.normal, foot);
  const double along = dot(face.along, foot);
  const double across = dot(face.across, foot);
  Clip clip;
  clip.keepPositive(radius - off, -face.normal[1]);
  clip.keepPositive(radius + off, face.normal[1]);
  clip.keepPositive(across, face.across[1]);
  clip.keepPositive(face.height * along - face.foot * across,
                    face.height * face.along[1] - face.foot * face.across[1]);
  const double beyond = face.length - face.foot;
  clip.keepPositive(face.height * (face.length - along) - beyond * across,
                    -face.height * face.along[1] - beyond * face.across[1]);
  if (clip.lo < clip.hi) hull.add(clip.lo, clip.hi);
}

/// Adds all pieces of a grown triangle on one line, which is also relative to the first corner.
void addTriangle(const PreparedTriangle& triangle, Line line, double radius, Hull& hull) {
  for (std::size_t k = 0; k < 3; ++k) {
    addCorner(triangle.corners[k], line, radius, hull);
    addEdge(triangle.edges[k], line, radius, hull);
  }
  if (triangle.face) addFace(*triangle.face, line, radius, hull);
}

std::optional<HeightInterval> inWorld(const Hull& hull, double height) {
  if (!(hull.hi > hull.lo)) return std::nullopt;
  return HeightInterval{hull.lo + height, hull.hi + height};
}

/// A square of ball centers.
struct Cell {
  Line center;
  double half = 0;
  double radius = 0;
};

/// Of all centers in the cell, the one nearest to the corner reaches farthest up and down on the
/// ball around it.
void addCornerOverCell(const Point& corner, const Cell& cell, Hull& hull) {
  const double dx = std::max(std::abs(cell.center.x - corner[0]) - cell.half, 0.0);
  const double dz = std::max(std::abs(cell.center.z - corner[2]) - cell.half, 0.0);
  addCorner(corner, {corner[0] + dx, corner[2] + dz}, cell.radius, hull);
}

/// Adds the heights at which a center on a side of the cell touches the edge with a contact normal
/// perpendicular to both side and edge. There, a height can be extreme between the cell's corners.
/// `side_axis` (0 or 2) is the axis along which the side runs.
void addEdgeOverSide(const Edge& of, const CellTriangle::SideNormal& normal, const Cell& cell,
                     std::size_t side_axis, Hull& hull) {
  const std::size_t across_axis = 2 - side_axis;
  const Point& from = of.from;
  const Point& edge = of.edge;
  const std::array<double, 3> center{cell.center.x, 0, cell.center.z};
  // Without extent across the side, the edge has a horizontal contact normal (or, parallel to the
  // side, is covered by the sides across it), so no height is extreme.
  const double across = edge[across_axis];
  if (across == 0) return;
  for (const double side : {-cell.half, cell.half}) {
    const double gap = center[across_axis] + side - from[across_axis];
    for (const double reach : {-cell.radius, cell.radius}) {
      const double offset = gap - reach * normal.across;
      // Most sides touch the edge's line beyond its ends, which this finds without a division.
      const double forward = across < 0 ? -offset : offset;
      if (!(forward >= 0 && forward <= std::abs(across))) continue;
      const double part = offset / across;
      const double along = from[side_axis] + part * edge[side_axis];
      if (std::abs(center[side_axis] - along) > cell.half) continue;
      const double height = from[1] + part * edge[1] + reach * normal.up;
      hull.add(height, height);
    }
  }
}

double squaredDistanceToSegment(const Point& point, const Point& from, const Point& to) {
  const Point edge = minus(to, from);
  const Point offset = minus(point, from);
  const double squared = dot(edge, edge);
  const double part = squared > 0 ? std::clamp(dot(offset, edge) / squared, 0.0, 1.0) : 0.0;
  const Point rest = plusScaled(offset, -part, edge);
  return dot(rest, rest);
}

}  // namespace

PreparedTriangle::PreparedTriangle(const std::array<Point, 3>& triangle)
    : first(triangle[0]),
      corners(relativeToFirstCorner(triangle)),
      edges{makeEdge(corners[0], corners[1]), makeEdge(corners[1], corners[2]),
            makeEdge(corners[2], corners[0])},
      face(makeFace(corners)) {}

std::optional<HeightInterval> touchingHeights(const std::array<Point, 3>& triangle, double x,
                                              double z, double radius) {
  Hull hull;
  addTriangle(PreparedTriangle(triangle), {x - triangle[0][0], z - triangle[0][2]}, radius, hull);
  return inWorld(hull, triangle[0][1]);
}

CellTriangle::CellTriangle(const std::array<Point, 3>& triangle) : prepared(triangle) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Point& edge = prepared.edges[k].edge;
    for (const std::size_t side_axis : {0U, 2U}) {
      const double across = edge[2 - side_axis];
      if (across == 0) continue;
      const double length = std::sqrt(edge[1] * edge[1] + across * across);
      side_normals[k][side_axis / 2] = {.across = -edge[1] / length, .up = across / length};
    }
  }
}

std::optional<HeightInterval> touchingHeightsOverCell(const CellTriangle& triangle, double x,
                                                      double z, double half, double radius) {
  // Over the square of centers, the upper (lower) end is a concave (convex) function. Its extreme
  // lies over a corner of the triangle, at a corner of the square, or on a side of the square where
  // an edge's contact normal is perpendicular to that side.
  const PreparedTriangle& prepared = triangle.prepared;
  const Cell cell{{x - prepared.first[0], z - prepared.first[2]}, half, radius};
  Hull hull;
  for (const double dx : {-half, half}) {
    for (const double dz : {-half, half}) {
      addTriangle(prepared, {cell.center.x + dx, cell.center.z + dz}, radius, hull);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    addCornerOverCell(prepared.corners[k], cell, hull);
    for (const std::size_t side_axis : {0U, 2U}) {
      addEdgeOverSide(prepared.edges[k], triangle.side_normals[k][side_axis / 2], cell, side_axis,
                      hull);
    }
  }
  return inWorld(hull, prepared.first[1]);
}

double squaredDistance(const Point& point, const std::array<Point, 3>& triangle) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    least = std::min(least, squaredDistanceToSegment(point, triangle[k], triangle[(k + 1) % 3]));
  }
  const std::optional<Face> face = makeFace(triangle);
  if (!face) return least;
  const Point offset = minus(point, face->origin);
  const double along = dot(offset, face->along);
  const double across = dot(offset, face->across);
  const bool over_face =
      across >= 0 && face->height * along >= face->foot * across &&
      face->height * (face->length - along) >= (face->length - face->foot) * across;
  if (!over_face) return least;
  Point rest = plusScaled(offset, -along, face->along);
  rest = plusScaled(rest, -across, face->across);
  return std::min(least, dot(rest, rest));
}

}  // namespace galactic::bake
