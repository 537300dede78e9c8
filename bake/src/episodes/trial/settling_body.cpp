#include <array>
#include <cmath>

#include "episodes/trial/settling.h"
#include "fit/convex_hull.h"

namespace galactic::bake {
namespace {

/// The center of mass of a smaller hull (cubic meters) cannot be computed in floats.
constexpr double kLeastVolume = 1e-12;

struct Mass {
  Vec3d moment;
  double volume = 0;
};

/// Adds the tetrahedron between a triangle and `apex`.
void addTetrahedron(const Vec3d& apex, const std::array<Vec3d, 3>& triangle, Mass& mass) {
  const Vec3d a = triangle[0] - apex;
  const Vec3d b = triangle[1] - apex;
  const Vec3d c = triangle[2] - apex;
  const double volume = dot(a, cross(b, c)) / 6;
  mass.volume += volume;
  mass.moment = mass.moment + (apex + (a + b + c) * 0.25) * volume;
}

/// Splits each face into a fan; the first corner is the apex of all tetrahedra.
Mass massOf(const fit::ConvexHull& hull) {
  Mass mass;
  const Vec3d apex = hull.corners.front().rounded;
  for (const std::vector<std::uint32_t>& face : hull.faces) {
    for (std::size_t n = 2; n < face.size(); ++n) {
      addTetrahedron(apex,
                     {hull.corners[face[0]].rounded, hull.corners[face[n - 1]].rounded,
                      hull.corners[face[n]].rounded},
                     mass);
    }
  }
  return mass;
}

}  // namespace

SettlingBody boxBody(const ObjectModel& model) {
  return {
      .object_from_body = model.box.pose, .corners = {}, .half_extents = model.box.half_extents};
}

SettlingBody hullBody(std::span<const Vec3> points, const ObjectModel& model) {
  if (points.empty()) return boxBody(model);
  const fit::ConvexHull hull = fit::convexHull(points);
  if (hull.shape != fit::HullShape::kSolid) return boxBody(model);
  const Mass mass = massOf(hull);
  if (!(mass.volume > kLeastVolume)) return boxBody(model);
  const Vec3 center = narrow(mass.moment * (1 / mass.volume));
  SettlingBody body{.object_from_body = {center, {}}, .corners = {}, .half_extents = {}};
  body.corners.reserve(hull.corners.size());
  for (const fit::HullCorner& corner : hull.corners) {
    body.corners.push_back(points[corner.source] - center);
  }
  return body;
}

}  // namespace galactic::bake
