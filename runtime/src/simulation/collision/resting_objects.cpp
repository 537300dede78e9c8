#include "simulation/collision/resting_objects.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "simulation/collision/packed_bounds.inl"
#include "support/processor.h"

namespace galactic::simulation {
namespace {

/// Margins of objects' bounds, so that no overlap that a query finds through rounding lies outside
/// them: in meters, and relative to a coordinate.
constexpr float kSlack = 1e-4F;
constexpr float kRelativeSlack = 1e-6F;

std::uint32_t bitOf(std::uint32_t index) { return 1U << (index % kPackedObjects); }

/// Removes some objects, given as bits.
void takeOut(PackedBounds& bounds, std::uint32_t objects) {
  bounds.resting &= ~objects;
  bounds.everywhere &= ~objects;
}

/// Number of the cell that contains a coordinate, monotonic in the coordinate; the last cell for
/// NaN. The kernels do the same.
std::int32_t cellOf(float coordinate, float edge) {
  const float cell = coordinate * (1 / edge);
  const float below = cell < kFarthestCell ? cell : kFarthestCell;
  return static_cast<std::int32_t>(std::lrint(below > -kFarthestCell ? below : -kFarthestCell));
}

CellSpan cellSpan(float least, float most, float edge) {
  return {cellOf(least, edge), cellOf(most, edge)};
}

QueryBounds boundsOf(const Vec3& least, const Vec3& most) {
  return queryBounds(cellSpan(least.x, most.x, kCellEdge), cellSpan(least.y, most.y, kBandHeight),
                     cellSpan(least.z, most.z, kCellEdge));
}

/// The cells in which query centers within `reach` of `center` may lie.
CellSpan cellsAround(float center, float reach, float edge) {
  const float around = reach + kSlack + kRelativeSlack * (std::fabs(center) + reach);
  return cellSpan(center - around, center + around, edge);
}

/// Calls `visit` with the index of each object whose bounds overlap those of a query, ascending,
/// until it returns true. Returns whether it did.
template <class Visit>
bool anyNear(const RestingView& objects, const QueryBounds& query, const Visit& visit) {
  for (std::size_t p = 0; p < objects.bounds_count; ++p) {
    for (std::uint32_t near = objectsNear(objects, p, query); near != 0; near &= near - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(near));
      if (visit(static_cast<std::uint32_t>(p) * kPackedObjects + bit)) return true;
    }
  }
  return false;
}

/// Calls `visit`, as anyNear() does, with the objects that overlap a sphere, ascending.
template <class Visit>
bool anyOverlapping(const RestingView& objects, const Vec3& center, float radius,
                    const Visit& visit) {
  return anyNear(objects, boundsOf(center, center), [&](std::uint32_t index) {
    const RestingBox& box = objects.boxes[index];
    // The kernels test heights first, too; this only saves time and changes no answer.
    return std::fabs(center.y - box.center.y) < box.half_height + radius &&
           overlaps(box, center, radius) && visit(index);
  });
}

/// The fastest kernels that this processor can run.
const RestingKernels& restingKernels() {
  static const RestingKernels kernels = detail::hasAvx2() ? avx2Resting() : portableResting();
  return kernels;
}

/// The precondition of a query.
[[maybe_unused]] bool radiiFit(const SphereBatch& spheres, float largest_radius) {
  return std::all_of(spheres.ranges.begin(), spheres.ranges.end(),
                     [=](const RadiusRange& range) { return range.radius <= largest_radius; });
}

}  // namespace

RestingObjects::RestingObjects(std::size_t most_objects, float largest_radius,
                               std::pmr::memory_resource* memory,
                               std::pmr::memory_resource* bounds_memory)
    : largest_radius_(largest_radius),
      own_bounds_(packsFor(most_objects), bounds_memory),
      own_boxes_(most_objects, memory) {
  showOwn();
}

void RestingObjects::showOwn() noexcept {
  now_ = {own_bounds_.data(), own_bounds_.size(), own_boxes_.data(), own_boxes_.size()};
}

std::uint32_t RestingObjects::between(std::size_t pack, const Span& heights) const noexcept {
  QueryBounds query;
  query.bands = bandsOf(cellSpan(heights.lo, heights.hi, kBandHeight));
  query.is_everywhere = true;
  return objectsNear(now_, pack, query);
}

std::uint32_t RestingObjects::inColumnOf(std::size_t pack, const Vec3& center) const noexcept {
  QueryBounds query = boundsOf(center, center);
  query.bands = kAllBands;
  return objectsNear(now_, pack, query);
}

void RestingObjects::clear() noexcept {
  showOwn();
  std::ranges::fill(own_bounds_, PackedBounds{});
}

void RestingObjects::share(const RestingView& others) noexcept {
  assert(others.bounds_count <= own_bounds_.size() && others.boxes_count <= own_boxes_.size());
  now_ = others;
}

PackedBounds& RestingObjects::ownBounds(std::uint32_t index) noexcept {
  if (!ownsBounds()) {
    const auto rest = std::copy_n(now_.bounds, now_.bounds_count, own_bounds_.begin());
    std::fill(rest, own_bounds_.end(), PackedBounds{});
    now_.bounds = own_bounds_.data();
    now_.bounds_count = own_bounds_.size();
    if (now_.absent != 0) takeOut(own_bounds_[now_.absent_pack], now_.absent);
    now_.absent = 0;
  }
  return own_bounds_[index / kPackedObjects];
}

RestingBox& RestingObjects::ownBox(std::uint32_t index) noexcept {
  if (now_.boxes != own_boxes_.data()) {
    std::copy_n(now_.boxes, now_.boxes_count, own_boxes_.begin());
    now_.boxes = own_boxes_.data();
    now_.boxes_count = own_boxes_.size();
  }
  return own_boxes_[index];
}

void RestingObjects::insert(std::uint32_t index, const RestingBox& box) noexcept {
  assert(index < capacity() && !isResting(index));
  ownBox(index) = box;
  const Vec3 half = halfBounds(box);
  const float radius = largest_radius_;
  const CellSpan x = cellsAround(box.center.x, half.x + radius, kCellEdge);
  const CellSpan z = cellsAround(box.center.z, half.z + radius, kCellEdge);
  PackedBounds& bounds = ownBounds(index);
  const std::uint32_t n = index % kPackedObjects;
  bounds.least_x[n] = static_cast<std::uint8_t>(x.first);
  bounds.most_x[n] = static_cast<std::uint8_t>(x.last);
  bounds.least_z[n] = static_cast<std::uint8_t>(z.first);
  bounds.most_z[n] = static_cast<std::uint8_t>(z.last);
  bounds.bands[n] = bandsOf(cellsAround(box.center.y, half.y + radius, kBandHeight));
  bounds.resting |= bitOf(index);
  if (isEverywhere(x, z)) bounds.everywhere |= bitOf(index);
}

void RestingObjects::remove(std::uint32_t index) noexcept {
  assert(isResting(index));
  // Shared bounds stay shared while one object is missing, as when a hand has taken it.
  if (!ownsBounds() && now_.absent == 0) {
    now_.absent_pack = index / kPackedObjects;
    now_.absent = bitOf(index);
  } else {
    takeOut(ownBounds(index), bitOf(index));
  }
}

bool RestingObjects::isResting(std::uint32_t index) const noexcept {
  assert(index < capacity());
  const std::size_t pack = index / kPackedObjects;
  if (pack >= now_.bounds_count) return false;
  return (now_.bounds[pack].resting & ~absentOf(now_, pack) & bitOf(index)) != 0;
}

bool RestingObjects::touches(const SphereBatch& spheres) const noexcept {
  assert(radiiFit(spheres, largest_radius_));
  LaneGroup at;
  return restingKernels().find_touching(view(), spheres, at);
}

bool RestingObjects::touches(const BoundedSpheres& spheres) const noexcept {
  return restingKernels().touches(view(), spheres);
}

bool RestingObjects::mayTouch(const CenterBounds& centers) const noexcept {
  return restingKernels().may_touch(view(), centers);
}

std::size_t RestingObjects::hits(const SphereBatch& spheres,
                                 std::span<SphereHit> out) const noexcept {
  assert(radiiFit(spheres, largest_radius_));
  const RestingView objects = view();
  std::size_t written = 0;
  LaneGroup at;
  for (; restingKernels().find_touching(objects, spheres, at); ++at.group) {
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

OptionalIndex RestingObjects::nearest(const Vec3& center, float radius) const noexcept {
  assert(radius <= largest_radius_);
  OptionalIndex best;
  float least = radius * radius;
  forEachInColumnOf(center, [&](std::uint32_t index) {
    const float squared = squaredDistance(now_.boxes[index], center);
    if (!(squared < least)) return;
    least = squared;
    best = index;
  });
  return best;
}

float RestingObjects::fall(const Vec3& center, float radius) const noexcept {
  assert(radius <= largest_radius_);
  float least = std::numeric_limits<float>::infinity();
  forEachInColumnOf(center, [&](std::uint32_t index) {
    const RestingBox& box = now_.boxes[index];
    // An object below the depth found so far, or beside the sphere, needs no closer look.
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
  return own_bounds_.size() * sizeof(PackedBounds) + own_boxes_.size() * sizeof(RestingBox);
}

}  // namespace galactic::simulation
