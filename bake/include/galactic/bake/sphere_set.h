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

/// What the spheres must do. Lengths in meters.
struct SphereSetOptions {
  /// The working set, ascending, 1 to 8 radii of 0.0001 to 10 m.
  std::vector<float> radii{0.015F, 0.05F, 0.12F};
  /// Every reachable surface point lies within this of the union of the spheres; 0.0001 to 10.
  float eps = 0.015F;
  /// No sphere sticks out of the surface further than this, but for thin parts: they get the least
  /// protrusion that covers them. 0 to 10.
  float tau = 0.020F;
  /// No sphere reaches beyond this plane (up to a micrometer): the face on which the object rests,
  /// or the ground. Surface points beyond it need no cover.
  std::optional<HalfSpace> support;
  /// Most spheres allowed; 0: as many as the tolerances need. With a limit the gap may exceed eps.
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
  /// Distance of reachable surface points to the union, 0 inside it.
  LengthStatistics gap;
  /// Distance of the union's surface points to the solid, 0 inside it.
  LengthStatistics protrusion;
  /// Volume of the union by that of the solid, by counting voxels; 0 where the solid has none.
  double volume_ratio = 0;
  /// Samples that no sphere within tau could cover.
  std::uint64_t thin_points = 0;
  /// Number of reachable samples measured.
  std::uint64_t samples = 0;
  /// Area of the reachable surface, square meters.
  double area = 0;
};

/// Spheres of the working set, radius descending, then x, y, z ascending; and their quality.
struct SphereSet {
  std::vector<SetSphere> spheres;
  SphereSetQuality quality;
  /// What the solver promises: no reachable surface point is further than this from the union. At
  /// most 1.18 times eps where neither max_spheres nor the object's size stands in the way: the
  /// surface is known at samples only, and more than 15,000 of them are never covered.
  double guaranteed_gap = 0;
  /// What the solver promises: no sphere sticks out further than this (more than tau: thin parts).
  double guaranteed_protrusion = 0;
  /// False where the tolerances could not be met within max_spheres, or at all, such as on large
  /// objects: the guaranteed figures then say by how much. A gap of up to 1.18 eps meets them. Thin
  /// parts alone make it false when their protrusion is above tau.
  bool meets_tolerances = true;
};

/// The fewest spheres of the working set found that cover `mesh` under two tolerances. The solid is
/// what a ball of half the smallest radius cannot reach from outside: holes, inner faces, nested
/// shells and the winding of triangles do not matter. For objects of meters the ball is larger, so
/// that memory stays bounded. Bounded by operation counts, so the bytes depend on the input only.
///
/// Set cover over spheres on lattices through the solid: lazy greedy, then the row weighting local
/// search of Gao, Weise and Li (EJOR 2015), then refinement on finer lattices and denser samples.
/// Where the tolerances need more than `max_spheres`, the set of a SphereCurve with that many.
/// Fails with kInvalidInput on options out of range or a mesh without a reachable surface, and with
/// kUnsupported where the extents are beyond 10 m. The result does not depend on `threads`.
[[nodiscard]] Result<SphereSet> fitSphereSet(const TriangleMesh& mesh,
                                             const SphereSetOptions& options, unsigned threads = 1);

/// One set of a trade-off curve, before it is made ready.
struct CurvePoint {
  std::uint32_t spheres = 0;
  /// What the set gets wrong: the square of gaps (and more beyond twice eps) integrated over the
  /// surface, and the square of protrusions integrated over the spheres; m^4. Errors of several
  /// meshes with the same eps may be compared and added.
  double error = 0;
  /// Meters: no gap is wider before the set is settled.
  double widest_gap = 0;
  /// How much of that is the distance between the points at which gaps were looked for, meters.
  double unseen_gap = 0;
};

/// The trade-off of a mesh: sphere sets of 1, 2, 3... spheres, each with a small error, so that a
/// budget of spheres can be spent over several meshes. They are made one after the other, each from
/// the one before it: a sphere is added, spheres are exchanged and moved while that helps. A set of
/// a few spheres cannot keep to a small tau: up to 1.6 of it is allowed. Movable, not copyable.
class SphereCurve {
 public:
  /// The curve of `mesh`, without sets yet. Fails as fitSphereSet does.
  [[nodiscard]] static Result<SphereCurve> begin(const TriangleMesh& mesh,
                                                 const SphereSetOptions& options,
                                                 unsigned threads = 1);
  ~SphereCurve();
  SphereCurve(SphereCurve&&) noexcept;
  SphereCurve& operator=(SphereCurve&&) noexcept;

  /// Adds the set with one more sphere, on up to `threads` threads, which never change it. Does
  /// nothing when the curve is complete. Where parts are so thin that nothing stays within tau, the
  /// curve is finished at once. Fails as fitSphereSet does.
  [[nodiscard]] Result<void> refine(unsigned threads);
  /// Replaces all sets by one that meets the tolerances, as fitSphereSet makes it, with less work.
  [[nodiscard]] Result<void> finish(unsigned threads);
  /// Whether the last set leaves no gap wider than eps, has the most spheres allowed, or cannot be
  /// bettered by one more.
  [[nodiscard]] bool complete() const;

  /// By rising count, which is that of the sets.
  [[nodiscard]] const std::vector<CurvePoint>& points() const;
  /// The set of one of the points, settled on denser samples and measured; it is judged by the
  /// tolerances of the options.
  [[nodiscard]] SphereSet take(std::size_t point) const;

 private:
  class Fitter;
  explicit SphereCurve(std::unique_ptr<Fitter> fitter);

  std::unique_ptr<Fitter> fitter_;
};

/// Measures any sphere set, hand-made ones too, with the yardstick of `fitSphereSet`. Fails as that
/// does, and with kInvalidInput where there are no spheres, a center is not finite or a radius is
/// not in the working set.
[[nodiscard]] Result<SphereSetQuality> measureSphereSet(const TriangleMesh& mesh,
                                                        const std::vector<SetSphere>& spheres,
                                                        const SphereSetOptions& options,
                                                        unsigned threads = 1);

}  // namespace galactic::bake
