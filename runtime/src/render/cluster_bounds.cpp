#include "render/cluster_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace galactic::render {
namespace {

struct Vec3d {
  double x = 0;
  double y = 0;
  double z = 0;
};

Vec3d wide(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Vec3d operator-(const Vec3d& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

float roundedUp(double value) {
  const auto rounded = static_cast<float>(value);
  if (static_cast<double>(rounded) >= value) return rounded;
  return std::nextafter(rounded, std::numeric_limits<float>::infinity());
}

void setBox(ClusterBounds& bounds, std::span<const Vec3> positions) {
  Vec3 low = positions[0];
  Vec3 high = positions[0];
  for (const Vec3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bounds.centre = {0.5F * low.x + 0.5F * high.x, 0.5F * low.y + 0.5F * high.y,
                   0.5F * low.z + 0.5F * high.z};
  const Vec3d centre = wide(bounds.centre);
  Vec3d half;
  double squared_radius = 0;
  for (const Vec3& p : positions) {
    const Vec3d d = wide(p) - centre;
    half = {std::max(half.x, std::abs(d.x)), std::max(half.y, std::abs(d.y)),
            std::max(half.z, std::abs(d.z))};
    squared_radius = std::max(squared_radius, dot(d, d));
  }
  bounds.half_extents = {roundedUp(half.x), roundedUp(half.y), roundedUp(half.z)};
  bounds.radius = roundedUp(std::sqrt(squared_radius));
}

/// Of all triangles that have one.
std::vector<Vec3d> unitNormals(std::span<const Vec3> positions,
                               std::span<const std::array<std::uint8_t, 3>> triangles) {
  std::vector<Vec3d> normals;
  normals.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    const Vec3d origin = wide(positions[a]);
    const Vec3d normal = cross(wide(positions[b]) - origin, wide(positions[c]) - origin);
    const double length = std::sqrt(dot(normal, normal));
    if (length > 0) normals.push_back({normal.x / length, normal.y / length, normal.z / length});
  }
  return normals;
}

/// The cone about the mean of the normals. With cos(a) the smallest cosine between a normal and the
/// axis, the test of schema/render.fbs with the cutoff sin(a) leaves no triangle out that faces the
/// eye.
void setCone(ClusterBounds& bounds, const std::vector<Vec3d>& normals) {
  // A wider cone faces away from hardly any place.
  constexpr double kWidestCone = 0.1;
  // Over what the axis loses by rounding.
  constexpr double kMargin = 1e-4;
  Vec3d sum;
  for (const Vec3d& n : normals) sum = {sum.x + n.x, sum.y + n.y, sum.z + n.z};
  const double length = std::sqrt(dot(sum, sum));
  if (!(length > kMargin)) return;
  const Vec3 axis{static_cast<float>(sum.x / length), static_cast<float>(sum.y / length),
                  static_cast<float>(sum.z / length)};
  double least = 1;
  for (const Vec3d& n : normals) least = std::min(least, dot(n, wide(axis)));
  if (least < kWidestCone) return;
  const double cutoff = std::sqrt(1 - least * least) + kMargin;
  if (cutoff >= 1) return;
  bounds.axis = axis;
  bounds.cutoff = roundedUp(cutoff);
}

}  // namespace

ClusterBounds boundsOf(std::span<const Vec3> positions,
                       std::span<const std::array<std::uint8_t, 3>> triangles) {
  ClusterBounds bounds;
  setBox(bounds, positions);
  setCone(bounds, unitNormals(positions, triangles));
  return bounds;
}

}  // namespace galactic::render
