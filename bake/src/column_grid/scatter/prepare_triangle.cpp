#include <algorithm>
#include <cmath>

#include "column_grid/scatter/scatter.h"

namespace galactic::bake {
namespace {

using Corner = std::array<double, 3>;

/// An edge with a smaller horizontal length counts as vertical, meters.
constexpr double kVerticalLength = 1e-7;
/// A face whose unit normal has a smaller y counts as vertical.
constexpr double kVerticalNormal = 1e-6;

float asFloat(double value) { return static_cast<float>(value); }

void prepareFace(const Corner& b, const Corner& c, ScatterTriangle& out) {
  Corner normal{b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]};
  const double length =
      std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  out.has_face = length > 0 && std::abs(normal[1]) > kVerticalNormal * length;
  if (!out.has_face) return;
  const double scale = (normal[1] < 0 ? -1 : 1) / length;
  out.normal_x = asFloat(normal[0] * scale);
  out.normal_y = asFloat(normal[1] * scale);
  out.normal_z = asFloat(normal[2] * scale);
  out.inverse_normal_y = asFloat(1 / (normal[1] * scale));
}

/// `side` is +1 or -1: the winding of the corners as seen from above.
ScatterEdge prepareEdge(const Corner& start, const Corner& end, double side,
                        const ScatterTriangle& triangle, float radius) {
  ScatterEdge edge;
  const double dx = end[0] - start[0];
  const double dy = end[1] - start[1];
  const double dz = end[2] - start[2];
  const double ground = std::sqrt(dx * dx + dz * dz);
  edge.vertical = ground < kVerticalLength;
  if (edge.vertical) return edge;
  const double length = std::sqrt(ground * ground + dy * dy);
  const double ux = dx / ground;
  const double uz = dz / ground;
  const double inward_x = uz * side;
  const double inward_z = -ux * side;
  edge.distance_x = asFloat(inward_x);
  edge.distance_z = asFloat(inward_z);
  edge.distance_0 = asFloat(-(start[0] * inward_x + start[2] * inward_z));
  edge.along_x = asFloat(ux);
  edge.along_z = asFloat(uz);
  edge.along_0 = asFloat(-(start[0] * ux + start[2] * uz));
  edge.start_y = asFloat(start[1]);
  edge.slope = asFloat(dy / ground);
  edge.secant = asFloat(length / ground);
  // The planes that cut off an almost level edge are almost vertical. This keeps their heights
  // finite, though far away.
  constexpr double kLevelSine = 1e-8;
  double sine = dy / length;
  if (std::abs(sine) < kLevelSine) sine = sine < 0 ? -kLevelSine : kLevelSine;
  edge.cotangent = asFloat(ground / length / sine);
  edge.end_rise = asFloat(length / sine);
  edge.face_shift = asFloat((static_cast<double>(triangle.normal_x) * inward_x +
                             static_cast<double>(triangle.normal_z) * inward_z) *
                            static_cast<double>(radius));
  return edge;
}

}  // namespace

ScatterTriangle prepareTriangle(const std::array<std::array<double, 3>, 3>& corners, float radius) {
  ScatterTriangle out;
  const Corner& origin = corners[0];
  out.origin_x_high = asFloat(origin[0]);
  out.origin_x_low = asFloat(origin[0] - static_cast<double>(out.origin_x_high));
  out.origin_y = asFloat(origin[1]);
  out.origin_z = origin[2];
  std::array<Corner, 3> local{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) local[i][axis] = corners[i][axis] - origin[axis];
    out.corner_x[i] = asFloat(local[i][0]);
    out.corner_y[i] = asFloat(local[i][1]);
    out.corner_z[i] = asFloat(local[i][2]);
  }
  out.min_x = std::min({out.corner_x[0], out.corner_x[1], out.corner_x[2]});
  out.max_x = std::max({out.corner_x[0], out.corner_x[1], out.corner_x[2]});
  out.min_y = std::min({out.corner_y[0], out.corner_y[1], out.corner_y[2]});
  out.max_y = std::max({out.corner_y[0], out.corner_y[1], out.corner_y[2]});
  out.min_z = std::min({out.corner_z[0], out.corner_z[1], out.corner_z[2]});
  out.max_z = std::max({out.corner_z[0], out.corner_z[1], out.corner_z[2]});
  prepareFace(local[1], local[2], out);
  // The sign of the winding in (x, z). With it as `side`, the triangle's inside has positive
  // distances.
  const double sense = local[1][2] * local[2][0] - local[1][0] * local[2][2];
  const double side = sense < 0 ? -1 : 1;
  for (std::size_t i = 0; i < 3; ++i) {
    out.edges[i] = prepareEdge(local[i], local[(i + 1) % 3], side, out, radius);
  }
  return out;
}

}  // namespace galactic::bake
