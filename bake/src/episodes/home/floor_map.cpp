#include "episodes/home/floor_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "episodes/home/columns_view.h"
#include "episodes/home/robot_body.h"
#include "galactic/simulation_options.h"

namespace galactic::bake {
namespace {

constexpr std::uint32_t kNoPlace = 0xFFFFFFFF;
/// A step that the run's base takes in both directions, meters.
constexpr float kMostStep = std::min(GroundOptions{}.most_rise, GroundOptions{}.most_drop);

/// Which headings of which places have been seen by a flood fill.
struct Flood {
  struct State {
    std::uint32_t place = 0;
    std::uint32_t heading = 0;
  };

  explicit Flood(std::size_t places) : seen(places, 0) {}

  void visit(std::uint32_t place, std::uint32_t heading) {
    seen[place] = static_cast<std::uint16_t>(seen[place] | (1U << heading));
    open.push_back({place, heading});
  }

  std::vector<std::uint16_t> seen;
  std::vector<State> open;
};

bool hasHeading(std::uint16_t headings, std::uint32_t heading) {
  return ((std::uint32_t{headings} >> heading) & 1U) != 0;
}

/// Connections of floor places.
class FloorGraph {
 public:
  FloorGraph(const std::vector<FloorPlace>& places, const std::vector<std::uint32_t>& first,
             const ColumnGrid& grid)
      : places_(places), first_(first), grid_(grid) {}

  /// Fills from one heading of a place; returns how many states it reached.
  std::size_t fill(Flood& flood, std::uint32_t place, std::uint32_t heading) const {
    std::size_t reached = 0;
    flood.visit(place, heading);
    while (!flood.open.empty()) {
      const Flood::State state = flood.open.back();
      flood.open.pop_back();
      ++reached;
      tryVisit(flood, state.place, (state.heading + 1) % kHeadings);
      tryVisit(flood, state.place, (state.heading + kHeadings - 1) % kHeadings);
      const FloorPlace& here = places_[state.place];
      if (here.i > 0) visitColumn(flood, state, here.i - 1, here.k);
      if (here.k > 0) visitColumn(flood, state, here.i, here.k - 1);
      if (here.i + 1 < grid_.columnsX()) visitColumn(flood, state, here.i + 1, here.k);
      if (here.k + 1 < grid_.columnsZ()) visitColumn(flood, state, here.i, here.k + 1);
    }
    return reached;
  }

 private:
  void tryVisit(Flood& flood, std::uint32_t place, std::uint32_t heading) const {
    const bool free = hasHeading(places_[place].headings, heading);
    if (free && !hasHeading(flood.seen[place], heading)) flood.visit(place, heading);
  }

  void visitColumn(Flood& flood, const Flood::State& from, std::uint32_t i, std::uint32_t k) const {
    const std::size_t column = std::size_t{k} * grid_.columnsX() + i;
    for (std::uint32_t place = first_[column]; place < first_[column + 1]; ++place) {
      const float step = places_[place].height - places_[from.place].height;
      if (std::abs(step) <= kMostStep) tryVisit(flood, place, from.heading);
    }
  }

  const std::vector<FloorPlace>& places_;
  const std::vector<std::uint32_t>& first_;
  const ColumnGrid& grid_;
};

/// The spheres of a body as the batched queries of grids want them, to be tested in many places.
class BodyArrays {
 public:
  /// `spheres` are ordered by radius.
  explicit BodyArrays(std::span<const BodySphere> spheres) : moved_(spheres.size()) {
    centers_.reserve(spheres.size());
    for (const BodySphere& sphere : spheres) {
      if (parts_.empty() || parts_.back().radius_index != sphere.radius_index) {
        parts_.push_back({sphere.radius_index, 0});
      }
      ++parts_.back().count;
      centers_.push_back(sphere.center);
    }
  }

  /// The answer of isFree() for these spheres, moved by `offset`, found faster.
  [[nodiscard]] bool isFreeAt(const Scene& scene, const Vec3& offset) {
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
      if (scene.grids()[part.radius_index].firstNotFree(centers) < part.count) return false;
      first += part.count;
    }
    return true;
  }

 private:
  /// Spheres of one radius, one after the other.
  struct Part {
    std::uint32_t radius_index = 0;
    std::size_t count = 0;
  };
  struct Arrays {
    explicit Arrays(std::size_t count) : x(count), y(count), z(count) {}
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> z;
  };

  std::vector<Part> parts_;
  std::vector<Vec3> centers_;
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
  keepLargestPart();
}

void FloorMap::addPlaces(std::uint32_t i, std::uint32_t k) {
  std::optional<float> last;
  for (const Span& span : spansOf(grid_, i, k)) {
    Vec3 center = columnCenter(grid_, i, k);
    center.y = span.lo;
    const std::optional<float> floor = floorUnder(center);
    // Two spans of the large sphere may lie in one of the small one, over one floor.
    if (!floor || floor == last) continue;
    places_.push_back({.i = i, .k = k, .height = *floor, .headings = 0});
    last = floor;
  }
}

/// As the smallest radius sees it: a small sphere is not held up by what stands beside it.
std::optional<float> FloorMap::floorUnder(const Vec3& free_center) const {
  const Contact contact = fine_grid_.contact(free_center);
  if (contact.clearance != Clearance::kFree) return std::nullopt;
  return free_center.y - contact.down - fine_grid_.radius();
}

std::optional<float> FloorMap::heightAt(float x, float z, float height) const {
  const std::optional<Column> column = columnAt(fine_grid_, x, z);
  if (!column) return std::nullopt;
  std::optional<float> nearest;
  for (const Span& span : spansOf(fine_grid_, column->i, column->k)) {
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

void FloorMap::keepLargestPart() {
  const FloorGraph graph(places_, first_, grid_);
  Flood all(places_.size());
  std::size_t most = 0;
  Flood::State seed{kNoPlace, 0};
  for (std::uint32_t place = 0; place < places_.size(); ++place) {
    for (std::uint32_t heading = 0; heading < kHeadings; ++heading) {
      if (!hasHeading(places_[place].headings, heading)) continue;
      if (hasHeading(all.seen[place], heading)) continue;
      const std::size_t reached = graph.fill(all, place, heading);
      if (reached <= most) continue;
      most = reached;
      seed = {place, heading};
    }
  }
  if (seed.place == kNoPlace) return;
  Flood largest(places_.size());
  graph.fill(largest, seed.place, seed.heading);
  for (std::size_t n = 0; n < places_.size(); ++n) places_[n].headings = largest.seen[n];
  std::erase_if(places_, [](const FloorPlace& place) { return place.headings == 0; });
  indexColumns();
}

Vec3 FloorMap::position(const FloorPlace& place) const {
  Vec3 center = columnCenter(grid_, place.i, place.k);
  center.y = place.height;
  return center;
}

std::span<const FloorPlace> FloorMap::placesAt(float x, float z) const {
  const std::optional<Column> column = columnAt(grid_, x, z);
  if (!column) return {};
  const std::size_t index = std::size_t{column->k} * grid_.columnsX() + column->i;
  return std::span(places_).subspan(first_[index], first_[index + 1] - first_[index]);
}

}  // namespace galactic::bake
