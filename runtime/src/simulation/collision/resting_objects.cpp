#include "simulation/collision/resting_objects.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>

#include "column_grid/column_grid_kernels.h"

namespace galactic::simulation {
namespace {

/// Objects are entered in sets that they miss by this much, so that no rounding of a query can find
/// an overlap that the sets do not know: meters, and parts of a coordinate.
constexpr float kSlack = 1e-4F;
constexpr float kRelativeSlack = 1e-6F;

/// Coordinates from here on, in squares, are not told apart.
constexpr float kMostSquares = 0x1p30F;

std::size_t planesFor(std::size_t objects) { return (objects + kPlaneObjects - 1) / kPlaneObjects; }

std::uint32_t bitOf(std::uint32_t index) { return 1U << (index % kPlaneObjects); }

/// Number of the square that a coordinate is in; none where it is too large, or NaN. The kernel for
/// AVX2 does the same.
std::optional<std::int32_t> squareOf(float coordinate) {
  const float square = coordinate * kInverseSquareEdge;
  if (!(std::fabs(square) < kMostSquares)) return std::nullopt;
  return static_cast<std::int32_t>(std::lrint(square));
}

/// Index of the set of square `n` among `count` sets.
std::uint32_t setOf(std::int32_t n, std::uint32_t count) {
  return static_cast<std::uint32_t>(n) % count;
}

/// Index of the set that a query reads.
std::uint32_t setOf(float coordinate, std::uint32_t count) {
  return setOf(squareOf(coordinate).value_or(0), count);
}

/// Where an object is along one axis.
struct Reach {
  float center = 0;
  float half = 0;
};

/// Calls `change` with the sets of all squares that some query from `center - reach` to
/// `center + reach` may fall in. The first sets may follow once more after the `count` sets.
template <class Change>
void forEachSet(std::span<std::uint32_t> sets, std::uint32_t count, const Reach& reach,
                const Change& change) {
  const auto [center, half] = reach;
  const float around = half + kSlack + kRelativeSlack * (std::fabs(center) + half);
  const std::optional<std::int32_t> first = squareOf(center - around);
  const std::optional<std::int32_t> last = squareOf(center + around);
  if (!first || !last || *last - *first >= static_cast<std::int32_t>(count)) {
    for (std::uint32_t& set : sets) change(set);
    return;
  }
  for (std::int32_t n = *first; n <= *last; ++n) {
    const std::uint32_t set = setOf(n, count);
    change(sets[set]);
    if (set + count < sets.size()) change(sets[set + count]);
  }
}

/// The objects in the first of eight sets, and in so many further ones; in none where there are
/// less than none. Always reads all: no branch depends on the number.
std::uint32_t inRun(const std::uint32_t* sets, std::int32_t further) {
  static_assert(kRun == 8);
  using Four = std::int32_t __attribute__((vector_size(16)));
  Four first;
  Four last;
  std::memcpy(&first, sets, sizeof(first));
  std::memcpy(&last, sets + 4, sizeof(last));
  const Four ends{further, further, further, further};
  const Four all = (first & (Four{0, 1, 2, 3} <= ends)) | (last & (Four{4, 5, 6, 7} <= ends));
  return static_cast<std::uint32_t>(all[0] | all[1] | all[2] | all[3]);
}

/// The objects in the strips of any center from `least` to `most`.
std::uint32_t inAnyStrip(const std::uint32_t* strips, float least, float most) {
  const std::optional<std::int32_t> first = squareOf(least);
  const std::optional<std::int32_t> last = squareOf(most);
  if (!first || !last || *last - *first >= static_cast<std::int32_t>(kStrips)) {
    return ~std::uint32_t{0};
  }
  const std::int32_t further = *last - *first;
  if (further < static_cast<std::int32_t>(kRun)) {
    return inRun(strips + setOf(*first, kStrips), further);
  }
  std::uint32_t any = 0;
  for (std::int32_t n = *first; n <= *last; ++n) any |= strips[setOf(n, kStrips)];
  return any;
}

/// All bits: the objects of every height.
constexpr std::uint32_t kAnyHeight = ~std::uint32_t{0};

/// Calls `visit` with the index of each object in the sets of a sphere, ascending, until it returns
/// true; whether it did. `every_height`: also those above and below it.
template <class Visit>
bool anyNear(const RestingView& objects, const Vec3& center, bool every_height,
             const Visit& visit) {
  const std::uint32_t strip_x = setOf(center.x, kStrips);
  const std::uint32_t strip_z = setOf(center.z, kStrips);
  const std::uint32_t band = setOf(center.y, kBands);
  for (std::size_t p = 0; p < objects.plane_count; ++p) {
    const SetPlane& plane = objects.planes[p];
    std::uint32_t near = plane.along_x[strip_x] & plane.along_z[strip_z] &
                         (every_height ? kAnyHeight : plane.at_height[band]);
    for (; near != 0; near &= near - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(near));
      if (visit(static_cast<std::uint32_t>(p) * kPlaneObjects + bit)) return true;
    }
  }
  return false;
}

/// The objects at any height over, under or around a sphere.
template <class Visit>
void forEachInColumn(const RestingView& objects, const Vec3& center, const Visit& visit) {
  anyNear(objects, center, true, [&visit](std::uint32_t index) {
    visit(index);
    return false;
  });
}

/// The objects that overlap a sphere, ascending, to `visit` as in anyNear.
template <class Visit>
bool anyOverlapping(const RestingView& objects, const Vec3& center, float radius,
                    const Visit& visit) {
  return anyNear(objects, center, false, [&](std::uint32_t index) {
    const RestingBox& box = objects.boxes[index];
    // The kernel for AVX2 asks for the heights first, too: no answer depends on it.
    return std::fabs(center.y - box.center.y) < box.half_height + radius &&
           overlaps(box, center, radius) && visit(index);
  });
}

unsigned touchingLanes(const RestingView& objects, const SphereBatch& spheres, std::size_t first,
                       float radius) {
  const auto found = [](std::uint32_t) { return true; };
  unsigned lanes = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::size_t n = first + lane;
    const Vec3 center{spheres.x[n], spheres.y[n], spheres.z[n]};
    const bool touches = anyOverlapping(objects, center, radius, found);
    lanes |= static_cast<unsigned>(touches) << lane;
  }
  return lanes;
}

bool findTouching(const RestingView& objects, const SphereBatch& spheres, LaneGroup& at) {
  return detail::hasAvx2() ? findTouchingAvx2(objects, spheres, at)
                           : findTouchingPortable(objects, spheres, at);
}

/// What the caller of a query guarantees.
[[maybe_unused]] bool radiiFit(const SphereBatch& spheres, float largest_radius) {
  return std::all_of(spheres.ranges.begin(), spheres.ranges.end(),
                     [=](const RadiusRange& range) { return range.radius <= largest_radius; });
}

}  // namespace

bool findTouchingPortable(const RestingView& objects, const SphereBatch& spheres,
                          LaneGroup& at) noexcept {
  for (; at.range < spheres.ranges.size(); ++at.range, at.group = 0) {
    const RadiusRange& range = spheres.ranges[at.range];
    for (; at.group * kLanes < range.count; ++at.group) {
      at.lanes = touchingLanes(objects, spheres, range.first + at.group * kLanes, range.radius);
      if (at.lanes != 0) return true;
    }
  }
  return false;
}

RestingObjects::RestingObjects(std::size_t most_objects, float largest_radius,
                               std::pmr::memory_resource* memory)
    : largest_radius_(largest_radius),
      planes_(planesFor(most_objects), memory),
      boxes_(most_objects, memory),
      resting_(planes_.size(), memory) {}

std::uint32_t RestingObjects::bandOf(float y) noexcept { return setOf(y, kBands); }

std::uint32_t RestingObjects::inColumnOf(const Vec3& center, std::size_t plane) const noexcept {
  return planes_[plane].along_x[setOf(center.x, kStrips)] &
         planes_[plane].along_z[setOf(center.z, kStrips)];
}

void RestingObjects::clear() noexcept {
  std::fill(planes_.begin(), planes_.end(), SetPlane{});
  std::fill(resting_.begin(), resting_.end(), 0U);
}

template <class Change>
void RestingObjects::changeSets(std::uint32_t index, const Change& change) noexcept {
  const RestingBox& box = boxes_[index];
  const Vec3 half = halfBounds(box);
  const float radius = largest_radius_;
  SetPlane& plane = planes_[index / kPlaneObjects];
  forEachSet(plane.along_x, kStrips, {box.center.x, half.x + radius}, change);
  forEachSet(plane.along_z, kStrips, {box.center.z, half.z + radius}, change);
  forEachSet(plane.at_height, kBands, {box.center.y, half.y + radius}, change);
}

void RestingObjects::insert(std::uint32_t index, const RestingBox& box) noexcept {
  assert(index < boxes_.size() && !isResting(index));
  boxes_[index] = box;
  const std::uint32_t bit = bitOf(index);
  resting_[index / kPlaneObjects] |= bit;
  changeSets(index, [bit](std::uint32_t& set) { set |= bit; });
}

void RestingObjects::remove(std::uint32_t index) noexcept {
  assert(isResting(index));
  const std::uint32_t bit = bitOf(index);
  resting_[index / kPlaneObjects] &= ~bit;
  changeSets(index, [bit](std::uint32_t& set) { set &= ~bit; });
}

bool RestingObjects::isResting(std::uint32_t index) const noexcept {
  assert(index < boxes_.size());
  return (resting_[index / kPlaneObjects] & bitOf(index)) != 0;
}

RestingView RestingObjects::view() const noexcept {
  return {planes_.data(), planes_.size(), boxes_.data()};
}

bool RestingObjects::touches(const SphereBatch& spheres) const noexcept {
  assert(radiiFit(spheres, largest_radius_));
  LaneGroup at;
  return findTouching(view(), spheres, at);
}

bool RestingObjects::mayTouch(const Vec3& least, const Vec3& most) const noexcept {
  bool may = false;
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    const std::uint32_t near = inAnyStrip(planes_[p].along_x, least.x, most.x) &
                               inAnyStrip(planes_[p].along_z, least.z, most.z);
    may = may || near != 0;
    // Whoever asks looks at these next, mostly at one. How many there are nobody can guess: no
    // loop.
    if (near != 0) {
      __builtin_prefetch(
          &boxes_[p * kPlaneObjects + static_cast<std::size_t>(std::countr_zero(near))]);
    }
  }
  return may;
}

std::size_t RestingObjects::hits(const SphereBatch& spheres,
                                 std::span<SphereHit> out) const noexcept {
  assert(radiiFit(spheres, largest_radius_));
  const RestingView objects = view();
  std::size_t written = 0;
  LaneGroup at;
  for (; findTouching(objects, spheres, at); ++at.group) {
    const RadiusRange& range = spheres.ranges[at.range];
    for (; at.lanes != 0; at.lanes &= at.lanes - 1) {
      const std::size_t n =
          at.group * kLanes + static_cast<std::size_t>(std::countr_zero(at.lanes));
      if (n >= range.count) break;
      const auto sphere = static_cast<std::uint32_t>(range.first + n);
      const Vec3 center{spheres.x[sphere], spheres.y[sphere], spheres.z[sphere]};
      anyOverlapping(objects, center, range.radius, [&](std::uint32_t object) {
        if (written < out.size()) out[written++] = {sphere, object};
        return written == out.size();
      });
      if (written == out.size()) return written;
    }
  }
  return written;
}

std::optional<std::uint32_t> RestingObjects::nearest(const Vec3& center,
                                                     float radius) const noexcept {
  assert(radius <= largest_radius_);
  std::optional<std::uint32_t> best;
  float least = radius * radius;
  forEachInColumn(view(), center, [&](std::uint32_t index) {
    const float squared = squaredDistance(boxes_[index], center);
    if (!(squared < least)) return;
    least = squared;
    best = index;
  });
  return best;
}

float RestingObjects::fall(const Vec3& center, float radius) const noexcept {
  assert(radius <= largest_radius_);
  float least = std::numeric_limits<float>::infinity();
  forEachInColumn(view(), center, [&](std::uint32_t index) {
    const RestingBox& box = boxes_[index];
    // Whoever lies lower than the sphere is known to sink, or aside of it, needs no closer look.
    if (center.y - radius - box.center.y - box.half_height > least) return;
    const Vec3 half = halfBounds(box);
    const float around = radius + kSlack;
    if (std::fabs(center.x - box.center.x) > half.x + around) return;
    if (std::fabs(center.z - box.center.z) > half.z + around) return;
    const std::optional<Span> heights = overlapHeights(box, center.x, center.z, radius);
    if (!heights || !(heights->lo < center.y)) return;
    least = std::min(least, std::max(center.y - heights->hi, 0.0F));
  });
  return least;
}

std::size_t RestingObjects::bytes() const {
  return planes_.size() * sizeof(planes_[0]) + boxes_.size() * sizeof(boxes_[0]) +
         resting_.size() * sizeof(resting_[0]);
}

}  // namespace galactic::simulation
