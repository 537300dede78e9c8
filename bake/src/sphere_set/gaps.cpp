#include "sphere_set/gaps.h"

#include <algorithm>

#include "galactic/bake/parallel_for.h"
#include "sphere_set/cover/cover_matrix.h"
#include "sphere_set/solid/point_grid.h"

namespace galactic::bake::sphere_set {
namespace {

/// Up to this number, all spheres are compared with each point.
constexpr std::size_t kFewSpheres = 64;
/// Most points of a cover are within this multiple of eps of a sphere.
constexpr double kNearShare = 1.25;

/// Lowers the gaps of points near spheres. The result is exact where it is at most kNearShare *
/// eps; elsewhere, no sphere is that near.
void lowerNearSpheres(const FitTask& task, std::span<const Candidate> spheres,
                      std::span<const Vec3d> points, std::vector<double>& gaps) {
  // Slightly more, so that rounding leaves no point out.
  constexpr double kRounding = 1 + 1e-9;
  const PointGrid grid(points, gridCell(task));
  for (const Candidate& sphere : spheres) {
    const double reach = (task.radii[sphere.radius_index] + kNearShare * task.eps) * kRounding;
    grid.visitWithin(sphere.center, reach, [&](std::uint32_t at, double) {
      gaps[at] = std::min(gaps[at], outside(task, sphere, points[at]));
      return true;
    });
  }
}

}  // namespace

double outside(const FitTask& task, const Candidate& sphere, const Vec3d& p) {
  return norm(p - sphere.center) - task.radii[sphere.radius_index];
}

std::vector<double> gapsOf(const FitTask& task, std::span<const Candidate> spheres,
                           std::span<const Vec3d> points) {
  std::vector<double> gaps(points.size(), HUGE_VAL);
  const bool is_many = spheres.size() > kFewSpheres;
  if (is_many) lowerNearSpheres(task, spheres, points, gaps);
  constexpr std::size_t kChunk = 1024;
  parallelFor(task.threads, (points.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(points.size(), (chunk + 1) * kChunk);
    for (std::size_t at = chunk * kChunk; at < end; ++at) {
      if (is_many && gaps[at] <= kNearShare * task.eps) continue;
      for (const Candidate& sphere : spheres) {
        gaps[at] = std::min(gaps[at], outside(task, sphere, points[at]));
      }
    }
  });
  return gaps;
}

double largestOf(std::span<const double> gaps) {
  double largest = 0;
  for (const double gap : gaps) largest = std::max(largest, gap);
  return largest;
}

}  // namespace galactic::bake::sphere_set
