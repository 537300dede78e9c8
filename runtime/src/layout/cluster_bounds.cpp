#include "layout/cluster_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace galactic::render {
namespace {

struct Vec3d {
  double x = 0;
  double y = 0;
  double z = 0;
};

Vec3d widen(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Vec3 narrow(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
Vec3d operator+(const Vec3d& a, const Vec3d& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3d operator-(const Vec3d& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3d operator*(const Vec3d& v, double factor) {
  return {v.x * factor, v.y * factor, v.z * factor};
}
double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double norm(const Vec3d& v) { return std::sqrt(dot(v, v)); }

/// Cosine of the widest cone worth storing: a wider one faces away from too few viewpoints.
constexpr double kWidestCone = 0.1;
/// More than the rounding of the floats in which a renderer compares with the cutoff.
constexpr double kCutoffMargin = 1e-6;

/// The smallest float that is not below `value`.
float roundedUp(double value) {
  const auto nearest = static_cast<float>(value);
  if (static_cast<double>(nearest) >= value) return nearest;
  return std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

Vec3d pointOf(const LatticeVertex& vertex, double step) {
  return {vertex.at[0] * step, vertex.at[1] * step, vertex.at[2] * step};
}

/// The nearest float, as a double (Veltkamp's splitting; Dekker 1971).
double roundedToFloat(double value) {
  constexpr double kSplitter = 0x1p29 + 1;
  const double scaled = value * kSplitter;
  return scaled - (scaled - value);
}

/// Makes the numbers floats before they are converted, so that it does not matter where a compiler
/// omits conversions.
Vec3 nearestFloats(const Vec3d& v) {
  return narrow({roundedToFloat(v.x), roundedToFloat(v.y), roundedToFloat(v.z)});
}

/// Unit normals of the triangles that have an area.
std::vector<Vec3d> normalsOf(const LatticeCluster& cluster) {
  std::vector<Vec3d> normals;
  normals.reserve(cluster.triangles.size());
  for (const auto& t : cluster.triangles) {
    const Vec3d a = pointOf(cluster.vertices[t[0]], 1);
    const Vec3d b = pointOf(cluster.vertices[t[1]], 1);
    const Vec3d c = pointOf(cluster.vertices[t[2]], 1);
    const Vec3d normal = cross(b - a, c - a);
    if (const double length = norm(normal); length > 0) normals.push_back(normal * (1 / length));
  }
  return normals;
}

/// Sets axis and cutoff; see RenderMeshes.cluster_bounds in the schema. Take a sphere of radius r
/// about c that contains all triangles, and normals at most alpha from the axis. If the axis is at
/// phi from the direction v to c and cos phi >= sin alpha + r / |v|, then cos(phi + alpha) =
/// sin((90 - phi) - alpha) >= cos phi - sin alpha >= r / |v|, so every triangle is seen from
/// behind.
void addCone(const LatticeCluster& cluster, std::array<float, kBoundsRows>& rows) {
  rows[kConeCutoffRow] = kNoCone;
  if (cluster.two_sided) return;
  const std::vector<Vec3d> normals = normalsOf(cluster);
  if (normals.empty()) return;
  Vec3d sum;
  for (const Vec3d& normal : normals) sum = sum + normal;
  const double total = norm(sum);
  if (!(total > 0)) return;
  const Vec3 axis = nearestFloats(sum * (1 / total));
  const Vec3d stored = widen(axis);
  const double length = norm(stored);
  if (!(length > 0)) return;
  double least = 1;
  for (const Vec3d& normal : normals) least = std::min(least, dot(normal, stored) / length);
  if (least <= kWidestCone) return;
  rows[kConeAxisRow] = axis.x;
  rows[kConeAxisRow + 1] = axis.y;
  rows[kConeAxisRow + 2] = axis.z;
  const double cutoff = std::sqrt(std::max(0.0, 1 - least * least)) + kCutoffMargin;
  rows[kConeCutoffRow] = std::min(1.0F, roundedUp(cutoff));
}

}  // namespace

ClusterBounds boundsOf(const LatticeCluster& cluster, double step) {
  ClusterBounds bounds;
  Vec3d low = pointOf(cluster.vertices.front(), step);
  Vec3d high = low;
  for (const LatticeVertex& vertex : cluster.vertices) {
    const Vec3d p = pointOf(vertex, step);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  // Lattice points are floats.
  bounds.low = narrow(low);
  bounds.high = narrow(high);
  const Vec3 center = nearestFloats((low + high) * 0.5);
  const Vec3d stored = widen(center);
  bounds.rows[kCenterRow] = center.x;
  bounds.rows[kCenterRow + 1] = center.y;
  bounds.rows[kCenterRow + 2] = center.z;
  bounds.rows[kHalfExtentRow] = roundedUp(std::max(high.x - stored.x, stored.x - low.x));
  bounds.rows[kHalfExtentRow + 1] = roundedUp(std::max(high.y - stored.y, stored.y - low.y));
  bounds.rows[kHalfExtentRow + 2] = roundedUp(std::max(high.z - stored.z, stored.z - low.z));
  double squared = 0;
  for (const LatticeVertex& vertex : cluster.vertices) {
    const Vec3d away = pointOf(vertex, step) - stored;
    squared = std::max(squared, dot(away, away));
  }
  // One float farther, because the root was rounded.
  bounds.rows[kRadiusRow] =
      std::nextafter(roundedUp(std::sqrt(squared)), std::numeric_limits<float>::infinity());
  addCone(cluster, bounds.rows);
  return bounds;
}

}  // namespace galactic::render
