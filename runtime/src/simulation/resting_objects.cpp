#include "simulation/resting_objects.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "column_grid_kernels.h"

namespace galactic::simulation {
namespace {

constexpr std::uint32_t kWordBits = 32;

/// Objects are entered in windows that they miss by this much, so that no rounding of a query can
/// find an overlap that the windows do not know: metres, and parts of a coordinate.
constexpr float kSlack = 1e-4F;
constexpr float kRelativeSlack = 1e-6F;

std::size_t planesFor(std::size_t objects) { return (objects + kWordBits - 1) / kWordBits; }

/// Half cell of a coordinate; the border's for what lies outside, 0 for NaN. The kernel for AVX2
/// repeats it operation by operation.
std::uint32_t halfCell(float coordinate, float min, float inverse_half_cell, std::uint32_t count) {
  const float cell = (coordinate - min) * inverse_half_cell;
  const auto last = static_cast<float>(count - 1);
  const float from_first = cell > 0 ? cell : 0;
  return static_cast<std::uint32_t>(from_first < last ? from_first : last);
}

std::size_t windowOf(const WindowFrame& frame, float x, float z) {
  const std::uint32_t i = halfCell(x, frame.min_x, frame.inverse_half_cell, frame.windows_x);
  const std::uint32_t k = halfCell(z, frame.min_z, frame.inverse_half_cell, frame.windows_z);
  return std::size_t{k} * frame.windows_x + i;
}

/// Calls `visit` with the index of each object that the window knows, ascending, until it returns
/// true; whether it did.
template <class Visit>
bool anyInWindow(const RestingView& objects, std::size_t window, const Visit& visit) {
  for (std::size_t plane = 0; plane < objects.planes; ++plane) {
    std::uint32_t word = objects.words[plane * objects.plane_stride + window];
    for (; word != 0; word &= word - 1) {
      const auto bit = static_cast<std::uint32_t>(std::countr_zero(word));
      if (visit(static_cast<std::uint32_t>(plane) * kWordBits + bit)) return true;
    }
  }
  return false;
}

/// The heights first: most objects near a sphere lie higher or lower.
bool overlapsNear(const RestingBox& box, const Vec3& centre, float radius) {
  if (!(std::fabs(centre.y - box.centre.y) < box.half_height + radius)) return false;
  return overlaps(box, centre, radius);
}

/// The objects that overlap a sphere, ascending, to `visit` as in anyInWindow.
template <class Visit>
bool anyOverlapping(const RestingView& objects, const Vec3& centre, float radius,
                    const Visit& visit) {
  const std::size_t window = windowOf(objects.frame, centre.x, centre.z);
  return anyInWindow(objects, window, [&](std::uint32_t index) {
    return overlapsNear(objects.boxes[index], centre, radius) && visit(index);
  });
}

std::size_t firstTouchingGroup(const RestingView& objects, const SphereGroups& spheres,
                               std::size_t first, unsigned& lanes) {
  return detail::hasAvx2() ? firstTouchingGroupAvx2(objects, spheres, first, lanes)
                           : firstTouchingGroupPortable(objects, spheres, first, lanes);
}

SphereGroups groupsOf(const SphereBatch& spheres, const RadiusRange& range) {
  return {spheres.x + range.first, spheres.y + range.first, spheres.z + range.first,
          paddedToLanes(range.count) / kLanes, range.radius};
}

}  // namespace

std::size_t firstTouchingGroupPortable(const RestingView& objects, const SphereGroups& spheres,
                                       std::size_t first, unsigned& lanes) noexcept {
  const auto touches_any = [](std::uint32_t) { return true; };
  for (std::size_t group = first; group < spheres.groups; ++group) {
    unsigned touching = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t n = group * kLanes + lane;
      const Vec3 centre{spheres.x[n], spheres.y[n], spheres.z[n]};
      const bool touches = anyOverlapping(objects, centre, spheres.radius, touches_any);
      touching |= static_cast<unsigned>(touches) << lane;
    }
    if (touching == 0) continue;
    lanes = touching;
    return group;
  }
  return spheres.groups;
}

WindowFrame makeWindowFrame(Span x, Span z, float largest_radius) {
  constexpr float kGrowth = 1.1F;
  assert(std::isfinite(x.hi - x.lo) && std::isfinite(z.hi - z.lo) && largest_radius > 0);
  WindowFrame frame{.min_x = x.lo, .min_z = z.lo, .largest_radius = largest_radius};
  float half_cell = 2 * largest_radius;
  for (;; half_cell *= kGrowth) {
    const float columns = std::max(std::ceil((x.hi - x.lo) / half_cell), 1.0F);
    const float rows = std::max(std::ceil((z.hi - z.lo) / half_cell), 1.0F);
    if (!(columns * rows <= static_cast<float>(kMostWindows))) continue;
    frame.inverse_half_cell = 1 / half_cell;
    frame.windows_x = static_cast<std::uint32_t>(columns);
    frame.windows_z = static_cast<std::uint32_t>(rows);
    return frame;
  }
}

RestingObjects::RestingObjects(std::size_t most_windows, std::size_t most_objects)
    : planes_(planesFor(most_objects)),
      words_(planes_ * most_windows),
      boxes_(most_objects),
      resting_(planes_) {}

void RestingObjects::begin(const WindowFrame& frame) noexcept {
  assert(frame.windowCount() * planes_ <= words_.size());
  frame_ = frame;
  const auto used = static_cast<std::ptrdiff_t>(frame.windowCount() * planes_);
  std::fill(words_.begin(), words_.begin() + used, 0U);
  std::fill(resting_.begin(), resting_.end(), 0U);
}

template <class Change>
void RestingObjects::forEachWord(std::uint32_t index, const Change& change) noexcept {
  const RestingBox& box = boxes_[index];
  const Vec3 half = halfBounds(box);
  const auto cells = [this](float centre, float reach, float min, std::uint32_t count) {
    const float around =
        reach + frame_.largest_radius + kSlack + kRelativeSlack * (std::fabs(centre) + reach);
    return std::pair{halfCell(centre - around, min, frame_.inverse_half_cell, count),
                     halfCell(centre + around, min, frame_.inverse_half_cell, count)};
  };
  const auto [first_x, last_x] = cells(box.centre.x, half.x, frame_.min_x, frame_.windows_x);
  const auto [first_z, last_z] = cells(box.centre.z, half.z, frame_.min_z, frame_.windows_z);
  std::uint32_t* plane = words_.data() + index / kWordBits * frame_.windowCount();
  const std::uint32_t bit = 1U << (index % kWordBits);
  for (std::uint32_t k = first_z; k <= last_z; ++k) {
    for (std::uint32_t i = first_x; i <= last_x; ++i) {
      change(plane[std::size_t{k} * frame_.windows_x + i], bit);
    }
  }
}

void RestingObjects::insert(std::uint32_t index, const RestingBox& box) noexcept {
  assert(index < boxes_.size() && !isResting(index));
  boxes_[index] = box;
  resting_[index / kWordBits] |= 1U << (index % kWordBits);
  forEachWord(index, [](std::uint32_t& word, std::uint32_t bit) { word |= bit; });
}

void RestingObjects::remove(std::uint32_t index) noexcept {
  assert(isResting(index));
  resting_[index / kWordBits] &= ~(1U << (index % kWordBits));
  forEachWord(index, [](std::uint32_t& word, std::uint32_t bit) { word &= ~bit; });
}

bool RestingObjects::isResting(std::uint32_t index) const noexcept {
  assert(index < boxes_.size());
  return ((resting_[index / kWordBits] >> (index % kWordBits)) & 1U) != 0;
}

RestingView RestingObjects::view() const noexcept {
  return {frame_, words_.data(), frame_.windowCount(), planes_, boxes_.data()};
}

bool RestingObjects::touches(const SphereBatch& spheres) const noexcept {
  const RestingView objects = view();
  unsigned lanes = 0;
  for (const RadiusRange& range : spheres.ranges) {
    assert(range.radius <= frame_.largest_radius);
    const SphereGroups groups = groupsOf(spheres, range);
    if (firstTouchingGroup(objects, groups, 0, lanes) != groups.groups) return true;
  }
  return false;
}

std::size_t RestingObjects::hits(const SphereBatch& spheres,
                                 std::span<SphereHit> out) const noexcept {
  const RestingView objects = view();
  std::size_t written = 0;
  for (const RadiusRange& range : spheres.ranges) {
    assert(range.radius <= frame_.largest_radius);
    const SphereGroups groups = groupsOf(spheres, range);
    unsigned lanes = 0;
    std::size_t group = firstTouchingGroup(objects, groups, 0, lanes);
    for (; group != groups.groups; group = firstTouchingGroup(objects, groups, group + 1, lanes)) {
      for (; lanes != 0; lanes &= lanes - 1) {
        const std::size_t n = group * kLanes + static_cast<std::size_t>(std::countr_zero(lanes));
        if (n >= range.count) break;
        const auto sphere = static_cast<std::uint32_t>(range.first + n);
        anyOverlapping(objects, {groups.x[n], groups.y[n], groups.z[n]}, range.radius,
                       [&](std::uint32_t object) {
                         if (written < out.size()) out[written++] = {sphere, object};
                         return written == out.size();
                       });
      }
    }
  }
  return written;
}

std::optional<std::uint32_t> RestingObjects::nearest(const Vec3& centre,
                                                     float radius) const noexcept {
  assert(radius <= frame_.largest_radius);
  std::optional<std::uint32_t> best;
  float least = radius * radius;
  const RestingView objects = view();
  anyInWindow(objects, windowOf(frame_, centre.x, centre.z), [&](std::uint32_t index) {
    const float squared = squaredDistance(boxes_[index], centre);
    if (squared < least) {
      least = squared;
      best = index;
    }
    return false;
  });
  return best;
}

float RestingObjects::fall(const Vec3& centre, float radius) const noexcept {
  assert(radius <= frame_.largest_radius);
  float least = std::numeric_limits<float>::infinity();
  const RestingView objects = view();
  anyInWindow(objects, windowOf(frame_, centre.x, centre.z), [&](std::uint32_t index) {
    const std::optional<Span> heights = overlapHeights(boxes_[index], centre.x, centre.z, radius);
    if (heights && heights->lo < centre.y) {
      least = std::min(least, std::max(centre.y - heights->hi, 0.0F));
    }
    return false;
  });
  return least;
}

std::size_t RestingObjects::bytes() const {
  return words_.size() * sizeof(words_[0]) + boxes_.size() * sizeof(boxes_[0]) +
         resting_.size() * sizeof(resting_[0]);
}

}  // namespace galactic::simulation
