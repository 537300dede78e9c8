#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/shapes.h"

namespace galactic::bake {

/// The half space normal . p >= offset in which spheres must stay.
struct HalfSpace {
  /// Unit vector.
  Vec3 normal{0, 1, 0};
  /// Meters.
  float offset = 0;

  friend bool operator==(const HalfSpace&, const HalfSpace&) = default;
};

/// Requirements on the spheres. Lengths in meters.
struct SphereSetOptions {
  /// The working set, ascending, 1 to 8 radii of 0.0001 to 10 m.
  std::vector<float> radii{0.015F, 0.05F, 0.12F};
  /// Every reachable surface point lies within this of the union of the spheres; 0.0001 to 10.
  float eps = 0.015F;
  /// No sphere sticks out of the surface further than this, except at thin parts, which get the
  /// least protrusion that covers them. 0 to 10.
  float tau = 0.020F;
  /// No sphere reaches beyond this plane (to within a micrometer): the face on which the object
  /// rests, or the ground. Surface points beyond it need not be covered.
  std::optional<HalfSpace> support;
  /// Most spheres allowed; 0: as many as the tolerances need. With a limit, the gap may exceed eps.
  std::uint32_t max_spheres = 0;

  friend bool operator==(const SphereSetOptions&, const SphereSetOptions&) = default;
};

/// Mean, 95th percentile and maximum of a length over samples, meters.
struct LengthStatistics {
  double mean = 0;
  double p95 = 0;
  double max = 0;
};

/// How good a sphere set is, measured on dense samples that its solver has not seen.
struct SphereSetQuality {
  /// Distance of reachable surface points to the union of the spheres, 0 inside it.
  LengthStatistics gap;
  /// Distance of the union's surface points to the solid, 0 inside it.
  LengthStatistics protrusion;
  /// Volume of the union divided by that of the solid, by counting voxels; 0 if the solid has no
  /// volume.
  double volume_ratio = 0;
  /// Samples that no sphere within tau could cover.
  std::uint64_t thin_points = 0;
  /// Number of reachable samples that were measured.
  std::uint64_t samples = 0;
  /// Area of the reachable surface, square meters.
  double area = 0;
};

/// Spheres of the working set, by descending radius, then ascending x, y, z; and their quality.
struct SphereSet {
  std::vector<SetSphere> spheres;
  SphereSetQuality quality;
  /// Guaranteed by the solver: no reachable surface point is further than this from the union. At
  /// most 1.18 times eps, unless max_spheres or the object's size prevents it: the surface is known
  /// only at samples, and the solver never uses more than 15,000 of them.
  double guaranteed_gap = 0;
  /// Guaranteed by the solver: no sphere sticks out further than this (more than tau at thin
  /// parts).
  double guaranteed_protrusion = 0;
  /// False if the tolerances could not be met within max_spheres or, as for large objects, at all:
  /// the guaranteed figures then tell by how much. A gap of up to 1.18 eps meets them. Thin parts
  /// alone make this false if their protrusion is above tau.
  bool meets_tolerances = true;
};

/// The smallest set of spheres found that covers `mesh` within two tolerances. The solid is
/// everything that a ball of half the smallest radius cannot reach from outside: holes, inner
/// faces, nested shells and the winding of triangles do not matter. For objects that are meters in
/// size the ball is larger, so that memory stays bounded. The search is limited by operation
/// counts, so the result depends only on the input.
///
/// Method: set cover over spheres on lattices through the solid, with a lazy greedy start, then the
/// row-weighting local search of Gao, Weise and Li (EJOR 2015), then refinement on finer lattices
/// and denser samples. If the tolerances need more than `max_spheres`, the result is the set of a
/// SphereCurve with that many spheres. Fails with kInvalidInput if an option is out of range or the
/// mesh has no reachable surface, and with kUnsupported if the extents are beyond 10 m. The result
/// does not depend on `threads`.
[[nodiscard]] Result<SphereSet> fitSphereSet(const TriangleMesh& mesh,
                                             const SphereSetOptions& options, unsigned threads = 1);

/// One set of a trade-off curve, before it is settled.
struct CurvePoint {
  std::uint32_t spheres = 0;
  /// Error of the set: the square of gaps (and more beyond twice eps) integrated over the surface,
  /// plus the square of protrusions integrated over the spheres; m^4. Errors of several meshes with
  /// the same eps may be compared and added.
  double error = 0;
  /// No gap is wider than this before the set is settled, meters.
  double widest_gap = 0;
  /// How much of `widest_gap` is due to the distance between the points at which gaps were
  /// measured, meters.
  double unseen_gap = 0;
};

/// The trade-off curve of a mesh: sets of 1, 2, 3... spheres, each with a small error, so that a
/// budget of spheres can be distributed over several meshes. The sets are made one after the other,
/// each from the previous one: a sphere is added, then spheres are exchanged and moved as long as
/// that helps. A set of few spheres cannot keep within a small tau: up to 1.6 times tau is allowed.
/// Movable, not copyable.
class SphereCurve {
 public:
  /// The curve of `mesh`, without sets yet. Fails as fitSphereSet() does.
  [[nodiscard]] static Result<SphereCurve> begin(const TriangleMesh& mesh,
                                                 const SphereSetOptions& options,
                                                 unsigned threads = 1);
  ~SphereCurve();
  SphereCurve(SphereCurve&&) noexcept;
  SphereCurve& operator=(SphereCurve&&) noexcept;

  /// Adds the set with one more sphere, on up to `threads` threads, on which the result does not
  /// depend. Does nothing if the curve is complete. If parts are so thin that no sphere stays
  /// within tau, the curve is finished at once. Fails as fitSphereSet() does.
  [[nodiscard]] Result<void> refine(unsigned threads);
  /// Replaces all sets by one that meets the tolerances, made as by fitSphereSet() but with less
  /// work.
  [[nodiscard]] Result<void> finish(unsigned threads);
  /// Whether the last set leaves no gap wider than eps, has the most spheres allowed, or cannot be
  /// improved by one more sphere.
  [[nodiscard]] bool complete() const;

  /// The sets, by ascending number of spheres.
  [[nodiscard]] const std::vector<CurvePoint>& points() const;
  /// The set of one of the points, settled on denser samples and measured, with the tolerances of
  /// the options.
  [[nodiscard]] SphereSet take(std::size_t point) const;

 private:
  class Fitter;
  explicit SphereCurve(std::unique_ptr<Fitter> fitter);

  std::unique_ptr<Fitter> fitter_;
};

/// Measures any sphere set, including hand-made ones, in the same way as fitSphereSet(). Fails as
/// fitSphereSet() does, and with kInvalidInput if there are no spheres, a center is not finite or a
/// radius is not in the working set.
[[nodiscard]] Result<SphereSetQuality> measureSphereSet(const TriangleMesh& mesh,
                                                        const std::vector<SetSphere>& spheres,
                                                        const SphereSetOptions& options,
                                                        unsigned threads = 1);

}  // namespace galactic::bake
