#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "column_grid/column_at.h"
#include "column_grid/standing_room.h"
#include "galactic/bake/columns.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Disjoint sets over span indices; the smallest index of a set is its root.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t root(std::uint32_t element) {
    while (parent_[element] != element) {
      parent_[element] = parent_[parent_[element]];
      element = parent_[element];
    }
    return element;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t root_a = root(a);
    const std::uint32_t root_b = root(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

void joinColumns(const Columns& columns, std::size_t a, std::size_t b, DisjointSets& sets) {
  std::uint32_t span_a = columns.first[a];
  std::uint32_t span_b = columns.first[b];
  while (span_a < columns.first[a + 1] && span_b < columns.first[b + 1]) {
    const Span& in_a = columns.spans[span_a];
    const Span& in_b = columns.spans[span_b];
    if (std::min(in_a.hi, in_b.hi) > std::max(in_a.lo, in_b.lo)) sets.join(span_a, span_b);
    if (in_a.hi < in_b.hi) {
      ++span_a;
    } else {
      ++span_b;
    }
  }
}

/// The component of every span, numbered in the order of their first spans.
struct Labels {
  std::vector<std::uint32_t> of_span;
  std::uint32_t count = 0;
};

Labels labelComponents(const Columns& columns) {
  const GridFrame& frame = columns.frame;
  DisjointSets sets(columns.spans.size());
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      const std::size_t at = columns.index(i, k);
      if (i > 0) joinColumns(columns, at - 1, at, sets);
      if (k > 0) joinColumns(columns, at - frame.columns_x, at, sets);
    }
  }
  Labels labels;
  labels.of_span.resize(columns.spans.size());
  for (std::uint32_t span = 0; span < columns.spans.size(); ++span) {
    const std::uint32_t root = sets.root(span);
    labels.of_span[span] = root == span ? labels.count++ : labels.of_span[root];
  }
  return labels;
}

/// Least floor of a room: the area in which a robot could stand, square meters.
constexpr double kLeastFloor = 4;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Length of the part of a span that lies within `heights`.
double overlap(const Span& span, const Span& heights) {
  return std::max(0.0, static_cast<double>(std::min(span.hi, heights.hi)) -
                           static_cast<double>(std::max(span.lo, heights.lo)));
}

/// Length of the part of a span that lies within the scene's heights.
double overlap(const Span& span, const Bounds& scene) {
  return overlap(span, Span{scene.min.y, scene.max.y});
}

/// Whether a column within the scene's bounds lies at their edge in the ground plane.
bool isAtEdge(float x, float z, const Bounds& scene, float spacing) {
  return x - scene.min.x < spacing || scene.max.x - x < spacing || z - scene.min.z < spacing ||
         scene.max.z - z < spacing;
}

/// The properties of a column that its spans share.
struct ColumnPlace {
  float x = 0;
  float z = 0;
  /// Square meters.
  double area = 0;
  /// At the border of the grid.
  bool is_at_border = false;
  bool is_in_scene = false;
  /// At the edge of the scene's bounds.
  bool is_at_edge = false;
};

ColumnPlace placeOf(const GridFrame& frame, const Bounds& scene, std::uint32_t i, std::uint32_t k) {
  ColumnPlace place;
  place.x = static_cast<float>(frame.centerX(i));
  place.z = static_cast<float>(frame.centerZ(k));
  place.area = static_cast<double>(frame.spacing) * static_cast<double>(frame.spacing);
  place.is_at_border = i == 0 || k == 0 || i + 1 == frame.columns_x || k + 1 == frame.columns_z;
  place.is_in_scene = place.x >= scene.min.x && place.x <= scene.max.x && place.z >= scene.min.z &&
                      place.z <= scene.max.z;
  place.is_at_edge = place.is_in_scene && isAtEdge(place.x, place.z, scene, frame.spacing);
  return place;
}

void addSpan(const Span& span, const ColumnPlace& place, const Bounds& scene,
             Component& component) {
  component.touches_border = component.touches_border || place.is_at_border;
  ++component.spans;
  component.greatest_height = std::max(component.greatest_height, span.hi - span.lo);
  component.volume += place.area * (static_cast<double>(span.hi) - static_cast<double>(span.lo));
  const double inside = place.is_in_scene ? place.area * overlap(span, scene) : 0;
  component.volume_inside += inside;
  if (span.hi > scene.max.y) component.volume_open_above += inside;
  if (span.lo < scene.min.y) component.volume_open_below += inside;
  if (place.is_at_edge && overlap(span, scene) > 0) ++component.columns_at_edge;
  Bounds& bounds = component.bounds;
  bounds.min = {std::min(bounds.min.x, place.x), std::min(bounds.min.y, span.lo),
                std::min(bounds.min.z, place.z)};
  bounds.max = {std::max(bounds.max.x, place.x), std::max(bounds.max.y, span.hi),
                std::max(bounds.max.z, place.z)};
}

std::vector<Component> measure(const Columns& columns, const Labels& labels) {
  const GridFrame& frame = columns.frame;
  Component empty;
  empty.bounds = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  std::vector<Component> components(labels.count, empty);
  const Bounds scene = sceneBounds(frame);
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      const ColumnPlace place = placeOf(frame, scene, i, k);
      const std::size_t at = columns.index(i, k);
      for (std::uint32_t span = columns.first[at]; span < columns.first[at + 1]; ++span) {
        addSpan(columns.spans[span], place, scene, components[labels.of_span[span]]);
      }
    }
  }
  const std::vector<StandingRoom> rooms = standingRoom(columns, labels.of_span, labels.count);
  for (std::size_t n = 0; n < components.size(); ++n) {
    Component& component = components[n];
    // Walls make a room even without a ceiling. Otherwise, what is under the sky is outside.
    const bool is_walled = component.columns_at_edge == 0;
    component.floor = rooms[n].roofed + (is_walled ? rooms[n].open : 0);
    component.yard = is_walled ? 0 : rooms[n].open;
  }
  return components;
}

/// Whether `first` is more likely to be the room than `second`.
bool isRather(const Component& first, const Component& second) {
  const auto floor = [](const Component& of) { return of.floor < kLeastFloor ? 0 : of.floor; };
  if (floor(first) != floor(second)) return floor(first) > floor(second);
  if (first.isSlab() != second.isSlab()) return second.isSlab();
  if (first.volume_inside != second.volume_inside) {
    return first.volume_inside > second.volume_inside;
  }
  return first.volume > second.volume;
}

tl::unexpected<Error> seedFailure(const Vec3& seed, const GridFrame& frame,
                                  const std::string& finding) {
  return fail(ErrorCode::kInvalidInput, "`inside`",
              fmt::format("({}, {}, {}) is {} for radius {} m; give a point where a sphere of that "
                          "radius fits, in meters with y up",
                          seed.x, seed.y, seed.z, finding, frame.radius));
}

/// Index of the span that holds `seed`.
Result<std::uint32_t> spanAt(const Columns& columns, const Vec3& seed) {
  const GridFrame& frame = columns.frame;
  const std::optional<std::size_t> found = columnAt(columns, seed);
  // Between the scene and the grid's border, there is no room.
  const Bounds scene = sceneBounds(frame);
  const bool in_scene = seed.x >= scene.min.x && seed.x <= scene.max.x && seed.z >= scene.min.z &&
                        seed.z <= scene.max.z;
  if (!found || !in_scene) return seedFailure(seed, frame, "outside the scene");
  const std::size_t at = *found;
  for (std::uint32_t span = columns.first[at]; span < columns.first[at + 1]; ++span) {
    if (seed.y >= columns.spans[span].lo && seed.y <= columns.spans[span].hi) return span;
  }
  std::string free = "blocked";
  for (const Span& span : columns.column(at)) {
    free += fmt::format("{} {:.3f} to {:.3f} m", free == "blocked" ? " (free there:" : ",", span.lo,
                        span.hi);
  }
  if (free != "blocked") free += ")";
  return seedFailure(seed, frame, free);
}

/// For each component, the share of its spans' length within the scene's heights that is also in
/// `room`, in the nearest columns. A scene without height, such as a floor, contains no spans, so
/// the heights of the grid of `room` are used instead.
std::vector<double> sharesIn(const Columns& columns, const Labels& labels, const Columns& room) {
  const GridFrame& frame = columns.frame;
  const GridFrame& other = room.frame;
  const Bounds scene = sceneBounds(frame);
  const Span compared = scene.max.y > scene.min.y ? Span{scene.min.y, scene.max.y} : other.heights;
  std::vector<double> all(labels.count);
  std::vector<double> inside(labels.count);
  for (std::uint32_t k = 0; k < frame.columns_z; ++k) {
    const std::uint32_t other_k =
        nearestCell(frame.centerZ(k), other.min_z, other.spacing, other.columns_z);
    for (std::uint32_t i = 0; i < frame.columns_x; ++i) {
      const std::uint32_t other_i =
          nearestCell(frame.centerX(i), other.min_x, other.spacing, other.columns_x);
      const std::size_t at = columns.index(i, k);
      for (std::uint32_t span = columns.first[at]; span < columns.first[at + 1]; ++span) {
        const Span& heights = columns.spans[span];
        all[labels.of_span[span]] += overlap(heights, compared);
        for (const Span& free : room.column(room.index(other_i, other_k))) {
          const Span both{std::max(free.lo, heights.lo), std::min(free.hi, heights.hi)};
          if (both.hi > both.lo) inside[labels.of_span[span]] += overlap(both, compared);
        }
      }
    }
  }
  for (std::uint32_t n = 0; n < labels.count; ++n) inside[n] = all[n] > 0 ? inside[n] / all[n] : 0;
  return inside;
}

/// Which components belong to the room.
Result<std::vector<bool>> chooseRooms(const Columns& columns, const Labels& labels,
                                      const std::vector<Component>& components,
                                      const FreeSpaceOptions& options, const Columns* wider_room) {
  std::vector<bool> is_room(components.size(), false);
  if (!options.seeds.empty()) {
    for (const Vec3& seed : options.seeds) {
      ASSIGN_OR_RETURN(const auto span, spanAt(columns, seed));
      is_room[labels.of_span[span]] = true;
    }
    return is_room;
  }
  std::vector<std::uint32_t> order(components.size());
  std::iota(order.begin(), order.end(), 0U);
  if (wider_room != nullptr) {
    const std::vector<double> shares = sharesIn(columns, labels, *wider_room);
    std::erase_if(order, [&](std::uint32_t n) { return shares[n] < 0.5; });
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return isRather(components[a], components[b]);
  });
  const std::size_t rooms = std::min<std::size_t>(options.components, order.size());
  for (std::size_t rank = 0; rank < rooms; ++rank) is_room[order[rank]] = true;
  return is_room;
}

Columns roomOf(const Columns& columns, const Labels& labels,
               const std::vector<Component>& components) {
  Columns kept;
  kept.frame = columns.frame;
  kept.first.reserve(columns.first.size());
  kept.first.push_back(0);
  for (std::size_t at = 0; at + 1 < columns.first.size(); ++at) {
    for (std::uint32_t span = columns.first[at]; span < columns.first[at + 1]; ++span) {
      if (components[labels.of_span[span]].region == Region::kRoom) {
        kept.spans.push_back(columns.spans[span]);
      }
    }
    kept.first.push_back(static_cast<std::uint32_t>(kept.spans.size()));
  }
  return kept;
}

}  // namespace

Result<FreeSpace> chooseFreeSpace(const Columns& columns, const FreeSpaceOptions& options,
                                  const Columns* wider_room) {
  const Labels labels = labelComponents(columns);
  std::vector<Component> components = measure(columns, labels);
  ASSIGN_OR_RETURN(const auto is_room,
                   chooseRooms(columns, labels, components, options, wider_room));
  FreeSpace result;
  for (std::size_t index = 0; index < components.size(); ++index) {
    Component& component = components[index];
    component.region = is_room[index]             ? Region::kRoom
                       : component.touches_border ? Region::kOutside
                                                  : Region::kEnclosed;
    RegionTotals& totals = result.totals[static_cast<std::size_t>(component.region)];
    ++totals.components;
    totals.spans += component.spans;
    totals.volume += component.volume;
  }
  Columns room = roomOf(columns, labels, components);
  if (options.keep == Keep::kAll) {
    result.columns = columns;
    result.room_of_all = std::move(room);
  } else {
    result.columns = std::move(room);
  }
  std::stable_sort(components.begin(), components.end(),
                   [](const Component& a, const Component& b) { return a.volume > b.volume; });
  result.components = std::move(components);
  return result;
}

}  // namespace galactic::bake
