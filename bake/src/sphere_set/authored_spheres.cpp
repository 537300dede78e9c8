#include "sphere_set/authored_spheres.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "support/try.h"

namespace galactic::bake {

SnappedSpheres snapRadii(const std::vector<HandSphere>& by_hand, const std::vector<float>& radii) {
  SnappedSpheres snapped;
  snapped.spheres.reserve(by_hand.size());
  for (const HandSphere& sphere : by_hand) {
    const auto change = [&sphere](float radius) {
      return std::abs(static_cast<double>(radius) - sphere.radius);
    };
    const auto nearest = std::min_element(
        radii.begin(), radii.end(), [&change](float a, float b) { return change(a) < change(b); });
    snapped.largest_change = std::max(snapped.largest_change, change(*nearest));
    snapped.spheres.push_back(
        {{static_cast<float>(sphere.center[0]), static_cast<float>(sphere.center[1]),
          static_cast<float>(sphere.center[2])},
         static_cast<std::uint32_t>(nearest - radii.begin())});
  }
  std::sort(snapped.spheres.begin(), snapped.spheres.end(),
            [](const SetSphere& a, const SetSphere& b) {
              return std::tuple(~a.radius_index, a.center.x, a.center.y, a.center.z) <
                     std::tuple(~b.radius_index, b.center.x, b.center.y, b.center.z);
            });
  return snapped;
}

Result<SphereSet> authoredSphereSet(const TriangleMesh& mesh, std::vector<SetSphere> spheres,
                                    const SphereSetOptions& options, unsigned threads) {
  ASSIGN_OR_RETURN(auto quality, measureSphereSet(mesh, spheres, options, threads));
  SphereSet set;
  set.spheres = std::move(spheres);
  set.quality = quality;
  set.guaranteed_gap = quality.gap.max;
  set.guaranteed_protrusion = quality.protrusion.max;
  set.meets_tolerances = set.guaranteed_gap <= static_cast<double>(options.eps) &&
                         set.guaranteed_protrusion <= static_cast<double>(options.tau);
  return set;
}

}  // namespace galactic::bake
