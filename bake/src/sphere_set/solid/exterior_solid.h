#pragma once
#include <memory>
#include <span>

#include "distance/triangle_tree.h"
#include "galactic/bake/triangle_mesh.h"
#include "sphere_set/solid/probe_field.h"

namespace galactic::bake::sphere_set {

/// Signed distance to the reachable surface, and the nearest point on it.
struct SurfaceDistance {
  /// Negative inside the solid, meters.
  double distance = 0;
  Vec3d nearest;
  /// The facet that `nearest` lies on.
  std::uint32_t facet = kNoFacet;
};

/// The solid that a probe cannot enter from outside, and the surface that the probe touches. Holes
/// smaller than the probe are closed; inner faces and nested shells vanish. Immutable, so threads
/// may share it.
class ExteriorSolid {
 public:
  /// ProbeField describes the probe for `smallest_radius`. The result does not depend on `threads`.
  ExteriorSolid(const TriangleMesh& mesh, double smallest_radius, unsigned threads);

  /// The facets that the probe touches. Large facets that it touches only in part are cut up.
  [[nodiscard]] std::span<const Facet> facets() const { return surface_.facets(); }
  /// Bounds of the facets.
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  /// Area of the facets, square meters.
  [[nodiscard]] double area() const { return area_; }

  /// Whether `p` is inside; accurate to a quarter of a voxel at the surface.
  [[nodiscard]] bool contains(const Vec3d& p) const { return field_->excess(p) >= 0; }

  /// Whether the probe touches the surface at `p`, to within half a voxel.
  [[nodiscard]] bool reachable(const Vec3d& p) const {
    return field_->excess(p) <= field_->voxel() / 2;
  }

  /// The distance to the facets. Its sign is never wrongly negative outside a closed surface, and
  /// wrongly positive only within a small fraction of a voxel of it. A `hint`, a facet that is
  /// likely to be near, speeds up the search.
  [[nodiscard]] SurfaceDistance distance(const Vec3d& p, std::uint32_t hint = kNoFacet) const;

 private:
  [[nodiscard]] std::vector<Facet> touchedFacets(const TriangleMesh& mesh) const;

  std::unique_ptr<const ProbeField> field_;
  TriangleTree surface_;
  Box bounds_;
  double area_ = 0;
};

/// The normal of a facet; its length is twice the area.
[[nodiscard]] Vec3d facetNormal(const Facet& facet);

}  // namespace galactic::bake::sphere_set
