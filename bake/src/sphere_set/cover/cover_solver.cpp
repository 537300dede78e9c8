#include "sphere_set/cover/cover_solver.h"

#include <numeric>

#include "galactic/bake/parallel_for.h"
#include "sphere_set/cover/candidates.h"
#include "sphere_set/cover/local_search.h"
#include "sphere_set/cover/set_cover.h"
#include "sphere_set/gaps.h"
#include "sphere_set/solid/surface_samples.h"

namespace galactic::bake::sphere_set {
namespace {

/// Spacing of the points to cover, as a share of eps, within these limits of the number of points.
constexpr double kSpacingOfEps = 0.3;
constexpr double kMostPoints = 15'000;
constexpr double kLeastPoints = 400;
/// Spacing of the points for the check, as a share of the spacing of the points to cover.
constexpr double kDenser = 0.4;
/// A point of the check counts as covered if its gap exceeds eps by at most this share of the
/// check's spacing.
constexpr double kTolerated = 0.5;

constexpr std::uint64_t kPointSeed = 1;
constexpr std::uint64_t kDenseSeed = 2;

/// Candidates within this many steps of the finest lattice are compared for dominance.
constexpr double kDominanceSteps = 3;

/// Steps in each direction of the fine lattice around a chosen sphere.
constexpr int kFineSteps = 4;
/// Additional rounds of refinement while the cover still misses points of the check.
constexpr int kMoreRounds = 2;

static_assert((1 + kTolerated) * kDenser * kSpacingOfEps <= kSlackOfEps + 1e-9);

double spacingOf(const FitTask& task) {
  const double area = task.solid->area();
  return std::clamp(kSpacingOfEps * task.eps, std::sqrt(area / kMostPoints),
                    std::sqrt(area / kLeastPoints));
}

void spreadPoints(const FitTask& task, SurfacePoints& surface) {
  const double spacing = spacingOf(task);
  if (surface.spacing == spacing) return;
  surface.spacing = spacing;
  surface.points = sampleSurface(*task.solid, task.support, {spacing, kPointSeed, 10});
  surface.dense = sampleSurface(*task.solid, task.support, {kDenser * spacing, kDenseSeed, 8});
}

class CoverSolver {
 public:
  CoverSolver(const FitTask& task, const Effort& effort, const SurfacePoints& surface)
      : task_(task),
        effort_(effort),
        spacing_(surface.spacing),
        points_(surface.points),
        dense_(surface.dense) {}

  [[nodiscard]] Cover solve() {
    if (points_.empty()) return {};
    findCover();
    bool complete = false;
    const int most = effort_.rounds + kMoreRounds;
    for (int round = 0; round < most && (round < effort_.rounds || !complete); ++round) {
      complete = refine(round);
    }
    polish(task_, dense_, effort_.polish_sweeps, chosen_);
    topUp();
    dropNeedless();
    polish(task_, dense_, effort_.polish_sweeps, chosen_);
    Cover cover;
    cover.slack = (1 + kTolerated) * kDenser * spacing_;
    // Between the checked points, a gap can be larger by at most their spacing.
    cover.guaranteed_gap = largestOf(gapsOf(task_, chosen_, dense_)) + kDenser * spacing_;
    for (const Candidate& sphere : chosen_) {
      cover.guaranteed_protrusion = std::max(cover.guaranteed_protrusion, sphere.protrusion);
    }
    cover.spheres = std::move(chosen_);
    return cover;
  }

 private:
  void findCover() {
    Candidates found = findCandidates(task_, points_);
    addThinCandidates(task_, points_, found.coverable, found.pool);
    const double distance = kDominanceSteps * latticeSpacing(task_, 0);
    const CandidatePool pool = withoutDominated(task_, points_, found.pool, distance);
    coarse_ = pool.candidates;
    choose(pool, {}, effort_.search);
  }

  /// Completes `selection`, reduces it, and stores it in chosen_.
  void choose(const CandidatePool& pool, Selection selection, std::uint64_t operations_each) {
    completeGreedily(pool, points_.size(), selection);
    removeRedundant(pool, points_.size(), selection);
    const std::uint64_t wanted = operations_each * selection.size();
    selection =
        LocalSearch(task_, points_, pool).improve(selection, std::min(wanted, effort_.limit));
    chosen_.clear();
    for (const std::uint32_t at : selection) chosen_.push_back(pool.candidates[at]);
  }

  [[nodiscard]] double largestAccepted() const {
    return task_.eps + kTolerated * kDenser * spacing_;
  }

  /// The points of the check that are too far from every chosen sphere.
  [[nodiscard]] std::vector<Vec3d> uncovered() const {
    const std::vector<double> gaps = gapsOf(task_, chosen_, dense_);
    std::vector<Vec3d> open;
    for (std::size_t at = 0; at < dense_.size(); ++at) {
      if (gaps[at] > largestAccepted()) open.push_back(dense_[at]);
    }
    return open;
  }

  /// Candidates for points that were added later, including spheres for thin parts.
  [[nodiscard]] std::vector<Candidate> candidatesFor(std::span<const Vec3d> points) const {
    if (points.empty()) return {};
    Candidates found = findCandidates(task_, points);
    addThinCandidates(task_, points, found.coverable, found.pool);
    return found.pool.candidates;
  }

  /// Searches again with finer lattices around the chosen spheres and with the points that the
  /// cover misses. Returns whether it missed none.
  bool refine(int round) {
    std::vector<Vec3d> open;
    // The first round moves the spheres off the coarse lattice, which closes most gaps.
    if (round > 0) open = thinnedOut(uncovered(), spacing_);
    points_.insert(points_.end(), open.begin(), open.end());
    const PointGrid grid(points_, gridCell(task_));
    CandidatePool pool;
    appendCovering(task_, grid, chosen_, pool);
    Selection selection(pool.candidates.size());
    std::iota(selection.begin(), selection.end(), 0U);
    appendCovering(task_, grid, candidatesFor(open), pool);
    appendCovering(task_, grid, coarse_, pool);
    appendCovering(task_, grid, fineLattices(round), pool);
    choose(pool, std::move(selection), effort_.refine);
    return open.empty();
  }

  [[nodiscard]] std::vector<Candidate> fineLattices(int round) const {
    std::vector<std::vector<Candidate>> parts(chosen_.size());
    parallelFor(task_.threads, chosen_.size(), [&](std::size_t at) {
      const double coarse = latticeSpacing(task_, chosen_[at].radius_index);
      addFineLattice(chosen_[at], coarse / (2 << std::min(round, 2)), parts[at]);
    });
    std::vector<Candidate> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  void addFineLattice(const Candidate& around, double step, std::vector<Candidate>& found) const {
    const double radius = task_.radii[around.radius_index];
    const double most = std::max(task_.tau, around.protrusion);
    std::uint32_t hint = kNoFacet;
    for (int z = -kFineSteps; z <= kFineSteps; ++z) {
      for (int y = -kFineSteps; y <= kFineSteps; ++y) {
        for (int x = -kFineSteps; x <= kFineSteps; ++x) {
          const int squared = x * x + y * y + z * z;
          if (squared == 0 || squared > kFineSteps * kFineSteps) continue;
          const Vec3d offset{static_cast<double>(x), static_cast<double>(y),
                             static_cast<double>(z)};
          const Vec3d center = asStored(around.center + offset * step);
          if (!staysAbove(task_, center, radius)) continue;
          const SurfaceDistance surface = task_.solid->distance(center, hint);
          hint = surface.facet;
          const double protrusion = std::max(0.0, surface.distance + radius);
          if (protrusion > most || surface.distance < -(radius + task_.eps)) continue;
          found.push_back({center, around.radius_index, protrusion});
        }
      }
    }
  }

  /// Greedily covers the points that the rounds left uncovered.
  void topUp() {
    const std::vector<Vec3d> open = uncovered();
    if (open.empty()) return;
    Candidates found = findCandidates(task_, open);
    addThinCandidates(task_, open, found.coverable, found.pool);
    Selection added;
    completeGreedily(found.pool, open.size(), added);
    for (const std::uint32_t at : added) chosen_.push_back(found.pool.candidates[at]);
  }

  /// Removes spheres without which every point of the check is still covered well enough. Spheres
  /// for late points, and moves, may have made some redundant.
  void dropNeedless() {
    FitTask loose = task_;
    loose.eps = std::max(largestAccepted(), largestOf(gapsOf(task_, chosen_, dense_)));
    CandidatePool pool;
    appendCovering(loose, PointGrid(dense_, gridCell(task_)), chosen_, pool);
    Selection selection(pool.candidates.size());
    std::iota(selection.begin(), selection.end(), 0U);
    removeRedundant(pool, dense_.size(), selection);
    chosen_.clear();
    for (const std::uint32_t at : selection) chosen_.push_back(pool.candidates[at]);
  }

  const FitTask& task_;
  const Effort effort_;
  double spacing_;
  /// The points that the search must cover.
  std::vector<Vec3d> points_;
  /// The points on which the cover is checked.
  const std::vector<Vec3d>& dense_;
  /// Candidates from the coarse lattices.
  std::vector<Candidate> coarse_;
  std::vector<Candidate> chosen_;
};

}  // namespace

bool isTooLarge(double area, double eps) {
  return std::sqrt(area / kMostPoints) > kSpacingOfEps * eps;
}

Cover solveCover(const FitTask& task, const Effort& effort, SurfacePoints& surface) {
  spreadPoints(task, surface);
  return CoverSolver(task, effort, surface).solve();
}

}  // namespace galactic::bake::sphere_set
