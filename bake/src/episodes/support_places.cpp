#include "episodes/support_places.h"

#include <algorithm>
#include <cmath>

namespace galactic::bake {
namespace {

/// How far apart the floor places are looked at when a surface is tested for reach, metres: less
/// than what the arm reaches without the base being anywhere special.
constexpr float kFloorStride = 0.09F;

/// The free height over a surface of about this height in a column of the smallest radius: from the
/// surface to what is over it. None where there is no such surface.
std::optional<Span> freeOver(const ColumnGrid& grid, const Column& column, float surface) {
  for (const Span& span : spansOf(grid, column.i, column.k)) {
    const float height = span.lo - grid.radius();
    if (std::abs(height - surface) <= kFlatness) return Span{height, span.hi + grid.radius()};
  }
  return std::nullopt;
}

/// How far around a footprint the columns have to be flat, metres, so that nothing under it is not:
/// a column beside an edge still looks flat where the sphere on it sinks by no more than kFlatness,
/// and the next one is a cell further.
float rimOf(const ColumnGrid& grid) {
  return grid.spacing() + std::sqrt(2 * grid.radius() * kFlatness);
}

/// Finds floors from which the arm reaches a point.
class ReachTest {
 public:
  ReachTest(const Scene& scene, const FloorMap& floor, const ArmReach& reach)
      : floor_(floor), reach_(reach) {
    const float spacing = scene.grids().back().spacing();
    stride_ = std::max(1.0F, std::floor(kFloorStride / spacing)) * spacing;
  }

  /// The height of a floor from which the arm reaches `point`, and over which `point` is between
  /// the heights of the options; the first one in a fixed order.
  [[nodiscard]] std::optional<float> floorFor(const Vec3& point,
                                              const EpisodeSamplerOptions& options) const {
    const auto steps = static_cast<std::int32_t>(reach_.farthest() / stride_);
    for (std::int32_t step_z = -steps; step_z <= steps; ++step_z) {
      for (std::int32_t step_x = -steps; step_x <= steps; ++step_x) {
        const float dx = static_cast<float>(step_x) * stride_;
        const float dz = static_cast<float>(step_z) * stride_;
        for (const FloorPlace& place : floor_.placesAt(point.x + dx, point.z + dz)) {
          const float height = point.y - place.height;
          if (height < options.lowest || height > options.highest) continue;
          if (reach_.covers(std::hypot(dx, dz), height)) return place.height;
        }
      }
    }
    return std::nullopt;
  }

 private:
  const FloorMap& floor_;
  const ArmReach& reach_;
  float stride_ = 0;
};

}  // namespace

SupportPlaces::SupportPlaces(const Scene& scene, const FloorMap& floor, const ArmReach& reach,
                             const EpisodeSamplerOptions& options)
    : scene_(&scene) {
  const ColumnGrid& grid = scene.grids().front();
  const ReachTest test(scene, floor, reach);
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      for (const Span& span : spansOf(grid, i, k)) {
        Vec3 point = columnCentre(grid, i, k);
        point.y = span.lo - grid.radius();
        if (!isFlatAround({i, k}, point.y)) continue;
        const std::optional<float> from = test.floorFor(point, options);
        if (from) {
          places_.push_back({.x = point.x, .z = point.z, .surface = point.y, .floor = *from});
        }
      }
    }
  }
}

bool SupportPlaces::isFlatAround(const Column& column, float surface) const {
  const ColumnGrid& grid = scene_->grids().front();
  if (column.i == 0 || column.k == 0) return false;
  if (column.i + 1 >= grid.columnsX() || column.k + 1 >= grid.columnsZ()) return false;
  for (std::uint32_t k = column.k - 1; k <= column.k + 1; ++k) {
    for (std::uint32_t i = column.i - 1; i <= column.i + 1; ++i) {
      if (!freeOver(grid, {i, k}, surface)) return false;
    }
  }
  return true;
}

std::optional<float> SupportPlaces::surfaceUnder(const Footprint& footprint, float surface) const {
  const ColumnGrid& grid = scene_->grids().front();
  const float length = footprint.half_length + rimOf(grid);
  const float width = footprint.half_width + rimOf(grid);
  const float reach = std::hypot(length, width);
  const auto first = columnAt(grid, footprint.x - reach, footprint.z - reach);
  const auto last = columnAt(grid, footprint.x + reach, footprint.z + reach);
  if (!first || !last) return std::nullopt;
  float highest = surface;
  for (std::uint32_t k = first->k; k <= last->k; ++k) {
    for (std::uint32_t i = first->i; i <= last->i; ++i) {
      const Vec3 centre = columnCentre(grid, i, k);
      const float dx = centre.x - footprint.x;
      const float dz = centre.z - footprint.z;
      if (std::abs(dx * footprint.along_x + dz * footprint.along_z) > length) continue;
      if (std::abs(dz * footprint.along_x - dx * footprint.along_z) > width) continue;
      const std::optional<Span> free = freeOver(grid, {i, k}, surface);
      // The object may be lifted by the unevenness of the surface.
      if (!free || free->hi < footprint.heights.hi + kFlatness + kHeadroom) return std::nullopt;
      highest = std::max(highest, free->lo);
    }
  }
  const ColumnGrid& shaft = scene_->grids().back();
  const float over = footprint.heights.hi + kFlatness + shaft.radius();
  const Contact contact = shaft.contact({footprint.x, over, footprint.z});
  if (contact.clearance != Clearance::kFree || contact.up < kApproachHeight) return std::nullopt;
  return highest;
}

}  // namespace galactic::bake
