#include "sphere_set/solid/surface_samples.h"

#include <algorithm>
#include <array>
#include <bit>

#include "common/random.h"

namespace galactic::bake::sphere_set {
namespace {

/// Tries added for every surface, so that small ones get enough.
constexpr double kLeastTries = 50;

/// Points in a hash table of cubes, so that the size of the object does not matter.
class SparseGrid {
 public:
  SparseGrid(double edge, std::size_t expected)
      : edge_(edge), heads_(std::bit_ceil(2 * expected + 16), kNone) {}

  /// Whether any point is nearer to `p` than the edge length of a cube.
  [[nodiscard]] bool hasNear(const Vec3d& p, const std::vector<Vec3d>& points) const {
    const Cube at = cubeOf(p);
    // Most points have a neighbor in their own cube.
    if (holdsNear(at, p, points)) return true;
    const AxisDistances x = squaredDistances(at[0], p.x);
    const AxisDistances y = squaredDistances(at[1], p.y);
    const AxisDistances z = squaredDistances(at[2], p.z);
    // Slightly more, so that rounding leaves no cube out.
    const double reach = edge_ * edge_ * (1 + 1e-9);
    for (std::size_t k = 0; k < 3; ++k) {
      if (z[k] >= reach) continue;
      for (std::size_t j = 0; j < 3; ++j) {
        if (z[k] + y[j] >= reach) continue;
        for (std::size_t i = 0; i < 3; ++i) {
          if (z[k] + y[j] + x[i] >= reach || (i == 1 && j == 1 && k == 1)) continue;
          if (holdsNear({besides(at[0], i), besides(at[1], j), besides(at[2], k)}, p, points)) {
            return true;
          }
        }
      }
    }
    return false;
  }

  /// Adds the point that was last appended to the list.
  void add(const Vec3d& p) {
    std::uint32_t& head = heads_[slotOf(cubeOf(p))];
    next_.push_back(head);
    head = static_cast<std::uint32_t>(next_.size() - 1);
  }

 private:
  using Cube = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  [[nodiscard]] Cube cubeOf(const Vec3d& p) const {
    const auto along = [&](double at) { return static_cast<std::int64_t>(std::floor(at / edge_)); };
    return {along(p.x), along(p.y), along(p.z)};
  }

  /// Whether a point of `cube` is near `p`. Other cubes with the same slot only cost a comparison.
  [[nodiscard]] bool holdsNear(const Cube& cube, const Vec3d& p,
                               const std::vector<Vec3d>& points) const {
    for (std::uint32_t i = heads_[slotOf(cube)]; i != kNone; i = next_[i]) {
      if (squaredNorm(points[i] - p) < edge_ * edge_) return true;
    }
    return false;
  }

  /// Squared distances to the previous cube, the same cube and the next one along an axis.
  using AxisDistances = std::array<double, 3>;

  [[nodiscard]] AxisDistances squaredDistances(std::int64_t at, double x) const {
    const double before = x - static_cast<double>(at) * edge_;
    const double behind = static_cast<double>(at + 1) * edge_ - x;
    return {before * before, 0, behind * behind};
  }

  static std::int64_t besides(std::int64_t at, std::size_t n) {
    return at + static_cast<std::int64_t>(n) - 1;
  }

  [[nodiscard]] std::size_t slotOf(const Cube& cube) const {
    std::uint64_t mixed = 0;
    for (const std::int64_t at : cube) {
      mixed = (mixed ^ static_cast<std::uint64_t>(at)) * 0x9E3779B97F4A7C15ULL;
      mixed ^= mixed >> 29U;
    }
    return static_cast<std::size_t>(mixed) & (heads_.size() - 1);
  }

  double edge_;
  std::vector<std::uint32_t> heads_;
  std::vector<std::uint32_t> next_;
};

Vec3d pointOn(const Facet& facet, Random& random) {
  const double a = std::sqrt(random.unit());
  const double b = random.unit();
  return widen(facet[0]) * (1 - a) + widen(facet[1]) * (a * (1 - b)) + widen(facet[2]) * (a * b);
}

}  // namespace

std::vector<Vec3d> thinnedOut(const std::vector<Vec3d>& points, double spacing) {
  std::vector<Vec3d> kept;
  SparseGrid grid(spacing, points.size());
  for (const Vec3d& p : points) {
    if (grid.hasNear(p, kept)) continue;
    kept.push_back(p);
    grid.add(p);
  }
  return kept;
}

double heightAbove(const std::optional<HalfSpace>& support, const Vec3d& p) {
  if (!support) return HUGE_VAL;
  return dot(widen(support->normal), p) - static_cast<double>(support->offset);
}

std::vector<Vec3d> sampleSurface(const ExteriorSolid& solid,
                                 const std::optional<HalfSpace>& support,
                                 const SampleOptions& options) {
  const auto facets = solid.facets();
  const double per_spacing = solid.area() / (options.spacing * options.spacing);
  const double tries = std::floor(options.tries * per_spacing) + kLeastTries;
  Random random(options.seed);
  std::vector<Vec3d> points;
  SparseGrid grid(options.spacing, static_cast<std::size_t>(per_spacing));
  std::size_t at = 0;
  double ends = facets.empty() ? 0 : norm(facetNormal(facets[0])) / 2;
  for (double n = 0; n < tries && !facets.empty(); ++n) {
    const double wanted = (n + random.unit()) / tries * solid.area();
    while (wanted > ends && at + 1 < facets.size()) {
      ends += norm(facetNormal(facets[++at])) / 2;
    }
    const Vec3d p = asStored(pointOn(facets[at], random));
    if (heightAbove(support, p) < 0 || grid.hasNear(p, points) || !solid.reachable(p)) continue;
    points.push_back(p);
    grid.add(p);
  }
  return points;
}

}  // namespace galactic::bake::sphere_set
