#pragma once
#include <memory>
#include <span>

#include "distance/triangle_tree.h"
#include "galactic/bake/triangle_mesh.h"
#include "sphere_set/solid/probe_field.h"

namespace galactic::bake::sphere_set {

/// Signed distance to the reachable surface, and the point of the surface that is nearest.
struct SurfaceDistance {
  /// Negative inside the solid, meters.
  double distance = 0;
  Vec3d nearest;
  /// The facet that `nearest` lies on.
  std::uint32_t facet = kNoFacet;
};

/// What a probe cannot reach from outside, and the surface that it touches: holes smaller than the
/// probe are closed, inner faces and nested shells vanish. Immutable, so safe to share between
/// threads.
class ExteriorSolid {
 public:
  /// See ProbeField for the probe that `smallest_radius` gives. Never changes with `threads`.
  ExteriorSolid(const TriangleMesh& mesh, double smallest_radius, unsigned threads);

  /// The facets that the probe touches; large ones that it touches only in part are cut up.
  [[nodiscard]] std::span<const Facet> facets() const { return surface_.facets(); }
  /// Of the facets.
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  /// Of the facets, square meters.
  [[nodiscard]] double area() const { return area_; }

  /// Up to a quarter of a voxel at the surface.
  [[nodiscard]] bool contains(const Vec3d& p) const { return field_->excess(p) >= 0; }

  /// Whether the probe touches the surface at `p`, up to half a voxel.
  [[nodiscard]] bool reachable(const Vec3d& p) const {
    return field_->excess(p) <= field_->voxel() / 2;
  }

  /// The distance is that to the facets; its sign is never wrongly negative outside a closed
  /// surface, and wrongly positive only within a small part of a voxel of it.
  /// A facet that is likely near, `hint`, makes it faster.
  [[nodiscard]] SurfaceDistance distance(const Vec3d& p, std::uint32_t hint = kNoFacet) const;

 private:
  [[nodiscard]] std::vector<Facet> touchedFacets(const TriangleMesh& mesh) const;

  std::unique_ptr<const ProbeField> field_;
  TriangleTree surface_;
  Box bounds_;
  double area_ = 0;
};

/// Twice the area is the length of this normal.
[[nodiscard]] Vec3d facetNormal(const Facet& facet);

}  // namespace galactic::bake::sphere_set
