#include "check/render_cluster_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "check/common_check.h"
#include "check/offence.h"
#include "layout/render_layout.h"

namespace galactic::detail {
namespace {

using Point = std::array<double, 3>;

/// Lattice coordinates up to this are exact as floats.
constexpr std::int64_t kMostLattice = std::int64_t{1} << 24U;
/// More repetitions of an image per vertex step would overflow the integers of a sampler.
constexpr float kMostUvStep = 0.5F;
/// More than the rounding of an axis to floats.
constexpr double kAxisTolerance = 1e-5;
/// More than the rounding of a cone's cosine.
constexpr double kConeTolerance = 1e-5;

class ClusterChecker {
 public:
  ClusterChecker(const RenderCluster& cluster, const RenderModel& model, const RenderPools& pools,
                 const ClusterPlace& place)
      : cluster_(cluster), model_(model), pools_(pools), place_(place), offence_("") {}

  Result<void> run() {
    checkNumbers();
    checkRanges();
    // The checks below read the pools.
    if (offence_.found()) return offence_.result();
    checkBoundsNumbers();
    checkVertices();
    checkTriangles();
    if (offence_.found()) return offence_.result();
    checkBoxes();
    checkSphere();
    checkCone();
    return offence_.result();
  }

 private:
  [[nodiscard]] double bound(std::size_t row) const {
    return static_cast<double>(pools_.bounds[pooledAt(place_.lane, row, kBoundsRows)]);
  }
  [[nodiscard]] std::uint16_t stored(std::size_t vertex, std::size_t row) const {
    return pools_.vertices[pooledAt(cluster_.first_vertex + vertex, row, kVertexRows)];
  }
  [[nodiscard]] std::uint8_t corner(std::size_t triangle, std::size_t number) const {
    return pools_.triangles[pooledAt(cluster_.first_triangle + triangle, number, kTriangleRows)];
  }
  [[nodiscard]] Point lattice(std::size_t vertex) const {
    return {static_cast<double>(cluster_.origin_x + stored(vertex, kVertexX)),
            static_cast<double>(cluster_.origin_y + stored(vertex, kVertexY)),
            static_cast<double>(cluster_.origin_z + stored(vertex, kVertexZ))};
  }

  void checkNumbers() {
    for (const std::int32_t origin : {cluster_.origin_x, cluster_.origin_y, cluster_.origin_z}) {
      offence_.require(origin >= -kMostLattice && origin <= kMostLattice - 65536, "origin",
                       "is {} steps, expected {} to {}", origin, -kMostLattice,
                       kMostLattice - 65536);
    }
    for (const float minimum : {cluster_.u_minimum, cluster_.v_minimum}) {
      offence_.require(minimum >= 0 && minimum <= 1, "uv_minimum", "is {}, expected 0 to 1",
                       minimum);
    }
    for (const float step : {cluster_.u_step, cluster_.v_step}) {
      offence_.require(step >= 0 && step <= kMostUvStep, "uv_step", "is {}, expected 0 to {}", step,
                       kMostUvStep);
    }
    offence_.require(cluster_.material < pools_.materials, "material",
                     "is {}, expected one of the {} materials", cluster_.material,
                     pools_.materials);
    offence_.require(cluster_.semantic < pools_.semantics, "semantic",
                     "is {}, expected one of the {} semantics", cluster_.semantic,
                     pools_.semantics);
    offence_.require(cluster_.two_sided <= 1, "two_sided", "is {}, expected 0 or 1",
                     cluster_.two_sided);
    offence_.require(cluster_.reserved == 0, "reserved", "is {}, expected 0", cluster_.reserved);
  }

  void checkRanges() {
    offence_.require(cluster_.vertex_count >= 1 && cluster_.vertex_count <= kMostInCluster,
                     "vertex_count", "is {}, expected 1 to {}", cluster_.vertex_count,
                     kMostInCluster);
    offence_.require(cluster_.triangle_count >= 1 && cluster_.triangle_count <= kMostInCluster,
                     "triangle_count", "is {}, expected 1 to {}", cluster_.triangle_count,
                     kMostInCluster);
    offence_.require(cluster_.first_vertex == place_.first_vertex, "first_vertex",
                     "is {}, expected {}, behind the cluster before", cluster_.first_vertex,
                     place_.first_vertex);
    offence_.require(cluster_.first_triangle == place_.first_triangle, "first_triangle",
                     "is {}, expected {}, behind the cluster before", cluster_.first_triangle,
                     place_.first_triangle);
    const std::size_t vertices = pools_.vertices.size() / kVertexRows;
    offence_.require(place_.first_vertex + wholeLanes(cluster_.vertex_count) <= vertices,
                     "vertex_count", "is {} from {} on, expected no more than the {} in the pool",
                     cluster_.vertex_count, place_.first_vertex, vertices);
    const std::size_t triangles = pools_.triangles.size() / kTriangleRows;
    offence_.require(place_.first_triangle + wholeLanes(cluster_.triangle_count) <= triangles,
                     "triangle_count", "is {} from {} on, expected no more than the {} in the pool",
                     cluster_.triangle_count, place_.first_triangle, triangles);
  }

  void checkBoundsNumbers() {
    // Enough for a box around something that reaches from one end of the world to the other.
    constexpr double kFarthestBound = 4 * static_cast<double>(kFarthest);
    for (std::size_t row = 0; row < kBoundsRows; ++row) {
      offence_.require(std::abs(bound(row)) <= kFarthestBound, "bounds",
                       "are {} in row {}, expected up to {}", bound(row), row, kFarthestBound);
    }
    const double cutoff = bound(kConeCutoffRow);
    double squared = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      squared += bound(kConeAxisRow + n) * bound(kConeAxisRow + n);
    }
    if (cutoff == static_cast<double>(kNoCone)) {
      offence_.require(squared == 0, "bounds",
                       "have a cone's axis of length {}, expected 0 without a cone",
                       std::sqrt(squared));
      return;
    }
    offence_.require(cutoff >= 0 && cutoff <= 1, "bounds",
                     "have a cone's cutoff of {}, expected 0 to 1, or 2 for none", cutoff);
    offence_.require(cluster_.two_sided == 0, "bounds",
                     "have a cone although the cluster is seen from both sides, expected none");
    offence_.require(std::abs(squared - 1) <= kAxisTolerance, "bounds",
                     "have a cone's axis of length {}, expected 1", std::sqrt(squared));
  }

  /// Finds the ranges of the coordinates, and checks that padding is 0.
  void checkVertices() {
    low_.fill(65535);
    high_.fill(0);
    for (std::size_t n = 0; n < cluster_.vertex_count; ++n) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint16_t value = stored(n, axis);
        low_[axis] = std::min(low_[axis], value);
        high_[axis] = std::max(high_[axis], value);
      }
    }
    std::uint32_t padding = 0;
    for (std::size_t n = cluster_.vertex_count; n < wholeLanes(cluster_.vertex_count); ++n) {
      for (std::size_t row = 0; row < kVertexRows; ++row) padding |= stored(n, row);
      if (!pools_.colors.empty()) padding |= pools_.colors[cluster_.first_vertex + n];
    }
    offence_.require(padding == 0, "vertices", "are not 0 in the padding behind the last of them");
  }

  void checkTriangles() {
    const std::size_t lanes = wholeLanes(cluster_.triangle_count);
    const auto corners =
        pools_.triangles.subspan(cluster_.first_triangle * kTriangleRows, lanes * kTriangleRows);
    const std::uint8_t most = *std::max_element(corners.begin(), corners.end());
    offence_.require(most < cluster_.vertex_count, "triangles",
                     "have corner {}, expected one of the {} vertices", most,
                     cluster_.vertex_count);
    std::uint32_t padding = 0;
    for (std::size_t n = cluster_.triangle_count; n < lanes; ++n) {
      for (std::size_t number = 0; number < kTriangleRows; ++number) padding |= corner(n, number);
    }
    offence_.require(padding == 0, "triangles", "are not 0 in the padding behind the last of them");
  }

  /// Checks that the boxes of the cluster and of its model contain all corners.
  void checkBoxes() {
    const double step = static_cast<double>(model_.step);
    const std::array<std::int32_t, 3> origin{cluster_.origin_x, cluster_.origin_y,
                                             cluster_.origin_z};
    const std::array<float, 3> model_low{model_.bounds_min.x, model_.bounds_min.y,
                                         model_.bounds_min.z};
    const std::array<float, 3> model_high{model_.bounds_max.x, model_.bounds_max.y,
                                          model_.bounds_max.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = step * (origin[axis] + low_[axis]);
      const double high = step * (origin[axis] + high_[axis]);
      const double center = bound(kCenterRow + axis);
      const double half = bound(kHalfExtentRow + axis);
      offence_.require(low >= center - half && high <= center + half, "bounds",
                       "reach from {} to {} m, expected around all vertices: {} to {} m",
                       center - half, center + half, low, high);
      offence_.require(low >= static_cast<double>(model_low[axis]) &&
                           high <= static_cast<double>(model_high[axis]),
                       "vertices", "reach from {} to {} m, expected within the model's {} to {} m",
                       low, high, model_low[axis], model_high[axis]);
    }
  }

  void checkSphere() {
    const double step = static_cast<double>(model_.step);
    double farthest = 0;
    for (std::size_t n = 0; n < cluster_.vertex_count; ++n) {
      const Point at = lattice(n);
      double squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double away = at[axis] * step - bound(kCenterRow + axis);
        squared += away * away;
      }
      farthest = std::max(farthest, squared);
    }
    const double radius = bound(kRadiusRow);
    offence_.require(radius >= 0 && farthest <= radius * radius, "bounds",
                     "have a radius of {} m, expected {} m, to the farthest vertex", radius,
                     std::sqrt(farthest));
  }

  /// Checks that the cone contains the normals of all triangles that have one.
  void checkCone() {
    const double cutoff = bound(kConeCutoffRow);
    if (cutoff == static_cast<double>(kNoCone)) return;
    const double least = std::sqrt(std::max(0.0, 1 - cutoff * cutoff)) - kConeTolerance;
    for (std::size_t n = 0; n < cluster_.triangle_count; ++n) {
      const Point a = lattice(corner(n, 0));
      const Point b = lattice(corner(n, 1));
      const Point c = lattice(corner(n, 2));
      const Point p{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      const Point q{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
      const Point normal{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2],
                         p[0] * q[1] - p[1] * q[0]};
      double along = 0;
      double squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        along += normal[axis] * bound(kConeAxisRow + axis);
        squared += normal[axis] * normal[axis];
      }
      if (along >= least * std::sqrt(squared)) continue;
      return offence_.require(false, "bounds", "have a cone of normals that triangle {} is not in",
                              n);
    }
  }

  const RenderCluster& cluster_;
  const RenderModel& model_;
  const RenderPools& pools_;
  const ClusterPlace& place_;
  Offence offence_;
  /// The ranges of the stored coordinates.
  std::array<std::uint16_t, 3> low_{};
  std::array<std::uint16_t, 3> high_{};
};

}  // namespace

Result<void> checkCluster(const RenderCluster& cluster, const RenderModel& model,
                          const RenderPools& pools, const ClusterPlace& place) {
  return ClusterChecker(cluster, model, pools, place).run();
}

}  // namespace galactic::detail
