#include "galactic/bake/object_baker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit/hull_planes.h"
#include "fit/stable_poses.h"
#include "import/checks/asset_check.h"
#include "sphere_set/authored_spheres.h"
#include "sphere_set/cover/cover_solver.h"
#include "support/text/counted.h"
#include "support/threads/stopwatch.h"

namespace galactic::bake {
namespace {

/// A movable object smaller than this, in meters, or larger than kLargestObject probably has
/// another unit. The sphere fitter refuses much larger ones with the same question.
constexpr float kDoubtfulSmallness = 0.002F;

float largestExtent(const Bounds& bounds) {
  return std::max(
      {bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y, bounds.max.z - bounds.min.z});
}

void warnOfSize(const Bounds& bounds, std::vector<std::string>& warnings) {
  const float size = largestExtent(bounds);
  if (size < kDoubtfulSmallness) {
    warnings.push_back(
        fmt::format("is only {:.4g} mm large; is the unit right? `scale` sets meters "
                    "per unit",
                    1000 * size));
  }
  if (static_cast<double>(size) > kLargestObject) {
    warnings.push_back(
        fmt::format("is {:.3g} m large; is the unit right? `scale` sets meters per unit", size));
  }
}

void warnOfSpheres(const SphereSet& set, const SphereSetOptions& options,
                   std::vector<std::string>& warnings) {
  if (set.meets_tolerances) return;
  // The surface is sampled, so a gap that exceeds eps by the distance of the samples still counts
  // as covered.
  constexpr double kSlack = 1.2;
  const bool covered = set.guaranteed_gap <= kSlack * static_cast<double>(options.eps);
  if (covered && set.quality.thin_points > 0) {
    warnings.push_back(
        fmt::format("has thin parts: spheres that cover them stick out up to {:.1f} mm, expected "
                    "{:.1f} mm; a smaller radius in `radii` does better",
                    1000 * set.guaranteed_protrusion, 1000 * options.tau));
    return;
  }
  const auto eps = static_cast<double>(options.eps);
  if (options.max_spheres == 0 && sphere_set::isTooLarge(set.quality.area, eps)) {
    warnings.push_back(
        fmt::format("its surface of {:.2g} m2 is so large that it is known at points far apart: "
                    "gaps are {:.1f} mm at most, expected {:.1f} mm; give a wider `eps`, or bake "
                    "its parts as objects",
                    set.quality.area, 1000 * set.guaranteed_gap, 1000 * eps));
    return;
  }
  warnings.push_back(
      fmt::format("with {} there are gaps of up to {:.1f} mm and parts that stick out up to {:.1f} "
                  "mm, expected {:.1f} and {:.1f} mm; allow more with `max-spheres` or wider "
                  "tolerances",
                  counted(set.spheres.size(), "sphere"), 1000 * set.guaranteed_gap,
                  1000 * set.guaranteed_protrusion, 1000 * options.eps, 1000 * options.tau));
}

/// If a published box differs from the mesh's by more than this, it is probably in another frame or
/// belongs to another object. Meters.
constexpr float kDoubtfulBoxDifference = 0.005F;

float farthestApart(const Vec3& a, const Vec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

/// Takes the given box, which need not contain every vertex.
void takeBox(const AuthoredShape& shape, BakedObject& object) {
  const Bounds& given = shape.box;
  BoxFitResult& fit = object.box;
  const Vec3 half = (given.max - given.min) * 0.5F;
  fit.used = BoxFit::kAxisAligned;
  fit.box.pose = {given.min + half, {}};
  fit.box.half_extents = {std::max(half.x, kMinHalfExtent), std::max(half.y, kMinHalfExtent),
                          std::max(half.z, kMinHalfExtent)};
  const Vec3& extents = fit.box.half_extents;
  fit.volume = 8 * static_cast<double>(extents.x) * static_cast<double>(extents.y) *
               static_cast<double>(extents.z);
  const float difference = std::max(farthestApart(given.min, object.bounds.min),
                                    farthestApart(given.max, object.bounds.max));
  if (difference > kDoubtfulBoxDifference) {
    object.warnings.push_back(
        fmt::format("the box given for it is up to {:.0f} mm off the mesh's; is it of this mesh, "
                    "and are `up` and `scale` right?",
                    1000 * difference));
  }
}

}  // namespace

Result<BakedObject> bakeObject(const SourceAsset& asset, const ObjectBakeOptions& options,
                               unsigned threads) {
  Result<CleanMesh> cleaned = placeAndClean(asset);
  if (!cleaned) return tl::unexpected(cleaned.error());
  const TriangleMesh& mesh = cleaned->mesh;

  BakedObject object;
  object.name = asset.name;
  object.imported = importStatisticsOf(asset, *cleaned);
  object.bounds = mesh.bounds;
  object.warnings = asset.warnings;
  warnOfSize(mesh.bounds, object.warnings);
  {
    const detail::Stopwatch timer(object.times.box);
    object.box = fitOrientedBox(mesh.vertices, options.box);
    if (options.authored) takeBox(*options.authored, object);
    object.hull_planes = fit::hullPlanes(mesh.vertices, object.box.box);
  }
  {
    const detail::Stopwatch timer(object.times.stable_poses);
    object.stable_poses = findStablePoses(mesh);
  }
  SphereSetOptions sphere_options = options.spheres;
  if (options.keep_above_support) {
    sphere_options.support = HalfSpace{{0, 1, 0}, mesh.bounds.min.y};
  }
  object.authored_spheres = options.authored && !options.authored->spheres.empty();
  {
    const detail::Stopwatch timer(object.times.spheres);
    Result<SphereSet> spheres =
        object.authored_spheres
            ? authoredSphereSet(mesh, options.authored->spheres, sphere_options, threads)
            : fitSphereSet(mesh, sphere_options, threads);
    if (!spheres) return tl::unexpected(spheres.error());
    object.spheres = std::move(*spheres);
  }
  object.eps = options.spheres.eps;
  object.tau = options.spheres.tau;
  if (!object.authored_spheres) warnOfSpheres(object.spheres, options.spheres, object.warnings);
  object.surface.positions = std::move(cleaned->mesh.vertices);
  object.surface.triangles = std::move(cleaned->mesh.triangles);
  return object;
}

}  // namespace galactic::bake
