#include "episodes/home/floor_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "episodes/home/columns_view.h"
#include "episodes/home/robot_body.h"
#include "galactic/simulation_options.h"

namespace galactic::bake {
namespace {

/// The highest step that the run's base takes both up and down, meters.
constexpr float kMostStep = std::min(GroundOptions{}.most_rise, GroundOptions{}.most_drop);

/// The headings adjacent to these.
std::uint16_t besideHeadings(std::uint16_t headings) {
  static_assert(kHeadings == 16);
  return static_cast<std::uint16_t>(std::rotl(headings, 1) | std::rotr(headings, 1));
}

/// The headings that a flood fill has reached.
struct Flood {
  explicit Flood(std::size_t places) : seen(places, 0), fresh(places, 0) {}

  /// Marks headings of a place that have not been seen before.
  void visit(std::uint32_t place, std::uint16_t headings) {
    seen[place] = static_cast<std::uint16_t>(seen[place] | headings);
    if (fresh[place] == 0) open.push_back(place);
    fresh[place] = static_cast<std::uint16_t>(fresh[place] | headings);
  }

  /// For each place: the headings seen, and those of them from which the fill has yet to continue.
  std::vector<std::uint16_t> seen;
  std::vector<std::uint16_t> fresh;
  /// Places with fresh headings.
  std::vector<std::uint32_t> open;
};

/// The connections between floor places.
class FloorGraph {
 public:
  FloorGraph(const std::vector<FloorPlace>& places, const std::vector<std::uint32_t>& first,
             const ColumnGrid& grid)
      : places_(places), first_(first), grid_(grid) {}

  /// Fills from one heading of a place; returns the number of headings reached, over all places.
  std::size_t fill(Flood& flood, std::uint32_t place, std::uint32_t heading) const {
    std::size_t reached = 0;
    flood.visit(place, static_cast<std::uint16_t>(1U << heading));
    while (!flood.open.empty()) {
      const std::uint32_t from = flood.open.back();
      flood.open.pop_back();
      const std::uint16_t headings = turnAt(flood, from);
      reached += static_cast<std::size_t>(std::popcount(headings));
      const FloorPlace& here = places_[from];
      const Arrival arrival{here.height, headings};
      if (here.i > 0) visitColumn(flood, arrival, here.i - 1, here.k);
      if (here.k > 0) visitColumn(flood, arrival, here.i, here.k - 1);
      if (here.i + 1 < grid_.columnsX()) visitColumn(flood, arrival, here.i + 1, here.k);
      if (here.k + 1 < grid_.columnsZ()) visitColumn(flood, arrival, here.i, here.k + 1);
    }
    return reached;
  }

 private:
  /// The robot as it comes from a neighboring place.
  struct Arrival {
    float height = 0;
    std::uint16_t headings = 0;
  };

  /// Takes the fresh headings of a place, and adds all to which the robot can turn from them there.
  std::uint16_t turnAt(Flood& flood, std::uint32_t place) const {
    std::uint16_t headings = std::exchange(flood.fresh[place], std::uint16_t{0});
    while (const std::uint16_t turned = unseen(flood, place, besideHeadings(headings))) {
      flood.seen[place] = static_cast<std::uint16_t>(flood.seen[place] | turned);
      headings = static_cast<std::uint16_t>(headings | turned);
    }
    return headings;
  }

  void visitColumn(Flood& flood, const Arrival& from, std::uint32_t i, std::uint32_t k) const {
    const std::size_t column = std::size_t{k} * grid_.columnsX() + i;
    for (std::uint32_t place = first_[column]; place < first_[column + 1]; ++place) {
      if (std::abs(places_[place].height - from.height) > kMostStep) continue;
      const std::uint16_t headings = unseen(flood, place, from.headings);
      if (headings != 0) flood.visit(place, headings);
    }
  }

  /// Those of the headings that are free and have not been seen.
  [[nodiscard]] std::uint16_t unseen(const Flood& flood, std::uint32_t place,
                                     std::uint16_t headings) const {
    return static_cast<std::uint16_t>(headings & places_[place].headings & ~flood.seen[place]);
  }

  const std::vector<FloorPlace>& places_;
  const std::vector<std::uint32_t>& first_;
  const ColumnGrid& grid_;
};

/// Places between which the robot can drive, represented by one of them.
struct FloorPart {
  std::uint32_t place = 0;
  std::uint32_t heading = 0;
  /// Number of headings of all its places.
  std::size_t size = 0;
};

/// The largest part, and those that are not much smaller, the largest first: storeys, but not
/// closets.
std::vector<FloorPart> largeParts(const FloorGraph& graph, const std::vector<FloorPlace>& places) {
  constexpr std::size_t kTimesSmaller = 5;
  std::vector<FloorPart> parts;
  Flood all(places.size());
  for (std::uint32_t place = 0; place < places.size(); ++place) {
    while (const auto left =
               static_cast<std::uint16_t>(places[place].headings & ~all.seen[place])) {
      const auto heading = static_cast<std::uint32_t>(std::countr_zero(left));
      parts.push_back({place, heading, graph.fill(all, place, heading)});
    }
  }
  std::ranges::stable_sort(parts, std::ranges::greater(), &FloorPart::size);
  std::erase_if(parts, [most = parts.empty() ? 0 : parts.front().size](const FloorPart& part) {
    return kTimesSmaller * part.size < most;
  });
  return parts;
}

/// The spheres of a body in the form that the batched queries of grids need, to be tested in many
/// places.
class BodyArrays {
 public:
  /// `spheres` must be ordered by radius, and not be empty.
  explicit BodyArrays(std::span<const BodySphere> spheres) : moved_(spheres.size()) {
    centers_.reserve(spheres.size());
    for (const BodySphere& sphere : spheres) {
      if (parts_.empty() || parts_.back().radius_index != sphere.radius_index) {
        parts_.push_back({sphere.radius_index, 0});
      }
      ++parts_.back().count;
      centers_.push_back(sphere.center);
    }
    blocked_.radius_index = parts_.front().radius_index;
  }

  /// Returns the same as isFree() for these spheres, moved by `offset`, but faster. Begins with the
  /// sphere that was blocked last, which is mostly blocked again at a nearby place.
  [[nodiscard]] bool isFreeAt(const Scene& scene, const Vec3& offset) {
    const ColumnGrid& grid = scene.grids()[blocked_.radius_index];
    if (grid.clearance(centers_[blocked_.sphere] + offset) != Clearance::kFree) return false;
    std::size_t first = 0;
    for (const Part& part : parts_) {
      for (std::size_t n = first; n < first + part.count; ++n) {
        const Vec3 center = centers_[n] + offset;
        moved_.x[n] = center.x;
        moved_.y[n] = center.y;
        moved_.z[n] = center.z;
      }
      const SphereCenters centers{.x = std::span(moved_.x).subspan(first, part.count),
                                  .y = std::span(moved_.y).subspan(first, part.count),
                                  .z = std::span(moved_.z).subspan(first, part.count)};
      const std::size_t blocked = scene.grids()[part.radius_index].firstNotFree(centers);
      if (blocked < part.count) {
        blocked_ = {part.radius_index, first + blocked};
        return false;
      }
      first += part.count;
    }
    return true;
  }

 private:
  /// Consecutive spheres of one radius.
  struct Part {
    std::uint32_t radius_index = 0;
    std::size_t count = 0;
  };
  struct Blocked {
    std::uint32_t radius_index = 0;
    std::size_t sphere = 0;
  };
  struct Arrays {
    explicit Arrays(std::size_t count) : x(count), y(count), z(count) {}
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
  };

  std::vector<Part> parts_;
  std::vector<Vec3> centers_;
  Blocked blocked_;
  Arrays moved_;
};

}  // namespace

std::uint32_t nearestHeading(float yaw) {
  constexpr float kPerRadian = static_cast<float>(kHeadings) / (2 * std::numbers::pi_v<float>);
  const auto steps = static_cast<std::int32_t>(std::lround(yaw * kPerRadian));
  constexpr auto kCount = static_cast<std::int32_t>(kHeadings);
  return static_cast<std::uint32_t>((steps % kCount + kCount) % kCount);
}

float yawOf(std::uint32_t heading) {
  constexpr float kStep = 2 * std::numbers::pi_v<float> / static_cast<float>(kHeadings);
  return kStep * static_cast<float>(heading);
}

FloorMap::FloorMap(const Scene& scene, const Robot& robot)
    : grid_(scene.grids().back()), fine_grid_(scene.grids().front()) {
  for (std::uint32_t k = 0; k < grid_.columnsZ(); ++k) {
    for (std::uint32_t i = 0; i < grid_.columnsX(); ++i) addPlaces(i, k);
  }
  tried_ = places_.size();
  std::vector<BodyArrays> at_origin;
  at_origin.reserve(kHeadings);
  for (std::uint32_t heading = 0; heading < kHeadings; ++heading) {
    at_origin.emplace_back(
        robotBody(robot, groundPose({}, yawOf(heading)), robot.startPositions()).spheres);
  }
  for (FloorPlace& place : places_) {
    const Vec3 ground = position(place);
    for (std::uint32_t heading = 0; heading < kHeadings; ++heading) {
      if (at_origin[heading].isFreeAt(scene, ground)) {
        place.headings = static_cast<std::uint16_t>(place.headings | (1U << heading));
      }
    }
  }
  std::erase_if(places_, [](const FloorPlace& place) { return place.headings == 0; });
  indexColumns();
  keepLargeParts();
}

void FloorMap::addPlaces(std::uint32_t i, std::uint32_t k) {
  std::optional<float> last;
  for (const Span& span : ColumnSpans(grid_, i, k)) {
    Vec3 center = columnCenter(grid_, i, k);
    center.y = span.lo;
    const std::optional<float> floor = floorUnder(center);
    // Two spans of the large sphere may lie in one span of the small sphere, above the same floor.
    if (!floor || floor == last) continue;
    places_.push_back({.i = i, .k = k, .height = *floor, .headings = 0, .part = 0});
    last = floor;
  }
}

/// Uses the smallest radius, since objects beside a small sphere do not hold it up.
std::optional<float> FloorMap::floorUnder(const Vec3& free_center) const {
  const Contact contact = fine_grid_.contact(free_center);
  if (contact.clearance != Clearance::kFree) return std::nullopt;
  return free_center.y - contact.down - fine_grid_.radius();
}

std::optional<float> FloorMap::heightAt(float x, float z, float height) const {
  const std::optional<ColumnIndex> column = fine_grid_.columnAt(x, z);
  if (!column) return std::nullopt;
  std::optional<float> nearest;
  for (const Span& span : ColumnSpans(fine_grid_, column->i, column->k)) {
    const float floor = span.lo - fine_grid_.radius();
    const float step = std::abs(floor - height);
    if (step <= kMostStep && (!nearest || step < std::abs(*nearest - height))) nearest = floor;
  }
  return nearest;
}

void FloorMap::indexColumns() {
  const std::size_t columns = std::size_t{grid_.columnsX()} * grid_.columnsZ();
  first_.assign(columns + 1, 0);
  for (const FloorPlace& place : places_) {
    ++first_[std::size_t{place.k} * grid_.columnsX() + place.i + 1];
  }
  for (std::size_t column = 0; column < columns; ++column) first_[column + 1] += first_[column];
}

void FloorMap::keepLargeParts() {
  const FloorGraph graph(places_, first_, grid_);
  std::vector<FloorPart> parts = largeParts(graph, places_);
  std::vector<Flood> floods;
  for (const FloorPart& part : parts) {
    graph.fill(floods.emplace_back(places_.size()), part.place, part.heading);
  }
  std::vector<FloorPlace> kept;
  for (std::size_t n = 0; n < places_.size(); ++n) {
    for (std::uint32_t part = 0; part < parts.size(); ++part) {
      FloorPlace place = places_[n];
      place.headings = floods[part].seen[n];
      place.part = part;
      if (place.headings != 0) kept.push_back(place);
    }
  }
  places_ = std::move(kept);
  parts_ = parts.size();
  indexColumns();
}

Vec3 FloorMap::position(const FloorPlace& place) const {
  Vec3 center = columnCenter(grid_, place.i, place.k);
  center.y = place.height;
  return center;
}

std::span<const FloorPlace> FloorMap::placesAt(float x, float z) const {
  const std::optional<ColumnIndex> column = grid_.columnAt(x, z);
  if (!column) return {};
  const std::size_t index = std::size_t{column->k} * grid_.columnsX() + column->i;
  return std::span(places_).subspan(first_[index], first_[index + 1] - first_[index]);
}

}  // namespace galactic::bake
