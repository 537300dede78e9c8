#include "fit/hull_planes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "fit/axes.h"
#include "fit/rotation.h"

namespace galactic::bake::fit {
namespace {

/// Lattice steps from the middle of the cube to a face.
constexpr int kLattice = 2;
/// A plane that cuts less off the box is not worth storing, meters.
constexpr double kLeastCut = 1e-4;
/// Added to the offsets, so that points are behind the planes whatever order of float operations a
/// reader uses: a length in meters, and a share of the greatest coordinate (eight roundings).
constexpr double kPadding = 1e-6;
constexpr double kRelativePadding = 8 * 6e-8;

/// The directions in the frame of the box, in a fixed order, so that packs are reproducible.
std::vector<Vec3d> directions() {
  std::vector<Vec3d> result;
  for (int x = -kLattice; x <= kLattice; ++x) {
    for (int y = -kLattice; y <= kLattice; ++y) {
      for (int z = -kLattice; z <= kLattice; ++z) {
        const bool is_axis = (x != 0) + (y != 0) + (z != 0) < 2;
        if (is_axis || std::gcd(std::gcd(x, y), z) > 1) continue;
        result.push_back(normalized(
            Vec3d{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
      }
    }
  }
  return result;
}

double greatestCoordinate(std::span<const Vec3> points) {
  float greatest = 0;
  for (const Vec3& p : points) {
    greatest = std::max({greatest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  return static_cast<double>(greatest);
}

double extentAlong(std::span<const Vec3> points, const Vec3d& direction) {
  double extent = -std::numeric_limits<double>::infinity();
  for (const Vec3& p : points) extent = std::max(extent, dot(widen(p), direction));
  return extent;
}

/// Extent of the box from its center, in its own frame.
double extentAlong(const Vec3d& half_extents, const Vec3d& direction) {
  return half_extents.x * std::abs(direction.x) + half_extents.y * std::abs(direction.y) +
         half_extents.z * std::abs(direction.z);
}

}  // namespace

std::vector<HullPlane> hullPlanes(std::span<const Vec3> points, const OrientedBox& box) {
  const Axes axes = axesOf(box.pose.rotation);
  const Vec3d center = widen(box.pose.translation);
  const Vec3d half = widen(box.half_extents);
  const double padding = kPadding + kRelativePadding * greatestCoordinate(points);
  std::vector<HullPlane> planes;
  for (const Vec3d& in_box : directions()) {
    const Vec3 normal = narrow(axes[0] * in_box.x + axes[1] * in_box.y + axes[2] * in_box.z);
    // From here on, use the direction as the floats store it.
    const Vec3d stored = widen(normal);
    const double extent = extentAlong(points, stored);
    const double of_box = dot(center, stored) + extentAlong(half, in_box);
    if (extent > of_box - kLeastCut) continue;
    const double reach = extent + padding;
    auto offset = static_cast<float>(reach);
    if (static_cast<double>(offset) < reach) {
      offset = std::nextafter(offset, std::numeric_limits<float>::infinity());
    }
    planes.push_back({normal, offset});
  }
  return planes;
}

}  // namespace galactic::bake::fit
