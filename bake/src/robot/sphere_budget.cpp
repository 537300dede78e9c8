#include "sphere_budget.h"

#include <algorithm>
#include <limits>

namespace galactic::bake {
namespace {

/// A protrusion costs room, a gap lets the robot pass through things: it counts twice as much.
constexpr double kProtrusionWeight = 0.5;
/// The tails count beside the mean.
constexpr double kTailWeight = 0.5;

double errorOf(const LengthStatistics& lengths) { return lengths.mean + kTailWeight * lengths.p95; }

/// What a set gets wrong, metres times square metres.
double errorOf(const SphereSet& set) {
  const SphereSetQuality& quality = set.quality;
  return quality.area * (errorOf(quality.gap) + kProtrusionWeight * errorOf(quality.protrusion));
}

std::size_t coarsestCount(const std::vector<SphereSets>& curves) {
  std::size_t count = 0;
  for (const SphereSets& curve : curves) {
    if (!curve.empty()) count += curve.front().spheres.size();
  }
  return count;
}

std::size_t finestCount(const std::vector<SphereSets>& curves) {
  std::size_t count = 0;
  for (const SphereSets& curve : curves) {
    if (!curve.empty()) count += curve.back().spheres.size();
  }
  return count;
}

std::vector<std::size_t> finestSets(const std::vector<SphereSets>& curves) {
  std::vector<std::size_t> chosen;
  chosen.reserve(curves.size());
  for (const SphereSets& curve : curves) {
    chosen.push_back(curve.empty() ? 0 : curve.size() - 1);
  }
  return chosen;
}

/// The least error of the first curves for each number of spheres, and the set of the last of them
/// that gives it. Curves are added one by one.
class BudgetTable {
 public:
  explicit BudgetTable(std::size_t most) : least_(most + 1, 0) {}

  void add(const SphereSets& sets) {
    constexpr double kImpossible = std::numeric_limits<double>::infinity();
    std::vector<double> least(least_.size(), kImpossible);
    std::vector<std::uint32_t> choice(least_.size(), 0);
    for (std::uint32_t set = 0; set < sets.size(); ++set) {
      const std::size_t count = sets[set].spheres.size();
      const double error = errorOf(sets[set]);
      for (std::size_t used = count; used < least.size(); ++used) {
        const double sum = least_[used - count] + error;
        if (sum < least[used]) {
          least[used] = sum;
          choice[used] = set;
        }
      }
    }
    least_ = std::move(least);
    choices_.push_back(std::move(choice));
  }

  /// The sets of all curves that were added, with at most this many spheres.
  [[nodiscard]] std::vector<std::size_t> best(const std::vector<SphereSets>& curves) const {
    std::vector<std::size_t> chosen(curves.size(), 0);
    std::size_t left = least_.size() - 1;
    std::size_t row = choices_.size();
    for (std::size_t n = curves.size(); n-- > 0;) {
      if (curves[n].empty()) continue;
      chosen[n] = choices_[--row][left];
      left -= curves[n][chosen[n]].spheres.size();
    }
    return chosen;
  }

 private:
  std::vector<double> least_;
  std::vector<std::vector<std::uint32_t>> choices_;
};

}  // namespace

std::vector<std::size_t> spendBudget(const std::vector<SphereSets>& curves, std::uint32_t budget) {
  if (budget == 0) return finestSets(curves);
  if (coarsestCount(curves) > budget) return std::vector<std::size_t>(curves.size(), 0);
  BudgetTable table(std::min<std::size_t>(budget, finestCount(curves)));
  for (const SphereSets& curve : curves) {
    if (!curve.empty()) table.add(curve);
  }
  return table.best(curves);
}

std::vector<std::size_t> spendBudgetWithin(const std::vector<SphereSets>& curves,
                                           std::uint32_t budget, double widest_gap) {
  std::vector<SphereSets> narrow(curves.size());
  std::vector<std::vector<std::size_t>> places(curves.size());
  for (std::size_t n = 0; n < curves.size(); ++n) {
    for (std::size_t set = 0; set < curves[n].size(); ++set) {
      const bool is_last = set + 1 == curves[n].size();
      const bool fits = curves[n][set].quality.gap.max <= widest_gap;
      if (!fits && !(is_last && places[n].empty())) continue;
      narrow[n].push_back(curves[n][set]);
      places[n].push_back(set);
    }
  }
  const auto fewest = static_cast<std::uint32_t>(coarsestCount(narrow));
  std::vector<std::size_t> chosen = spendBudget(narrow, std::max(budget, fewest));
  for (std::size_t n = 0; n < curves.size(); ++n) {
    if (!places[n].empty()) chosen[n] = places[n][chosen[n]];
  }
  return chosen;
}

}  // namespace galactic::bake
