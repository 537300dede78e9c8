#include "sphere_budget.h"

#include <optional>

namespace galactic::bake {
namespace {

/// What a set gets wrong, metres: both sides of the surface count, and the tails too.
double errorOf(const SphereSet& set) {
  const SphereSetQuality& quality = set.quality;
  return quality.gap.mean + quality.protrusion.mean +
         0.5 * (quality.gap.p95 + quality.protrusion.p95);
}

/// A step of one curve.
struct Step {
  std::size_t curve = 0;
  std::size_t to = 0;
  double gain = 0;
};

std::optional<Step> bestStep(const std::vector<SphereSets>& curves,
                             const std::vector<std::size_t>& chosen, std::size_t left) {
  std::optional<Step> best;
  for (std::size_t n = 0; n < curves.size(); ++n) {
    const SphereSets sets = curves[n];
    for (std::size_t to = chosen[n] + 1; to < sets.size(); ++to) {
      const std::size_t now = sets[chosen[n]].spheres.size();
      if (sets[to].spheres.size() <= now) continue;
      const std::size_t more = sets[to].spheres.size() - now;
      if (more > left) continue;
      const double gain = sets[to].quality.area * (errorOf(sets[chosen[n]]) - errorOf(sets[to])) /
                          static_cast<double>(more);
      if (gain > 0 && (!best || gain > best->gain)) best = Step{n, to, gain};
    }
  }
  return best;
}

}  // namespace

std::vector<std::size_t> spendBudget(const std::vector<SphereSets>& curves, std::uint32_t budget) {
  std::vector<std::size_t> chosen(curves.size(), 0);
  std::size_t used = 0;
  for (std::size_t n = 0; n < curves.size(); ++n) {
    if (curves[n].empty()) continue;
    if (budget == 0) chosen[n] = curves[n].size() - 1;
    used += curves[n][chosen[n]].spheres.size();
  }
  while (used < budget) {
    const std::optional<Step> step = bestStep(curves, chosen, budget - used);
    if (!step) break;
    const SphereSets sets = curves[step->curve];
    used += sets[step->to].spheres.size() - sets[chosen[step->curve]].spheres.size();
    chosen[step->curve] = step->to;
  }
  return chosen;
}

}  // namespace galactic::bake
