#include "sphere_set/prepared_fit.h"

#include <algorithm>

#include "support/try.h"

namespace galactic::bake::sphere_set {
namespace {

constexpr const char* kSupport = "support";

bool comesFirst(const SetSphere& a, const SetSphere& b) {
  if (a.radius_index != b.radius_index) return a.radius_index > b.radius_index;
  if (a.center.x != b.center.x) return a.center.x < b.center.x;
  if (a.center.y != b.center.y) return a.center.y < b.center.y;
  return a.center.z < b.center.z;
}

}  // namespace

Result<PreparedFit> prepareFit(const TriangleMesh& mesh, const SphereSetOptions& options,
                               unsigned threads) {
  RETURN_IF_ERROR(checkOptions(options));
  RETURN_IF_ERROR(checkMesh(mesh));
  PreparedFit prepared;
  prepared.solid = std::make_unique<const ExteriorSolid>(
      mesh, static_cast<double>(options.radii.front()), threads);
  if (!(prepared.solid->area() > 0)) {
    return fail(ErrorCode::kInvalidInput, "mesh",
                "none of its surface can be reached from outside; give a surface with an area");
  }
  FitTask& task = prepared.task;
  task.solid = prepared.solid.get();
  for (const float radius : options.radii) task.radii.push_back(static_cast<double>(radius));
  task.eps = static_cast<double>(options.eps);
  task.tau = static_cast<double>(options.tau);
  task.support = options.support;
  task.threads = threads;
  return prepared;
}

tl::unexpected<Error> nothingToCover() {
  return fail(ErrorCode::kInvalidInput, kSupport,
              "all of the reachable surface is beyond the plane, so there is nothing to cover; "
              "check its normal and offset");
}

bool isNothingToCover(const Error& error) { return error.where == kSupport; }

SphereSet finishedSet(const FitTask& task, const Yardstick& yardstick, const Cover& cover) {
  SphereSet set;
  for (const Candidate& sphere : cover.spheres) {
    set.spheres.push_back({narrow(sphere.center), sphere.radius_index});
  }
  std::sort(set.spheres.begin(), set.spheres.end(), comesFirst);
  set.quality = yardstick.measureLengths(cover.spheres);
  // Where no facet bounds the solid (at a small hole, or at the bottom of a crevice), a sphere may
  // be farther from the facets than from the solid, so the measured values count.
  set.guaranteed_gap = std::max(cover.guaranteed_gap, set.quality.gap.max);
  set.guaranteed_protrusion = std::max(cover.guaranteed_protrusion, set.quality.protrusion.max);
  const double slack = std::min(cover.slack, kSlackOfEps * task.eps);
  set.meets_tolerances =
      set.guaranteed_gap <= task.eps + slack && set.guaranteed_protrusion <= task.tau;
  return set;
}

}  // namespace galactic::bake::sphere_set
