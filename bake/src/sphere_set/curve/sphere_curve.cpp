#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/curve/exchange_search.h"
#include "sphere_set/gaps.h"
#include "sphere_set/prepared_fit.h"
#include "sphere_set/solid/surface_samples.h"
#include "support/try.h"

namespace galactic::bake {

using sphere_set::Candidate;
using sphere_set::Cover;
using sphere_set::DistanceGrid;
using sphere_set::ErrorWeights;
using sphere_set::ExchangeSearch;
using sphere_set::FitTask;
using sphere_set::PreparedFit;
using sphere_set::Yardstick;

namespace {

/// A gap costs its square, plus a linear term that is kLinear times the square at a gap of eps,
/// plus a fourth power that equals the square at a gap of kWideGap times eps.
constexpr double kLinear = 2;
constexpr double kWideGap = 1.75;
/// Weight of protrusions relative to gaps, the factor by which it falls when it keeps wide gaps
/// open, and its lower limit.
constexpr double kProtrusionWeight = 1.5;
constexpr double kCheaper = 0.5;
constexpr double kCheapest = 0.05;
/// The surface points that the search uses: fewest, most, and the desired spacing, meters.
constexpr double kFewestPoints = 400;
constexpr double kMostPoints = 1500;
constexpr double kPointSpacing = 0.025;
/// The points and sweeps with which a set is finally settled; the guarantees are based on these
/// points.
constexpr double kFinalPoints = 3000;
constexpr int kFinalSweeps = 28;
/// Poisson disks leave room: number of points per square of the spacing.
constexpr double kPacking = 0.7;
constexpr std::uint64_t kPointSeed = 1;
constexpr std::uint64_t kFinalSeed = 2;
constexpr double kGridNodes = 15'000;
/// The effort for one of many covers.
constexpr sphere_set::Effort kCurveEffort{400'000, 200'000, 8'000'000, 2, 12};
constexpr double kCurvePlaces = 15'000;

double spacingFor(const FitTask& task, double points) {
  return std::sqrt(kPacking * task.solid->area() / points);
}

/// Spacing of the points that the search uses.
double searchSpacing(const FitTask& task) {
  const double wanted = task.solid->area() / (kPointSpacing * kPointSpacing);
  return spacingFor(task, std::clamp(wanted, kFewestPoints, kMostPoints));
}

ErrorWeights weightsFor(double eps) {
  const double wide = kWideGap * eps;
  ErrorWeights weights;
  weights.gap.linear = static_cast<float>(kLinear * eps);
  weights.gap.fourth = static_cast<float>(1 / (wide * wide));
  weights.protrusion = kProtrusionWeight;
  return weights;
}

}  // namespace

/// The solver's state between the sets of a curve.
class SphereCurve::Fitter {
 public:
  Fitter(PreparedFit prepared, std::uint32_t most)
      : prepared_(std::move(prepared)),
        most_(most),
        spacing_(searchSpacing(prepared_.task)),
        points_(sphere_set::sampleSurface(*prepared_.task.solid, prepared_.task.support,
                                          {spacing_, kPointSeed, 10})),
        weights_(weightsFor(prepared_.task.eps)) {}

  Result<void> refine(unsigned threads) {
    if (points_.empty()) return sphere_set::nothingToCover();
    if (complete_) return {};
    FitTask& task = prepared_.task;
    task.threads = threads;
    if (!search_) {
      grid_.emplace(*task.solid, sphere_set::kLooserTau * task.tau, kGridNodes, threads);
      search_.emplace(task, *grid_, points_, weights_);
    }
    if (!grow()) {
      if (steps_.empty()) return finish(threads);
      complete_ = true;
      return {};
    }
    complete_ = search_->widestGap() <= task.eps || steps_.back().spheres == most_;
    return {};
  }

  Result<void> finish(unsigned threads) {
    if (complete_) return {};
    FitTask task = prepared_.task;
    task.threads = threads;
    task.most_places = kCurvePlaces;
    sphere_set::SurfacePoints surface;
    Cover cover = sphere_set::solveCover(task, kCurveEffort, surface);
    if (cover.spheres.empty()) return sphere_set::nothingToCover();
    steps_.clear();
    sets_.clear();
    add(cover.spheres, {.widest_gap = cover.guaranteed_gap, .unseen_gap = cover.slack});
    cover_ = std::move(cover);
    complete_ = true;
    return {};
  }

  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] const std::vector<CurvePoint>& points() const { return steps_; }

  [[nodiscard]] SphereSet take(std::size_t n) const {
    const Yardstick yardstick(prepared_.task);
    const Cover cover = cover_ ? *cover_ : settled(sets_[n]);
    SphereSet set = sphere_set::finishedSet(prepared_.task, yardstick, cover);
    yardstick.complete(cover.spheres, set.quality);
    return set;
  }

 private:
  /// Adds a sphere. If its protrusion would cost too much to close wide gaps, protrusions cost less
  /// from there on.
  bool grow() {
    for (double weight = 1; weight > kCheapest; weight *= kCheaper) {
      const double before = search_->error();
      if (search_->grow()) {
        const double error =
            steps_.empty() ? search_->error() : steps_.back().error - before + search_->error();
        // Between the points, a gap can be wider by at most their spacing.
        add(search_->spheres(), {.error = error,
                                 .widest_gap = search_->widestGap() + spacing_,
                                 .unseen_gap = spacing_});
        return true;
      }
      search_->cheapenProtrusion(kCheaper);
    }
    return false;
  }

  void add(std::vector<Candidate> spheres, CurvePoint point) {
    point.spheres = static_cast<std::uint32_t>(spheres.size());
    steps_.push_back(point);
    sets_.push_back(std::move(spheres));
  }

  /// The spheres, settled on denser points than those of the search, and what can be guaranteed.
  [[nodiscard]] Cover settled(const std::vector<Candidate>& spheres) const {
    const FitTask& task = prepared_.task;
    const double spacing = spacingFor(task, kFinalPoints);
    const std::vector<Vec3d> dense =
        sphere_set::sampleSurface(*task.solid, task.support, {spacing, kFinalSeed, 10});
    ExchangeSearch search(task, *grid_, dense, weights_, spheres);
    search.settle(kFinalSweeps);
    Cover cover;
    cover.spheres = search.spheres();
    // Between the points, a gap can be larger by at most their spacing.
    cover.slack = spacing;
    cover.guaranteed_gap =
        sphere_set::largestOf(sphere_set::gapsOf(task, cover.spheres, dense)) + spacing;
    for (Candidate& sphere : cover.spheres) {
      const double radius = task.radii[sphere.radius_index];
      sphere.protrusion = std::max(0.0, task.solid->distance(sphere.center).distance + radius);
      cover.guaranteed_protrusion = std::max(cover.guaranteed_protrusion, sphere.protrusion);
    }
    return cover;
  }

  PreparedFit prepared_;
  std::uint32_t most_ = 0;
  double spacing_ = 0;
  std::vector<Vec3d> points_;
  ErrorWeights weights_;
  std::optional<DistanceGrid> grid_;
  std::optional<ExchangeSearch> search_;
  std::vector<CurvePoint> steps_;
  /// The spheres of each step.
  std::vector<std::vector<Candidate>> sets_;
  /// The only set, if finish() made it.
  std::optional<Cover> cover_;
  bool complete_ = false;
};

SphereCurve::SphereCurve(std::unique_ptr<Fitter> fitter) : fitter_(std::move(fitter)) {}
SphereCurve::~SphereCurve() = default;
SphereCurve::SphereCurve(SphereCurve&&) noexcept = default;
SphereCurve& SphereCurve::operator=(SphereCurve&&) noexcept = default;

Result<SphereCurve> SphereCurve::begin(const TriangleMesh& mesh, const SphereSetOptions& options,
                                       unsigned threads) {
  ASSIGN_OR_RETURN(auto prepared, sphere_set::prepareFit(mesh, options, threads));
  return SphereCurve(std::make_unique<Fitter>(std::move(prepared), options.max_spheres));
}

Result<void> SphereCurve::refine(unsigned threads) { return fitter_->refine(threads); }
Result<void> SphereCurve::finish(unsigned threads) { return fitter_->finish(threads); }
bool SphereCurve::complete() const { return fitter_->complete(); }
const std::vector<CurvePoint>& SphereCurve::points() const { return fitter_->points(); }
SphereSet SphereCurve::take(std::size_t point) const { return fitter_->take(point); }

}  // namespace galactic::bake
