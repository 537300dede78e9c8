#include <fmt/format.h>

#include <cmath>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/prepared_fit.h"
#include "support/try.h"

namespace galactic::bake {

using sphere_set::Candidate;
using sphere_set::Cover;
using sphere_set::PreparedFit;
using sphere_set::Yardstick;

namespace {

/// The set of the complete curve with the most spheres allowed.
Result<SphereSet> fitWithin(const TriangleMesh& mesh, const SphereSetOptions& options,
                            unsigned threads) {
  auto curve = SphereCurve::begin(mesh, options, threads);
  if (!curve) return tl::unexpected(curve.error());
  while (!curve->complete()) {
    RETURN_IF_ERROR(curve->refine(threads));
  }
  return curve->take(curve->points().size() - 1);
}

}  // namespace

Result<SphereSet> fitSphereSet(const TriangleMesh& mesh, const SphereSetOptions& options,
                               unsigned threads) {
  ASSIGN_OR_RETURN(const auto prepared, sphere_set::prepareFit(mesh, options, threads));
  sphere_set::SurfacePoints surface;
  const Cover cover = sphere_set::solveCover(prepared.task, {}, surface);
  if (cover.spheres.empty()) return sphere_set::nothingToCover();
  if (options.max_spheres > 0 && cover.spheres.size() > options.max_spheres) {
    return fitWithin(mesh, options, threads);
  }
  const Yardstick yardstick(prepared.task);
  SphereSet set = finishedSet(prepared.task, yardstick, cover);
  yardstick.complete(cover.spheres, set.quality);
  return set;
}

Result<SphereSetQuality> measureSphereSet(const TriangleMesh& mesh,
                                          const std::vector<SetSphere>& spheres,
                                          const SphereSetOptions& options, unsigned threads) {
  ASSIGN_OR_RETURN(const auto prepared, sphere_set::prepareFit(mesh, options, threads));
  if (spheres.empty()) {
    return fail(ErrorCode::kInvalidInput, "spheres", "is empty; give at least one sphere");
  }
  std::vector<Candidate> placed;
  for (std::size_t at = 0; at < spheres.size(); ++at) {
    const SetSphere& sphere = spheres[at];
    if (sphere.radius_index >= options.radii.size()) {
      return fail(ErrorCode::kInvalidInput, fmt::format("spheres[{}].radius_index", at),
                  fmt::format("{} is not in the working set of {} radii; give its index",
                              sphere.radius_index, options.radii.size()));
    }
    const Vec3d center = widen(sphere.center);
    if (!std::isfinite(center.x + center.y + center.z)) {
      return fail(ErrorCode::kInvalidInput, fmt::format("spheres[{}].center", at),
                  "it is not finite; give meters in the object's frame");
    }
    placed.push_back({center, sphere.radius_index, 0});
  }
  const Yardstick yardstick(prepared.task);
  SphereSetQuality quality = yardstick.measureLengths(placed);
  yardstick.complete(placed, quality);
  return quality;
}

}  // namespace galactic::bake
