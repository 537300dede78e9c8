#include "sphere_set/cover/candidates.h"

#include <optional>

#include "galactic/bake/parallel_for.h"
#include "sphere_set/cover/lattice.h"
#include "sphere_set/solid/surface_samples.h"

namespace galactic::bake::sphere_set {
namespace {

/// Lattice steps per radius of the disk that a sphere covers on a flat face. A large sphere that
/// just fits replaces many small ones, so it is worth more tries.
constexpr double kStepsPerDisc = 12;
constexpr double kStepsPerSmallestDisc = 6;
/// Centers are pushed to this far below the highest level, meters, so that rounding does not lift
/// them above it.
constexpr double kBelowHighest = 1e-6;
/// Spheres for thin parts are kept if their protrusion exceeds the least one by at most this share
/// of the radius.
constexpr double kThinSlack = 0.13;
/// Steps from the surface of a thin part toward its middle: length as a share of the radius, and
/// number.
constexpr double kThinStep = 0.1;
constexpr int kThinSteps = 12;

/// A sphere with this radius and center.
Candidate candidateAt(const FitTask& task, std::uint32_t radius_index, const Vec3d& center,
                      double signed_distance) {
  return {center, radius_index, std::max(0.0, signed_distance + task.radii[radius_index])};
}

/// A sphere at the lattice point pushed outward onto the highest level, or at the point itself if
/// that fails.
Candidate pushedOutwards(const FitTask& task, std::uint32_t radius_index,
                         const LatticePoint& from) {
  const double highest = highestCenter(task, radius_index);
  const double here = from.surface.distance;
  const double away = std::fabs(here);
  if (away > 0) {
    const Vec3d outwards = (from.position - from.surface.nearest) * (1 / here);
    const Vec3d pushed = asStored(from.position + outwards * (highest - kBelowHighest - here));
    const double there = task.solid->distance(pushed, from.surface.facet).distance;
    if (there <= highest && there > here && staysAbove(task, pushed, task.radii[radius_index])) {
      return candidateAt(task, radius_index, pushed, there);
    }
  }
  return candidateAt(task, radius_index, from.position, here);
}

std::vector<Candidate> candidatesOfRadius(const FitTask& task, std::uint32_t radius_index,
                                          const PointGrid& wanted) {
  const double radius = task.radii[radius_index];
  const double highest = highestCenter(task, radius_index);
  const LatticeBand band{latticeSpacing(task, radius_index), -(radius + task.eps), highest, &wanted,
                         radius + task.eps};
  const auto lattice = latticeInBand(*task.solid, band, task.threads);
  std::vector<std::optional<Candidate>> made(lattice.size());
  parallelFor(task.threads, lattice.size(), [&](std::size_t at) {
    const LatticePoint& point = lattice[at];
    const bool high = point.surface.distance > highest - 1.5 * band.spacing;
    const Candidate candidate =
        high ? pushedOutwards(task, radius_index, point)
             : candidateAt(task, radius_index, point.position, point.surface.distance);
    if (staysAbove(task, candidate.center, radius)) made[at] = candidate;
  });
  std::vector<Candidate> candidates;
  for (const auto& candidate : made) {
    if (candidate) candidates.push_back(*candidate);
  }
  return candidates;
}

/// The points whose flag in `covered` is not set.
std::vector<Vec3d> openPoints(std::span<const Vec3d> points, std::span<const char> covered) {
  std::vector<Vec3d> open;
  for (std::size_t at = 0; at < points.size(); ++at) {
    if (covered[at] == 0) open.push_back(points[at]);
  }
  return open;
}

/// A point near the middle of the part below the surface point `p`.
Vec3d middleOfPart(const FitTask& task, const Vec3d& p) {
  const double step = kThinStep * task.radii.front();
  const SurfaceDistance start = task.solid->distance(p);
  const Vec3d normal = facetNormal(task.solid->facets()[start.facet]);
  Vec3d direction = normal * (1 / norm(normal));
  if (task.solid->distance(p - direction * step).distance <
      task.solid->distance(p + direction * step).distance) {
    direction = direction * -1;
  }
  Vec3d best = p;
  double lowest = start.distance;
  for (int n = 0; n < kThinSteps; ++n) {
    const Vec3d next = asStored(best + direction * step);
    const double there = task.solid->distance(next).distance;
    if (there >= lowest) break;
    best = next;
    lowest = there;
  }
  return best;
}

}  // namespace

Candidate sphereAround(const FitTask& task, const Vec3d& p) {
  const double radius = task.radii.front();
  Vec3d center = p;
  if (!staysAbove(task, p, radius)) {
    const double missing = radius - heightAbove(task.support, p);
    center = asStored(p + widen(task.support->normal) * missing);
  }
  return candidateAt(task, 0, center, task.solid->distance(center).distance);
}

bool staysAbove(const FitTask& task, const Vec3d& center, double radius) {
  // Rounding may move a lifted center back by this much.
  constexpr double kRounding = 1e-6;
  return heightAbove(task.support, center) >= radius - kRounding;
}

double latticeSpacing(const FitTask& task, std::uint32_t radius_index) {
  const double radius = task.radii[radius_index];
  const double reach = radius + task.eps;
  const double below = std::max(0.0, radius - task.tau);
  const double disc = std::sqrt(reach * reach - below * below);
  const double band = task.solid->area() * (reach + highestCenter(task, radius_index));
  const double steps = radius_index == 0 ? kStepsPerSmallestDisc : kStepsPerDisc;
  return std::max(disc / steps, std::cbrt(std::max(band, 0.0) / task.most_places));
}

Candidates findCandidates(const FitTask& task, std::span<const Vec3d> points) {
  const PointGrid grid(points, gridCell(task));
  Candidates result;
  result.coverable.assign(points.size(), 0);
  for (std::size_t rank = task.radii.size(); rank-- > 0;) {
    const std::vector<Vec3d> open = openPoints(points, result.coverable);
    if (open.empty()) break;
    const PointGrid wanted(open, gridCell(task));
    const auto found = candidatesOfRadius(task, static_cast<std::uint32_t>(rank), wanted);
    const std::size_t from = result.pool.candidates.size();
    appendCovering(task, grid, found, result.pool);
    markCovered(result.pool, from, result.coverable);
  }
  return result;
}

void addThinCandidates(const FitTask& task, std::span<const Vec3d> points,
                       std::span<const char> coverable, CandidatePool& pool) {
  const std::vector<Vec3d> open = openPoints(points, coverable);
  if (open.empty()) return;
  const PointGrid wanted(open, gridCell(task));
  const double radius = task.radii.front();
  const double reach = radius + task.eps;
  const LatticeBand band{latticeSpacing(task, 0), -reach, task.support ? radius : 0.0, &wanted,
                         reach};
  std::vector<Vec3d> places;
  for (const LatticePoint& p : latticeInBand(*task.solid, band, task.threads)) {
    places.push_back(p.position);
  }
  const std::size_t of_points = places.size();
  places.resize(of_points + 2 * open.size());
  parallelFor(task.threads, open.size(), [&](std::size_t at) {
    places[of_points + 2 * at] = open[at];
    places[of_points + 2 * at + 1] = middleOfPart(task, open[at]);
  });
  std::vector<Candidate> found(places.size());
  parallelFor(task.threads, places.size(),
              [&](std::size_t at) { found[at] = sphereAround(task, places[at]); });

  CandidatePool thin;
  appendCovering(task, PointGrid(points, gridCell(task)), found, thin);
  std::vector<double> least(points.size(), HUGE_VAL);
  for (std::size_t at = 0; at < thin.candidates.size(); ++at) {
    for (const std::uint32_t row : thin.cover.column(at)) {
      least[row] = std::min(least[row], thin.candidates[at].protrusion);
    }
  }
  for (std::size_t at = 0; at < thin.candidates.size(); ++at) {
    const auto rows = thin.cover.column(at);
    const double protrusion = thin.candidates[at].protrusion - kThinSlack * radius;
    const bool needed = std::any_of(rows.begin(), rows.end(), [&](std::uint32_t row) {
      return coverable[row] == 0 && protrusion <= std::max(task.tau, least[row]);
    });
    if (!needed) continue;
    pool.candidates.push_back(thin.candidates[at]);
    pool.cover.append(rows);
  }
}

}  // namespace galactic::bake::sphere_set
