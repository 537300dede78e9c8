#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "galactic/bake/sphere_set.h"
#include "sphere_set/check_options.h"
#include "sphere_set/cover_solver.h"
#include "sphere_set/measure.h"

namespace galactic::bake {
namespace {

using sphere_fit::Candidate;
using sphere_fit::Cover;
using sphere_fit::Effort;
using sphere_fit::ExteriorSolid;
using sphere_fit::FitTask;
using sphere_fit::SurfacePoints;
using sphere_fit::Yardstick;

/// Tolerances grow by this from one step of a curve to the next looser one: eightfold in 8 steps.
constexpr double kStepFactor = 1.29683955465100966593;
constexpr int kCurveSteps = 8;
/// A loose set may leave wide gaps, but has no business far outside: tau grows with this power of
/// what eps grows by, and never beyond this factor.
constexpr double kProtrusionGrowth = 0.4;
constexpr double kMostProtrusionGrowth = 1.6;
/// With this many steps eps is beyond the size of any mesh, whatever it was.
constexpr int kMostSteps = 64;
/// For one of many covers; the whole curve costs about three single fits.
constexpr Effort kCurveEffort{400'000, 200'000, 8'000'000, 2, 12};
constexpr double kCurvePlaces = 15'000;
/// Halvings of the last step when a number of spheres is given.
constexpr int kHalvings = 2;

/// A mesh made ready, and the task on it.
struct Prepared {
  std::unique_ptr<const ExteriorSolid> solid;
  FitTask task;
};

Result<Prepared> prepare(const TriangleMesh& mesh, const SphereSetOptions& options) {
  if (auto checked = sphere_fit::checkOptions(options); !checked) {
    return tl::unexpected(checked.error());
  }
  if (auto checked = sphere_fit::checkMesh(mesh); !checked) return tl::unexpected(checked.error());
  Prepared prepared;
  prepared.solid = std::make_unique<const ExteriorSolid>(
      mesh, static_cast<double>(options.radii.front()), options.jobs);
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
  task.jobs = options.jobs;
  return prepared;
}

tl::unexpected<Error> nothingToCover() {
  return fail(ErrorCode::kInvalidInput, "support",
              "all of the reachable surface is beyond the plane, so there is nothing to cover; "
              "check its normal and offset");
}

/// The task with looser tolerances, for one of many covers.
FitTask loosened(const FitTask& task, double steps) {
  const double factor = std::pow(kStepFactor, steps);
  FitTask loose = task;
  loose.eps *= factor;
  loose.tau *= std::min(std::pow(factor, kProtrusionGrowth), kMostProtrusionGrowth);
  loose.most_places = kCurvePlaces;
  return loose;
}

bool comesFirst(const SetSphere& a, const SetSphere& b) {
  if (a.radius_index != b.radius_index) return a.radius_index > b.radius_index;
  if (a.centre.x != b.centre.x) return a.centre.x < b.centre.x;
  if (a.centre.y != b.centre.y) return a.centre.y < b.centre.y;
  return a.centre.z < b.centre.z;
}

/// Measured, but for volume and thin points, and judged by the tolerances of `task`, whichever the
/// cover was made for.
SphereSet finished(const FitTask& task, const Yardstick& yardstick, const Cover& cover) {
  SphereSet set;
  for (const Candidate& sphere : cover.spheres) {
    set.spheres.push_back({narrow(sphere.centre), sphere.radius_index});
  }
  std::sort(set.spheres.begin(), set.spheres.end(), comesFirst);
  set.quality = yardstick.measureLengths(cover.spheres);
  // Where the solid's border is no facet (a small hole, the bottom of a crevice), a sphere may be
  // further from the facets than from the solid: what was measured counts.
  set.guaranteed_gap = std::max(cover.guaranteed_gap, set.quality.gap.max);
  set.guaranteed_protrusion = std::max(cover.guaranteed_protrusion, set.quality.protrusion.max);
  set.meets_tolerances =
      set.guaranteed_gap <= task.eps + cover.slack && set.guaranteed_protrusion <= task.tau;
  return set;
}

/// The best cover with at most `most` spheres: the least loosened tolerances that need no more.
Cover coverWithin(const FitTask& task, std::size_t most, SurfacePoints& surface, Cover best) {
  const auto attempt = [&](double steps, const Effort& effort) {
    Cover cover = sphere_fit::solveCover(loosened(task, steps), effort, surface);
    const bool fits = cover.spheres.size() <= most;
    if (fits) best = std::move(cover);
    return fits;
  };
  double too_tight = 0;
  double loose = 4;
  while (!attempt(loose, kCurveEffort) && loose < kMostSteps) {
    too_tight = loose;
    loose *= 2;
  }
  while (loose - too_tight > 1) {
    const double middle = (loose + too_tight) / 2;
    (attempt(middle, kCurveEffort) ? loose : too_tight) = middle;
  }
  for (int halving = 0; halving < kHalvings; ++halving) {
    const double middle = (loose + too_tight) / 2;
    (attempt(middle, Effort{}) ? loose : too_tight) = middle;
  }
  return best;
}

}  // namespace

Result<SphereSet> fitSphereSet(const TriangleMesh& mesh, const SphereSetOptions& options) {
  const auto prepared = prepare(mesh, options);
  if (!prepared) return tl::unexpected(prepared.error());
  const FitTask& task = prepared->task;
  SurfacePoints surface;
  Cover cover = sphere_fit::solveCover(task, {}, surface);
  if (cover.spheres.empty()) return nothingToCover();
  if (options.max_spheres > 0 && cover.spheres.size() > options.max_spheres) {
    cover = coverWithin(task, options.max_spheres, surface, std::move(cover));
  }
  const Yardstick yardstick(task);
  SphereSet set = finished(task, yardstick, cover);
  yardstick.complete(cover.spheres, set.quality);
  return set;
}

/// The solver's state between two sets of a curve.
class SphereCurve::Fitter {
 public:
  Fitter(Prepared prepared, std::uint32_t most)
      : prepared_(std::move(prepared)), yardstick_(prepared_.task), most_(most) {}

  Result<void> refine(unsigned jobs) {
    if (complete()) return {};
    FitTask task = loosened(prepared_.task, step_);
    task.jobs = jobs;
    const Cover cover = sphere_fit::solveCover(task, kCurveEffort, surface_);
    if (cover.spheres.empty()) return nothingToCover();
    --step_;
    if (most_ > 0 && cover.spheres.size() > most_) {
      step_ = kNoStep;
      if (!sets_.empty()) return {};
    }
    SphereSet set = finished(prepared_.task, yardstick_, cover);
    // As many spheres as before, or fewer, for tighter tolerances: the looser set is of no use.
    while (!sets_.empty() && sets_.back().spheres.size() >= set.spheres.size()) {
      sets_.pop_back();
      covers_.pop_back();
    }
    sets_.push_back(std::move(set));
    covers_.push_back(cover.spheres);
    return {};
  }

  [[nodiscard]] bool complete() const { return step_ == kNoStep; }
  [[nodiscard]] const std::vector<SphereSet>& sets() const { return sets_; }

  [[nodiscard]] SphereSet take(std::size_t n) const {
    SphereSet set = sets_[n];
    yardstick_.complete(covers_[n], set.quality);
    return set;
  }

 private:
  static constexpr int kNoStep = -1;

  Prepared prepared_;
  Yardstick yardstick_;
  std::uint32_t most_ = 0;
  int step_ = kCurveSteps;
  SurfacePoints surface_;
  std::vector<SphereSet> sets_;
  /// What each set was made of.
  std::vector<std::vector<Candidate>> covers_;
};

SphereCurve::SphereCurve(std::unique_ptr<Fitter> fitter) : fitter_(std::move(fitter)) {}
SphereCurve::~SphereCurve() = default;
SphereCurve::SphereCurve(SphereCurve&&) noexcept = default;
SphereCurve& SphereCurve::operator=(SphereCurve&&) noexcept = default;

Result<SphereCurve> SphereCurve::begin(const TriangleMesh& mesh, const SphereSetOptions& options) {
  auto prepared = prepare(mesh, options);
  if (!prepared) return tl::unexpected(prepared.error());
  return SphereCurve(std::make_unique<Fitter>(std::move(*prepared), options.max_spheres));
}

Result<void> SphereCurve::refine(unsigned jobs) { return fitter_->refine(jobs); }
bool SphereCurve::complete() const { return fitter_->complete(); }
const std::vector<SphereSet>& SphereCurve::sets() const { return fitter_->sets(); }
SphereSet SphereCurve::take(std::size_t set) const { return fitter_->take(set); }

Result<SphereSetQuality> measureSphereSet(const TriangleMesh& mesh,
                                          const std::vector<SetSphere>& spheres,
                                          const SphereSetOptions& options) {
  const auto prepared = prepare(mesh, options);
  if (!prepared) return tl::unexpected(prepared.error());
  if (spheres.empty()) {
    return fail(ErrorCode::kInvalidInput, "spheres",
                "there are none to measure; give at least one sphere");
  }
  std::vector<Candidate> placed;
  for (std::size_t at = 0; at < spheres.size(); ++at) {
    const SetSphere& sphere = spheres[at];
    if (sphere.radius_index >= options.radii.size()) {
      return fail(ErrorCode::kInvalidInput, fmt::format("spheres[{}].radius_index", at),
                  fmt::format("{} is not in the working set of {} radii; give its index",
                              sphere.radius_index, options.radii.size()));
    }
    const sphere_fit::Vec3d centre = widen(sphere.centre);
    if (!std::isfinite(centre.x + centre.y + centre.z)) {
      return fail(ErrorCode::kInvalidInput, fmt::format("spheres[{}].centre", at),
                  "it is not finite; give metres in the object's frame");
    }
    placed.push_back({centre, sphere.radius_index, 0});
  }
  const Yardstick yardstick(prepared->task);
  SphereSetQuality quality = yardstick.measureLengths(placed);
  yardstick.complete(placed, quality);
  return quality;
}

}  // namespace galactic::bake
