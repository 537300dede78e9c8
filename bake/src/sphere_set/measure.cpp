#include "sphere_set/measure.h"

#include <numeric>

#include "galactic/bake/parallel_for.h"
#include "sphere_set/cover/candidates.h"
#include "sphere_set/gaps.h"
#include "sphere_set/solid/surface_samples.h"

namespace galactic::bake::sphere_set {
namespace {

/// Different from the seeds that the solver uses.
constexpr std::uint64_t kSeed = 99;
constexpr double kSurfaceSamples = 20'000;
/// Sample spacings are within these shares of the smallest radius if the area allows.
constexpr double kFinestSpacing = 0.1;
constexpr double kCoarsestSpacing = 0.3;
/// Points per sphere; large spheres get more.
constexpr double kLeastSpherePoints = 250;
constexpr double kMostSpherePoints = 600;
constexpr double kVolumeSamples = 40'000;

/// A length, weighted by the surface that it stands for.
struct Weighted {
  double value = 0;
  double weight = 0;
};

LengthStatistics statisticsOf(std::vector<Weighted> values) {
  LengthStatistics result;
  if (values.empty()) return result;
  std::sort(values.begin(), values.end(), [](const Weighted& a, const Weighted& b) {
    return a.value != b.value ? a.value < b.value : a.weight < b.weight;
  });
  double sum = 0;
  double total = 0;
  for (const Weighted& v : values) {
    sum += v.value * v.weight;
    total += v.weight;
  }
  result.mean = sum / total;
  result.max = values.back().value;
  double below = 0;
  for (const Weighted& v : values) {
    below += v.weight;
    result.p95 = v.value;
    if (below >= 0.95 * total) break;
  }
  return result;
}

double sampleSpacing(const FitTask& task) {
  const double area = task.solid->area();
  const double radius = task.radii.front();
  return std::clamp(std::sqrt(area / kSurfaceSamples),
                    std::min(kFinestSpacing * radius, std::sqrt(area / 2000)),
                    std::max(kCoarsestSpacing * radius, std::sqrt(area / (5 * kSurfaceSamples))));
}

/// For each sphere, the other spheres that intersect it.
std::vector<std::vector<const Candidate*>> neighborsOf(const FitTask& task,
                                                       std::span<const Candidate> spheres) {
  std::vector<std::vector<const Candidate*>> neighbors(spheres.size());
  for (std::size_t a = 0; a < spheres.size(); ++a) {
    for (std::size_t b = 0; b < spheres.size(); ++b) {
      const double reach =
          task.radii[spheres[a].radius_index] + task.radii[spheres[b].radius_index];
      const bool meets = squaredNorm(spheres[a].center - spheres[b].center) < reach * reach;
      if (a != b && meets) neighbors[a].push_back(&spheres[b]);
    }
  }
  return neighbors;
}

LengthStatistics protrusionOf(const FitTask& task, std::span<const Candidate> spheres) {
  const auto neighbors = neighborsOf(task, spheres);
  std::vector<std::vector<Weighted>> parts(spheres.size());
  parallelFor(task.threads, spheres.size(), [&](std::size_t at) {
    const double radius = task.radii[spheres[at].radius_index];
    const double scaled = kLeastSpherePoints * radius / task.radii.front();
    const double count = std::clamp(scaled, kLeastSpherePoints, kMostSpherePoints);
    const double share = radius * radius / count;
    const auto points = static_cast<std::size_t>(count);
    std::uint32_t hint = kNoFacet;
    for (std::size_t n = 0; n < points; ++n) {
      const Vec3d p = spheres[at].center + evenDirection(n, points) * radius;
      const bool hidden =
          std::any_of(neighbors[at].begin(), neighbors[at].end(),
                      [&](const Candidate* other) { return outside(task, *other, p) < -1e-9; });
      if (hidden) continue;
      const SurfaceDistance surface = task.solid->distance(p, hint);
      hint = surface.facet;
      parts[at].push_back({std::max(0.0, surface.distance), share});
    }
  });
  std::vector<Weighted> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return statisticsOf(std::move(all));
}

double volumeRatioOf(const FitTask& task, std::span<const Candidate> spheres) {
  Box box = task.solid->bounds();
  for (const Candidate& sphere : spheres) {
    const double radius = task.radii[sphere.radius_index];
    box.grow(sphere.center - Vec3d{radius, radius, radius});
    box.grow(sphere.center + Vec3d{radius, radius, radius});
  }
  const Vec3d size = box.size();
  const double step = std::cbrt(size.x * size.y * size.z / kVolumeSamples);
  const auto along = [&](double extent) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(extent / step));
  };
  struct Counts {
    std::size_t solid = 0;
    std::size_t spheres = 0;
  };
  std::vector<Counts> layers(along(size.z));
  parallelFor(task.threads, layers.size(), [&](std::size_t k) {
    for (std::size_t j = 0; j < along(size.y); ++j) {
      for (std::size_t i = 0; i < along(size.x); ++i) {
        const Vec3d cell{static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5,
                         static_cast<double>(k) + 0.5};
        const Vec3d p = box.min + cell * step;
        layers[k].solid += task.solid->contains(p) ? 1U : 0U;
        const bool held = std::any_of(spheres.begin(), spheres.end(), [&](const Candidate& sphere) {
          return outside(task, sphere, p) <= 0;
        });
        layers[k].spheres += held ? 1U : 0U;
      }
    }
  });
  Counts total;
  for (const Counts& layer : layers) {
    total.solid += layer.solid;
    total.spheres += layer.spheres;
  }
  if (total.solid == 0) return 0;
  return static_cast<double>(total.spheres) / static_cast<double>(total.solid);
}

}  // namespace

Yardstick::Yardstick(const FitTask& task)
    : task_(task),
      samples_(sampleSurface(*task.solid, task.support, {sampleSpacing(task), kSeed, 10})) {}

SphereSetQuality Yardstick::measureLengths(std::span<const Candidate> spheres) const {
  SphereSetQuality quality;
  quality.samples = samples_.size();
  quality.area = task_.solid->area();
  if (samples_.empty() || spheres.empty()) return quality;
  std::vector<Weighted> gaps;
  for (const double gap : gapsOf(task_, spheres, samples_)) {
    gaps.push_back({std::max(0.0, gap), 1});
  }
  quality.gap = statisticsOf(std::move(gaps));
  quality.protrusion = protrusionOf(task_, spheres);
  return quality;
}

void Yardstick::complete(std::span<const Candidate> spheres, SphereSetQuality& quality) const {
  if (quality.samples > 0 && !spheres.empty()) quality.volume_ratio = volumeRatioOf(task_, spheres);
  quality.thin_points = countThin(spheres);
}

std::uint64_t Yardstick::countThin(std::span<const Candidate> spheres) const {
  std::vector<Candidate> within;
  for (const Candidate& sphere : spheres) {
    const double radius = task_.radii[sphere.radius_index];
    const double protrusion = task_.solid->distance(sphere.center).distance + radius;
    const bool above = staysAbove(task_, sphere.center, radius);
    if (protrusion <= task_.tau && above) within.push_back(sphere);
  }
  const std::vector<double> gaps = gapsOf(task_, within, samples_);
  std::vector<Vec3d> open;
  for (std::size_t at = 0; at < samples_.size(); ++at) {
    if (gaps[at] <= task_.eps) continue;
    // Most points need no search over the solid, because a small sphere at the point itself covers
    // it.
    const Candidate around = sphereAround(task_, samples_[at]);
    const bool covers = outside(task_, around, samples_[at]) <= task_.eps;
    if (!covers || around.protrusion > task_.tau) open.push_back(samples_[at]);
  }
  if (open.empty()) return 0;
  const std::vector<char> coverable = findCandidates(task_, open).coverable;
  return static_cast<std::uint64_t>(std::count(coverable.begin(), coverable.end(), 0));
}

}  // namespace galactic::bake::sphere_set
