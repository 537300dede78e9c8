// How a budget of spheres is spent over links, against all possible ways.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "robot/group_spheres.h"

namespace galactic::test::sphere_budget_test {
namespace {

using bake::CurvePoint;
using bake::CurvePoints;
using bake::spendBudget;
using testing::ElementsAre;

/// A set of so many spheres with this error.
CurvePoint setOf(std::uint32_t spheres, double error) { return {spheres, error, 0}; }

/// What is minimised: the errors of all links.
double errorOf(const std::vector<CurvePoints>& curves, const std::vector<std::size_t>& chosen) {
  double sum = 0;
  for (std::size_t n = 0; n < curves.size(); ++n) {
    if (!curves[n].empty()) sum += curves[n][chosen[n]].error;
  }
  return sum;
}

std::size_t spheresOf(const std::vector<CurvePoints>& curves,
                      const std::vector<std::size_t>& chosen) {
  std::size_t sum = 0;
  for (std::size_t n = 0; n < curves.size(); ++n) {
    if (!curves[n].empty()) sum += curves[n][chosen[n]].spheres;
  }
  return sum;
}

/// The least error of all ways to stay within the budget.
double leastError(const std::vector<CurvePoints>& curves, std::size_t budget) {
  std::vector<std::size_t> chosen(curves.size(), 0);
  double least = errorOf(curves, chosen);
  while (true) {
    if (spheresOf(curves, chosen) <= budget) least = std::min(least, errorOf(curves, chosen));
    std::size_t n = 0;
    for (; n < curves.size(); ++n) {
      if (chosen[n] + 1 < curves[n].size()) {
        ++chosen[n];
        break;
      }
      chosen[n] = 0;
    }
    if (n == curves.size()) return least;
  }
}

/// Curves with falling gains per sphere; each step adds 1 to `widest` spheres.
std::vector<CurvePoints> randomCurves(std::mt19937& random, std::uint32_t widest) {
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32; };
  std::vector<CurvePoints> curves(2 + random() % 3);
  for (CurvePoints& curve : curves) {
    const std::size_t steps = 2 + random() % 5;
    std::vector<double> gains;
    for (std::size_t n = 0; n < steps; ++n) gains.push_back(uniform());
    std::sort(gains.rbegin(), gains.rend());
    auto spheres = static_cast<std::uint32_t>(1 + random() % 3);
    double error = 10;
    curve.push_back(setOf(spheres, error));
    for (const double gain : gains) {
      const auto more = static_cast<std::uint32_t>(1 + random() % widest);
      spheres += more;
      error -= gain * static_cast<double>(more) / widest;
      curve.push_back(setOf(spheres, error));
    }
  }
  return curves;
}

TEST(SphereBudget, IsSpentAsWellAsAnyWayAllows) {
  constexpr std::uint32_t kSeed = 11;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  int bound = 0;
  constexpr int kRounds = 400;
  for (int round = 0; round < kRounds; ++round) {
    const auto curves = randomCurves(random, round % 2 == 0 ? 1 : 6);
    const auto budget = static_cast<std::uint32_t>(4 + random() % 60);
    const auto chosen = spendBudget(curves, budget);
    const std::vector<std::size_t> coarsest(curves.size(), 0);
    if (spheresOf(curves, coarsest) > budget) {
      EXPECT_EQ(chosen, coarsest);
      continue;
    }
    EXPECT_LE(spheresOf(curves, chosen), budget);
    constexpr double kRounding = 1e-12;
    EXPECT_NEAR(errorOf(curves, chosen), leastError(curves, budget), kRounding);
    // Whether the budget had to choose.
    if (chosen != spendBudget(curves, 0)) ++bound;
  }
  EXPECT_GT(bound, kRounds / 10);
  EXPECT_LT(bound, kRounds * 9 / 10);
}

TEST(SphereBudget, WithoutALimitTakesTheFinestSets) {
  const std::vector<CurvePoints> curves{{setOf(1, 3), setOf(2, 2), setOf(9, 1)}, {}, {setOf(4, 1)}};
  EXPECT_THAT(spendBudget(curves, 0), ElementsAre(2, 0, 0));
}

TEST(SphereBudget, BelowTheCoarsestSetsTakesThem) {
  const std::vector<CurvePoints> curves{{setOf(5, 3), setOf(6, 1)}, {setOf(5, 3), setOf(6, 1)}};
  EXPECT_THAT(spendBudget(curves, 1), ElementsAre(0, 0));
  EXPECT_THAT(spendBudget(curves, 9), ElementsAre(0, 0));
  EXPECT_THAT(spendBudget(curves, 11), ElementsAre(1, 0)) << "of equals the first";
}

TEST(SphereBudget, PassesOverAStepThatDoesNotFitOrDoesNotHelp) {
  // The second set is worse than the first; the third is worth its two spheres.
  const std::vector<CurvePoints> curves{{setOf(1, 3), setOf(2, 4), setOf(3, 1)}};
  EXPECT_THAT(spendBudget(curves, 2), ElementsAre(0));
  EXPECT_THAT(spendBudget(curves, 3), ElementsAre(2));
  // The best step of all adds too many; the next best one fits.
  const std::vector<CurvePoints> two{{setOf(1, 9), setOf(20, 0)}, {setOf(1, 2), setOf(2, 1.9)}};
  EXPECT_THAT(spendBudget(two, 4), ElementsAre(0, 1));
}

/// A set whose widest gap is this.
CurvePoint withGap(std::uint32_t spheres, double error, double widest) {
  return {spheres, error, widest};
}

TEST(SphereBudgetByQuality, PassesOverSetsWithWideGapsAndSpendsMoreThanTheBudget) {
  const std::vector<CurvePoints> curves{
      {withGap(1, 9, 0.2), withGap(5, 2, 0.06), withGap(9, 1, 0.04), withGap(30, 0.5, 0.03)},
      {},
      // A finer set may have a wider gap than the one before.
      {withGap(2, 3, 0.05), withGap(4, 2, 0.06), withGap(8, 1, 0.02)},
      // None is good enough: the finest.
      {withGap(1, 9, 0.5), withGap(3, 8, 0.4)}};
  EXPECT_THAT(bake::spendBudgetWithin(curves, 1, 0.05), ElementsAre(2, 0, 0, 1)) << "9 + 2 + 3";
  EXPECT_THAT(bake::spendBudgetWithin(curves, 20, 0.05), ElementsAre(2, 0, 2, 1)) << "9 + 8 + 3";
  EXPECT_THAT(bake::spendBudgetWithin(curves, 99, 0.05), ElementsAre(3, 0, 2, 1));
  EXPECT_THAT(bake::spendBudgetWithin(curves, 12, 1), ElementsAre(1, 0, 1, 1))
      << "where every gap will do, errors alone count";
}

double widestOf(const std::vector<CurvePoints>& curves, const std::vector<std::size_t>& chosen) {
  double widest = 0;
  for (std::size_t n = 0; n < curves.size(); ++n) {
    if (!curves[n].empty()) widest = std::max(widest, curves[n][chosen[n]].widest_gap);
  }
  return widest;
}

TEST(SphereBudgetEvenly, NarrowsTheWidestGapWhereThatCostsLittle) {
  const std::vector<CurvePoints> curves{{withGap(1, 10, 0.09), withGap(2, 9.5, 0.05)},
                                        {withGap(1, 10, 0.04), withGap(2, 9, 0.03)}};
  EXPECT_THAT(spendBudget(curves, 3), ElementsAre(0, 1));
  EXPECT_THAT(bake::spendBudgetEvenly(curves, 3), ElementsAre(1, 0));
  const std::vector<CurvePoints> costly{{withGap(1, 10, 0.09), withGap(2, 9.5, 0.05)},
                                        {withGap(1, 10, 0.04), withGap(2, 5, 0.03)}};
  EXPECT_THAT(bake::spendBudgetEvenly(costly, 3), ElementsAre(0, 1));
}

TEST(SphereBudgetEvenly, KeepsToTheBudgetAndToATenthMoreError) {
  constexpr std::uint32_t kSeed = 12;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  int narrowed = 0;
  constexpr int kRounds = 400;
  for (int round = 0; round < kRounds; ++round) {
    auto curves = randomCurves(random, 3);
    for (CurvePoints& curve : curves) {
      for (CurvePoint& set : curve) {
        set.widest_gap = (0.5 + static_cast<double>(random()) * 0x1p-32) / set.spheres;
      }
    }
    const auto budget = static_cast<std::uint32_t>(10 + random() % 30);
    const auto least = spendBudget(curves, budget);
    const auto chosen = bake::spendBudgetEvenly(curves, budget);
    constexpr double kRounding = 1e-12;
    EXPECT_LE(spheresOf(curves, chosen), std::max<std::size_t>(budget, spheresOf(curves, least)));
    EXPECT_LE(errorOf(curves, chosen), 1.1 * errorOf(curves, least) + kRounding);
    EXPECT_LE(widestOf(curves, chosen), widestOf(curves, least));
    if (widestOf(curves, chosen) < widestOf(curves, least)) ++narrowed;
  }
  EXPECT_GT(narrowed, kRounds / 10);
  EXPECT_LT(narrowed, kRounds * 9 / 10);
}

TEST(SphereBudget, OfNoCurvesIsNoChoice) { EXPECT_TRUE(spendBudget({}, 10).empty()); }

}  // namespace
}  // namespace galactic::test::sphere_budget_test
