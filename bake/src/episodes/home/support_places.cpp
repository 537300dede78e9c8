#include "episodes/home/support_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "episodes/home/columns_view.h"

namespace galactic::bake {
namespace {

/// Spacing of the floor places that are looked at when a surface is tested for reach, meters: small
/// enough that the arm does not depend on the base being at a particular place.
constexpr float kFloorStride = 0.09F;

/// The free height above a surface of about this height in a column of the smallest radius: from
/// the surface to whatever is above it. None if there is no such surface.
std::optional<Span> freeOver(const ColumnGrid& grid, const ColumnIndex& column, float surface,
                             float flatness) {
  for (const Span& span : ColumnSpans(grid, column.i, column.k)) {
    const float height = span.lo - grid.radius();
    if (std::abs(height - surface) <= flatness) return Span{height, span.hi + grid.radius()};
  }
  return std::nullopt;
}

/// How far around a footprint the columns must be flat, meters, so that everything under the
/// footprint is. A column beside an edge still looks flat as long as the sphere on it sinks by no
/// more than `flatness`; the next column is a cell further.
float rimOf(const ColumnGrid& grid, float flatness) {
  return grid.spacing() + std::sqrt(2 * grid.radius() * flatness);
}

/// Finds floors from which the arm reaches a point.
class ReachTest {
 public:
  /// `heights` is the permitted range of the point's height above the floor.
  ReachTest(const Scene& scene, const Reachable& from, const DistanceRange& heights)
      : floor_(from.floor), reach_(from.reach), heights_(heights) {
    listWays(scene.grids().back().spacing());
    floor_heights_.reserve(floor_.places().size());
    for (const FloorPlace& place : floor_.places()) floor_heights_.push_back(place.height);
    std::sort(floor_heights_.begin(), floor_heights_.end());
  }

  /// A floor from which the arm reaches `point`, and above which `point` is at a permitted height;
  /// the first one in a fixed order. Null if there is none.
  [[nodiscard]] const FloorPlace* floorFor(const Vec3& point) const {
    if (!isOverAnyFloor(point)) return nullptr;
    for (const Way& way : ways_) {
      for (const FloorPlace& place : floor_.placesAt(point.x + way.dx, point.z + way.dz)) {
        const float height = point.y - place.height;
        if (height < heights_.least || height > heights_.most) continue;
        if (reach_.covers(way.length, height)) return &place;
      }
    }
    return nullptr;
  }

 private:
  /// Offset from the point to where the base may stand, meters.
  struct Way {
    float dx = 0;
    float dz = 0;
    float length = 0;
  };

  void listWays(float spacing) {
    const float stride = std::max(1.0F, std::floor(kFloorStride / spacing)) * spacing;
    const auto steps = static_cast<std::int32_t>(reach_.farthest() / stride);
    for (std::int32_t step_z = -steps; step_z <= steps; ++step_z) {
      for (std::int32_t step_x = -steps; step_x <= steps; ++step_x) {
        const float dx = static_cast<float>(step_x) * stride;
        const float dz = static_cast<float>(step_z) * stride;
        const float length = std::hypot(dx, dz);
        if (length <= reach_.farthest()) ways_.push_back({dx, dz, length});
      }
    }
  }

  /// Whether any floor, however far away, is as far below as `heights` requires. This excludes
  /// nearly all points of the floors themselves, which are the majority.
  [[nodiscard]] bool isOverAnyFloor(const Vec3& point) const {
    const auto lowest =
        std::partition_point(floor_heights_.begin(), floor_heights_.end(),
                             [&](float floor) { return point.y - floor > heights_.most; });
    return lowest != floor_heights_.end() && point.y - *lowest >= heights_.least;
  }

  const FloorMap& floor_;
  const ArmReach& reach_;
  DistanceRange heights_;
  /// In the order in which they are tried.
  std::vector<Way> ways_;
  /// Heights of all places of the floor map, ascending, meters.
  std::vector<float> floor_heights_;
};

/// The heights of the surfaces in a row of columns and in the adjacent rows, meters.
class SurfaceRows {
 public:
  explicit SurfaceRows(const ColumnGrid& grid) : grid_(grid) {
    for (Row& row : rows_) row.first.resize(grid.columnsX() + std::size_t{1});
    if (grid.columnsZ() > 0) read(0);
  }

  /// Makes row k the middle one; must be called with consecutive rows, from 0.
  void moveTo(std::uint32_t k) {
    middle_ = k;
    if (k + 1 < grid_.columnsZ()) read(k + 1);
  }

  /// Heights in column i of the middle row.
  [[nodiscard]] std::span<const float> heights(std::uint32_t i) const {
    return rowOf(middle_).heightsOf(i);
  }

  /// Whether column i of the middle row has eight neighbors, and it and all of them have a surface
  /// of about this height.
  [[nodiscard]] bool isFlatAround(std::uint32_t i, float surface, float flatness) const {
    if (i == 0 || middle_ == 0) return false;
    if (i + 1 >= grid_.columnsX() || middle_ + 1 >= grid_.columnsZ()) return false;
    const auto is_about = [&](float height) { return std::abs(height - surface) <= flatness; };
    for (std::uint32_t k = middle_ - 1; k <= middle_ + 1; ++k) {
      for (std::uint32_t column = i - 1; column <= i + 1; ++column) {
        if (!std::ranges::any_of(rowOf(k).heightsOf(column), is_about)) return false;
      }
    }
    return true;
  }

 private:
  struct Row {
    /// Index of the first height of each column, then the number of heights.
    std::vector<std::size_t> first;
    std::vector<float> heights;

    [[nodiscard]] std::span<const float> heightsOf(std::uint32_t i) const {
      return std::span(heights).subspan(first[i], first[i + 1] - first[i]);
    }
  };

  [[nodiscard]] const Row& rowOf(std::uint32_t k) const { return rows_[k % rows_.size()]; }

  void read(std::uint32_t k) {
    Row& row = rows_[k % rows_.size()];
    row.heights.clear();
    for (std::uint32_t i = 0; i < grid_.columnsX(); ++i) {
      row.first[i] = row.heights.size();
      for (const Span& span : ColumnSpans(grid_, i, k)) {
        row.heights.push_back(span.lo - grid_.radius());
      }
    }
    row.first.back() = row.heights.size();
  }

  const ColumnGrid& grid_;
  std::array<Row, 3> rows_;
  std::uint32_t middle_ = 0;
};

/// Numbers the surfaces that flat places belong to. Neighbors in a row or a column of the grid are
/// on the same surface if their heights are about equal. Joins them as the places are found, row by
/// row.
class SurfaceLabels {
 public:
  SurfaceLabels(std::uint32_t columns, float flatness)
      : flatness_(flatness), above_(columns + std::size_t{1}, 0), row_(above_) {}

  void beginColumn(std::uint32_t i, std::size_t count) { row_[i] = count; }

  /// Adds the last of `places`, which is in column `i`.
  void add(std::uint32_t i, const std::vector<SupportPlace>& places) {
    const auto index = static_cast<std::uint32_t>(places.size() - 1);
    parents_.push_back(index);
    if (i > 0) joinAny(places, row_[i - 1], row_[i]);
    if (has_above_) joinAny(places, above_[i], above_[i + 1]);
  }

  void endRow(std::size_t count) {
    row_.back() = count;
    above_ = row_;
    has_above_ = true;
  }

  [[nodiscard]] std::uint32_t labelOf(std::uint32_t place) const {
    while (parents_[place] != place) place = parents_[place];
    return place;
  }

 private:
  /// Joins the newest place with those of about its height among the places from `first` to before
  /// `last`.
  void joinAny(const std::vector<SupportPlace>& places, std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      if (std::abs(places[n].surface - places.back().surface) > flatness_) continue;
      const std::uint32_t a = shortened(static_cast<std::uint32_t>(n));
      const std::uint32_t b = shortened(static_cast<std::uint32_t>(places.size() - 1));
      parents_[std::max(a, b)] = std::min(a, b);
    }
  }

  /// The label of a place; shortens the path to it for later searches.
  std::uint32_t shortened(std::uint32_t place) {
    const std::uint32_t label = labelOf(place);
    while (parents_[place] != label) place = std::exchange(parents_[place], label);
    return label;
  }

  float flatness_;
  std::vector<std::uint32_t> parents_;
  /// Index of the first place of each column, then the number of places.
  std::vector<std::size_t> above_;
  std::vector<std::size_t> row_;
  bool has_above_ = false;
};

/// How far a surface may be below a receptacle's box, and above it, meters: boxes in datasets are
/// drawn by hand, and a run drops objects from inside them.
constexpr float kUnderRegion = 0.05F;
constexpr float kOverRegion = 0.02F;

}  // namespace

bool contains(const SupportRegion& region, const Vec3& point) {
  // Most points are far off, and no point of the box is further from its center than its corners.
  const Vec3 aside = point - region.world_from_region.translation;
  constexpr float kRounding = 1e-3F;
  const float reach = std::sqrt(dot(region.half_extents, region.half_extents)) + kRounding;
  if (std::max(std::abs(aside.x), std::abs(aside.z)) > reach) return false;
  const Pose region_from_world = inverse(region.world_from_region);
  const Vec3 from = region_from_world * Vec3{point.x, point.y - kOverRegion, point.z};
  const Vec3 way = rotate(region_from_world.rotation, {0, kOverRegion + kUnderRegion, 0});
  // The part of the segment between each pair of faces, as shares of its length.
  float first = 0;
  float last = 1;
  const auto clip = [&](float at, float along, float half) {
    if (along == 0) {
      if (std::abs(at) > half) last = -1;
      return;
    }
    const float a = (-half - at) / along;
    const float b = (half - at) / along;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  };
  clip(from.x, way.x, region.half_extents.x);
  clip(from.y, way.y, region.half_extents.y);
  clip(from.z, way.z, region.half_extents.z);
  return first <= last;
}

SupportPlaces::SupportPlaces(const Scene& scene, const Reachable& from,
                             std::span<const SupportRegion> receptacles,
                             const EpisodeGeneratorOptions& options)
    : scene_(&scene),
      receptacles_(receptacles),
      choice_(options.supports),
      flatness_(options.flatness) {
  const ReachTest test(scene, from, options.heights);
  for (SupportPlace& place : flatPlaces()) {
    const Vec3 point{place.x, place.surface, place.z};
    if (!isAllowed(point)) continue;
    const FloorPlace* floor = test.floorFor(point);
    if (floor == nullptr) continue;
    place.floor = floor->height;
    place.part = floor->part;
    if (choice_ == SupportChoice::kBoth && isInReceptacle(point)) {
      in_receptacles_.push_back(static_cast<std::uint32_t>(places_.size()));
    }
    places_.push_back(place);
  }
}

/// Includes places out of reach, so that a table whose middle no arm reaches is still one surface.
std::vector<SupportPlace> SupportPlaces::flatPlaces() const {
  const ColumnGrid& grid = scene_->grids().front();
  std::vector<SupportPlace> flat;
  SurfaceLabels labels(grid.columnsX(), flatness_);
  SurfaceRows surfaces(grid);
  for (std::uint32_t k = 0; k < grid.columnsZ(); ++k) {
    surfaces.moveTo(k);
    for (std::uint32_t i = 0; i < grid.columnsX(); ++i) {
      labels.beginColumn(i, flat.size());
      const Vec3 center = columnCenter(grid, i, k);
      for (const float height : surfaces.heights(i)) {
        if (!surfaces.isFlatAround(i, height, flatness_)) continue;
        flat.push_back({.x = center.x, .z = center.z, .surface = height});
        labels.add(i, flat);
      }
    }
    labels.endRow(flat.size());
  }
  for (std::uint32_t n = 0; n < flat.size(); ++n) flat[n].surface_id = labels.labelOf(n);
  return flat;
}

const SupportPlace& SupportPlaces::draw(Random& random) const {
  const auto any_of = [&random](std::size_t count) {
    return random.below(static_cast<std::uint32_t>(count));
  };
  if (!in_receptacles_.empty() && random.below(2) == 0) {
    return places_[in_receptacles_[any_of(in_receptacles_.size())]];
  }
  return places_[any_of(places_.size())];
}

std::size_t SupportPlaces::surfaceCount() const {
  std::vector<std::uint32_t> ids;
  ids.reserve(places_.size());
  for (const SupportPlace& place : places_) ids.push_back(place.surface_id);
  std::sort(ids.begin(), ids.end());
  return static_cast<std::size_t>(std::unique(ids.begin(), ids.end()) - ids.begin());
}

bool SupportPlaces::isAllowed(const Vec3& point) const {
  return choice_ != SupportChoice::kReceptacles || isInReceptacle(point);
}

bool SupportPlaces::isInReceptacle(const Vec3& point) const {
  return std::any_of(receptacles_.begin(), receptacles_.end(),
                     [&](const SupportRegion& region) { return contains(region, point); });
}

std::optional<float> SupportPlaces::surfaceUnder(const Footprint& footprint, float surface) const {
  const ColumnGrid& grid = scene_->grids().front();
  const float length = footprint.half_length + rimOf(grid, flatness_);
  const float width = footprint.half_width + rimOf(grid, flatness_);
  const float reach = std::hypot(length, width);
  const auto first = grid.columnAt(footprint.x - reach, footprint.z - reach);
  const auto last = grid.columnAt(footprint.x + reach, footprint.z + reach);
  if (!first || !last) return std::nullopt;
  float highest = surface;
  for (std::uint32_t k = first->k; k <= last->k; ++k) {
    for (std::uint32_t i = first->i; i <= last->i; ++i) {
      const Vec3 center = columnCenter(grid, i, k);
      const float dx = center.x - footprint.x;
      const float dz = center.z - footprint.z;
      if (std::abs(dx * footprint.along_x + dz * footprint.along_z) > length) continue;
      if (std::abs(dz * footprint.along_x - dx * footprint.along_z) > width) continue;
      const std::optional<Span> free = freeOver(grid, {i, k}, surface, flatness_);
      // The unevenness of the surface may lift the object.
      if (!free || free->hi < footprint.heights.hi + flatness_ + kHeadroom) return std::nullopt;
      highest = std::max(highest, free->lo);
    }
  }
  const ColumnGrid& shaft = scene_->grids().back();
  const float over = footprint.heights.hi + flatness_ + shaft.radius();
  const Contact contact = shaft.contact({footprint.x, over, footprint.z});
  if (contact.clearance != Clearance::kFree || contact.up < kApproachHeight) return std::nullopt;
  return highest;
}

}  // namespace galactic::bake
