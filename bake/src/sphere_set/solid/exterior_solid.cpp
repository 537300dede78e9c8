#include "sphere_set/solid/exterior_solid.h"

#include <utility>

namespace galactic::bake::sphere_set {
namespace {

/// Maximum number of rows of points tried on a facet.
constexpr double kMostRows = 40;
/// Cutting stops at this many facets; the rest remain whole.
constexpr std::size_t kMostFacets = 2'000'000;

enum class Touch { kNowhere, kPartly, kEverywhere };

std::vector<Facet> facetsOf(const TriangleMesh& mesh) {
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) facets.push_back(cornersOf(mesh, t));
  return facets;
}

Box boundsOf(std::span<const Facet> facets) {
  Box box;
  for (const Facet& facet : facets) {
    for (const Vec3& corner : facet) box.grow(widen(corner));
  }
  return box;
}

/// The corner at which the longest edge of a facet starts, and the length of that edge.
std::pair<std::size_t, double> longestEdge(const Facet& facet) {
  std::size_t start = 0;
  double longest = 0;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const double edge = norm(widen(facet[(corner + 1) % 3]) - widen(facet[corner]));
    if (edge > longest) {
      longest = edge;
      start = corner;
    }
  }
  return {start, longest};
}

/// Tries points of the facet that are at most two voxels apart, unless the facet is huge.
Touch touchOf(const ProbeField& field, const Facet& facet, double longest) {
  const Vec3d a = widen(facet[0]);
  const Vec3d ab = widen(facet[1]) - a;
  const Vec3d ac = widen(facet[2]) - a;
  const auto rows =
      static_cast<int>(std::clamp(std::ceil(longest / (2 * field.voxel())), 1.0, kMostRows));
  bool some = false;
  bool all = true;
  const auto attempt = [&](double u, double v) {
    const bool touched = field.excess(a + ab * u + ac * v) <= field.voxel() / 2;
    some = some || touched;
    all = all && touched;
  };
  attempt(1.0 / 3, 1.0 / 3);
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; i + j <= rows; ++j) {
      attempt(static_cast<double>(i) / rows, static_cast<double>(j) / rows);
    }
  }
  return all ? Touch::kEverywhere : some ? Touch::kPartly : Touch::kNowhere;
}

}  // namespace

Vec3d facetNormal(const Facet& facet) {
  const Vec3d a = widen(facet[0]);
  return cross(widen(facet[1]) - a, widen(facet[2]) - a);
}

ExteriorSolid::ExteriorSolid(const TriangleMesh& mesh, double smallest_radius, unsigned threads)
    : surface_({}) {
  const TriangleTree all(facetsOf(mesh));
  field_ =
      std::make_unique<const ProbeField>(all, boundsOf(all.facets()), smallest_radius, threads);
  surface_ = TriangleTree(touchedFacets(mesh));
  bounds_ = boundsOf(surface_.facets());
  for (const Facet& facet : surface_.facets()) area_ += norm(facetNormal(facet)) / 2;
}

std::vector<Facet> ExteriorSolid::touchedFacets(const TriangleMesh& mesh) const {
  std::vector<Facet> touched;
  std::vector<Facet> open;
  for (const Facet& whole : facetsOf(mesh)) {
    open.assign(1, whole);
    while (!open.empty()) {
      const Facet facet = open.back();
      open.pop_back();
      const auto [start, longest] = longestEdge(facet);
      const Touch touch = touchOf(*field_, facet, longest);
      if (touch == Touch::kNowhere) continue;
      const bool cut = touch == Touch::kPartly && longest > 2 * field_->voxel() &&
                       touched.size() + open.size() < kMostFacets;
      if (!cut) {
        touched.push_back(facet);
        continue;
      }
      const std::size_t next = (start + 1) % 3;
      const Vec3 middle = narrow((widen(facet[start]) + widen(facet[next])) * 0.5);
      Facet first = facet;
      first[next] = middle;
      Facet second = facet;
      second[start] = middle;
      open.push_back(second);
      open.push_back(first);
    }
  }
  return touched;
}

SurfaceDistance ExteriorSolid::distance(const Vec3d& p, std::uint32_t hint) const {
  SearchLimits limits;
  limits.hint = hint;
  const NearestPoint found = surface_.nearest(p, limits);
  const double distance = std::sqrt(found.squared);
  const SurfaceDistance outside{distance, found.point, found.facet};
  // The empty balls are only known at voxels, so they do not cover points just outside a face, up
  // to about this distance. Such points count as outside, wherever they are, so that no sphere
  // protrudes more than reported.
  const double voxel = field_->voxel();
  if (distance < voxel * voxel / (4 * field_->probe())) return outside;
  // A point inside the solid is at least as far from every empty ball as from the surface.
  const bool inside = field_->excess(p) >= std::min(distance, voxel / 4) * (1 - 1e-6);
  return inside ? SurfaceDistance{-distance, found.point, found.facet} : outside;
}

}  // namespace galactic::bake::sphere_set
