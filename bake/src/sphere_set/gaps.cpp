#include "sphere_set/gaps.h"

#include "galactic/bake/parallel_for.h"

namespace galactic::bake::sphere_fit {

double outside(const FitTask& task, const Candidate& sphere, const Vec3d& p) {
  return length(p - sphere.centre) - task.radii[sphere.radius_index];
}

std::vector<double> gapsOf(const FitTask& task, std::span<const Candidate> spheres,
                           std::span<const Vec3d> points) {
  constexpr std::size_t kChunk = 1024;
  std::vector<double> gaps(points.size(), HUGE_VAL);
  parallelFor(task.jobs, (points.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(points.size(), (chunk + 1) * kChunk);
    for (std::size_t at = chunk * kChunk; at < end; ++at) {
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

}  // namespace galactic::bake::sphere_fit
