#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "robot/group_spheres.h"

namespace galactic::bake {
namespace {

/// The share of the least error that narrower gaps may cost.
constexpr double kEvenness = 0.1;

std::size_t coarsestCount(const std::vector<CurvePoints>& curves) {
  std::size_t count = 0;
  for (const CurvePoints& curve : curves) {
    if (!curve.empty()) count += curve.front().spheres;
  }
  return count;
}

std::size_t finestCount(const std::vector<CurvePoints>& curves) {
  std::size_t count = 0;
  for (const CurvePoints& curve : curves) {
    if (!curve.empty()) count += curve.back().spheres;
  }
  return count;
}

std::vector<std::size_t> finestSets(const std::vector<CurvePoints>& curves) {
  std::vector<std::size_t> chosen;
  chosen.reserve(curves.size());
  for (const CurvePoints& curve : curves) {
    chosen.push_back(curve.empty() ? 0 : curve.size() - 1);
  }
  return chosen;
}

/// The total of the chosen sets: the sums of spheres and errors, and the widest gap of any.
CurvePoint chosenOf(const std::vector<CurvePoints>& curves,
                    const std::vector<std::size_t>& chosen) {
  CurvePoint all;
  for (std::size_t n = 0; n < curves.size(); ++n) {
    if (curves[n].empty()) continue;
    const CurvePoint& set = curves[n][chosen[n]];
    all.spheres += set.spheres;
    all.error += set.error;
    all.widest_gap = std::max(all.widest_gap, set.widest_gap);
  }
  return all;
}

/// For each number of spheres, the least error of the curves added so far, and the set of the last
/// curve that gives it.
class BudgetTable {
 public:
  explicit BudgetTable(std::size_t most) : least_(most + 1, 0) {}

  void add(const CurvePoints& sets) {
    constexpr double kImpossible = std::numeric_limits<double>::infinity();
    std::vector<double> least(least_.size(), kImpossible);
    std::vector<std::uint32_t> choice(least_.size(), 0);
    for (std::uint32_t set = 0; set < sets.size(); ++set) {
      const std::size_t count = sets[set].spheres;
      const double error = sets[set].error;
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

  /// The best choice of sets, one for each curve, with at most as many spheres as the table has
  /// room for.
  [[nodiscard]] std::vector<std::size_t> best(const std::vector<CurvePoints>& curves) const {
    std::vector<std::size_t> chosen(curves.size(), 0);
    std::size_t left = least_.size() - 1;
    std::size_t row = choices_.size();
    for (std::size_t n = curves.size(); n-- > 0;) {
      if (curves[n].empty()) continue;
      chosen[n] = choices_[--row][left];
      left -= curves[n][chosen[n]].spheres;
    }
    return chosen;
  }

 private:
  std::vector<double> least_;
  std::vector<std::vector<std::uint32_t>> choices_;
};

}  // namespace

std::vector<std::size_t> spendBudget(const std::vector<CurvePoints>& curves, std::uint32_t budget) {
  if (budget == 0) return finestSets(curves);
  if (coarsestCount(curves) > budget) return std::vector<std::size_t>(curves.size(), 0);
  BudgetTable table(std::min<std::size_t>(budget, finestCount(curves)));
  for (const CurvePoints& curve : curves) {
    if (!curve.empty()) table.add(curve);
  }
  return table.best(curves);
}

std::vector<std::size_t> spendBudgetWithin(const std::vector<CurvePoints>& curves,
                                           std::uint32_t budget, double widest_gap) {
  std::vector<CurvePoints> narrow(curves.size());
  std::vector<std::vector<std::size_t>> places(curves.size());
  for (std::size_t n = 0; n < curves.size(); ++n) {
    for (std::size_t set = 0; set < curves[n].size(); ++set) {
      const bool is_last = set + 1 == curves[n].size();
      const bool fits = curves[n][set].widest_gap <= widest_gap;
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

std::vector<std::size_t> spendBudgetEvenly(const std::vector<CurvePoints>& curves,
                                           std::uint32_t budget) {
  std::vector<std::size_t> chosen = spendBudget(curves, budget);
  if (budget == 0) return chosen;
  const double most = (1 + kEvenness) * chosenOf(curves, chosen).error;
  while (true) {
    const double widest = chosenOf(curves, chosen).widest_gap;
    auto narrower = spendBudgetWithin(curves, budget, std::nextafter(widest, 0.0));
    const CurvePoint now = chosenOf(curves, narrower);
    if (now.spheres > budget || now.widest_gap >= widest || now.error > most) return chosen;
    chosen = std::move(narrower);
  }
}

}  // namespace galactic::bake
