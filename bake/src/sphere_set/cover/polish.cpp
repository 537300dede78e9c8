#include <numbers>

#include "common/random.h"
#include "sphere_set/cover/candidates.h"
#include "sphere_set/cover/cover_matrix.h"
#include "sphere_set/cover/local_search.h"
#include "sphere_set/gaps.h"

namespace galactic::bake::sphere_set {
namespace {

constexpr std::uint64_t kSeed = 17;
constexpr int kTries = 8;
/// The first step as a share of the smallest radius, and the factor by which it shrinks after each
/// sweep.
constexpr double kFirstStep = 0.4;
constexpr double kStepDecay = 0.82;
/// Moves are up to kLeastOfStep + 1 steps long along each axis; their length is scaled by a random
/// factor of at least kLeastOfStep.
constexpr double kLeastOfStep = 0.3;
/// Weight of the squared excess of a gap over eps, high enough that closing such gaps comes first.
constexpr double kRepair = 1e4;

/// A point that a sphere may have to cover, and its distance to the nearest of the other spheres.
struct NearPoint {
  Vec3d position;
  double others = 0;
};

class Polisher {
 public:
  Polisher(const FitTask& task, std::span<const Vec3d> points, std::vector<Candidate>& spheres)
      : task_(task),
        points_(points),
        spheres_(spheres),
        grid_(points, gridCell(task)),
        most_(std::max(task.eps, largestOf(gapsOf(task, spheres, points)))),
        random_(kSeed) {}

  void sweep(double step) {
    // Upper bound of a sphere's movement in a sweep.
    const double furthest = kTries * (kLeastOfStep + 1) * step * std::sqrt(3.0);
    neighbors_ = neighborsWithin(2 * furthest);
    for (std::size_t at = 0; at < spheres_.size(); ++at) improve(at, step);
  }

 private:
  void improve(std::size_t at, double step) {
    const std::vector<NearPoint> near = pointsNear(at);
    Candidate& sphere = spheres_[at];
    double cost = costOf(sphere, near);
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const Vec3d direction{random_.unit() * 2 - 1, random_.unit() * 2 - 1, random_.unit() * 2 - 1};
      const double length = step * (kLeastOfStep + random_.unit());
      Candidate moved = sphere;
      moved.center = asStored(sphere.center + direction * length);
      if (!allowed(sphere, moved)) continue;
      const double moved_cost = costOf(moved, near);
      if (moved_cost < cost) {
        cost = moved_cost;
        sphere = moved;
      }
    }
  }

  /// Whether the move is allowed. Also sets the protrusion of `moved`.
  [[nodiscard]] bool allowed(const Candidate& sphere, Candidate& moved) const {
    const double radius = task_.radii[moved.radius_index];
    if (!staysAbove(task_, moved.center, radius)) return false;
    moved.protrusion = std::max(0.0, task_.solid->distance(moved.center).distance + radius);
    return moved.protrusion <= std::max(task_.tau, sphere.protrusion);
  }

  [[nodiscard]] std::vector<NearPoint> pointsNear(std::size_t at) const {
    // The point with the largest gap is exactly at the end of its sphere's reach, so that rounding
    // could leave it out.
    constexpr double kRounding = 1e-6;
    const double reach = task_.radii[spheres_[at].radius_index] + most_ + kRounding;
    std::vector<const Candidate*> neighbors;
    for (const std::uint32_t other : neighbors_[at]) {
      const double reaches = reach + most_ + task_.radii[spheres_[other].radius_index];
      const double squared = squaredNorm(spheres_[other].center - spheres_[at].center);
      if (squared < reaches * reaches) neighbors.push_back(&spheres_[other]);
    }
    std::vector<NearPoint> near;
    grid_.visitWithin(spheres_[at].center, reach, [&](std::uint32_t index, double) {
      NearPoint point{points_[index], HUGE_VAL};
      for (const Candidate* other : neighbors) {
        point.others = std::min(point.others, outside(task_, *other, point.position));
      }
      // Points inside other spheres cost nothing, wherever this sphere goes.
      if (point.others > 0) near.push_back(point);
      return true;
    });
    return near;
  }

  /// For each sphere, the others that may cover the same points if the two come closer by up to
  /// `margin`.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> neighborsWithin(double margin) const {
    constexpr double kRounding = 1e-6;
    const double largest = task_.radii.back() + most_;
    std::vector<Vec3d> centers;
    for (const Candidate& sphere : spheres_) centers.push_back(sphere.center);
    const PointGrid grid(centers, largest);
    std::vector<std::vector<std::uint32_t>> neighbors(centers.size());
    for (std::size_t at = 0; at < centers.size(); ++at) {
      const double reach = task_.radii[spheres_[at].radius_index] + most_ + largest;
      grid.visitWithin(centers[at], reach + margin + kRounding, [&](std::uint32_t other, double) {
        if (other != at) neighbors[at].push_back(other);
        return true;
      });
    }
    return neighbors;
  }

  /// The cost of a sphere; infinite if a gap would be too large.
  [[nodiscard]] double costOf(const Candidate& sphere, const std::vector<NearPoint>& near) const {
    double sum = 0;
    for (const NearPoint& point : near) {
      const double gap = std::min(point.others, outside(task_, sphere, point.position));
      if (gap > most_) return HUGE_VAL;
      if (gap > 0) sum += gap * gap;
      if (gap > task_.eps) sum += kRepair * (gap - task_.eps) * (gap - task_.eps);
    }
    const double radius = task_.radii[sphere.radius_index];
    const double share = 4 * std::numbers::pi * radius * radius / task_.solid->area();
    return sum / static_cast<double>(points_.size()) +
           share * sphere.protrusion * sphere.protrusion;
  }

  const FitTask& task_;
  std::span<const Vec3d> points_;
  std::vector<Candidate>& spheres_;
  PointGrid grid_;
  /// Largest allowed gap.
  double most_;
  Random random_;
  /// Neighbors of each sphere during a sweep.
  std::vector<std::vector<std::uint32_t>> neighbors_;
};

}  // namespace

void polish(const FitTask& task, std::span<const Vec3d> points, int sweeps,
            std::vector<Candidate>& spheres) {
  Polisher polisher(task, points, spheres);
  double step = kFirstStep * task.radii.front();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    polisher.sweep(step);
    step *= kStepDecay;
  }
}

}  // namespace galactic::bake::sphere_set
