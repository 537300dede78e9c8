#include "simulation/collision/collision.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "column_grid/column_grid_kernels.h"
#include "support/processor.h"

namespace galactic::simulation {
namespace {

/// The centers of one radius with their padding.
SphereCenters centersOf(const SphereBatch& spheres, const RadiusRange& range) {
  const std::size_t count = paddedToLanes(range.count);
  return {std::span(spheres.x + range.first, count), std::span(spheres.y + range.first, count),
          std::span(spheres.z + range.first, count)};
}

/// Asks the grid of one radius about its spheres, in whole groups of lanes.
std::span<const Clearance> askScene(const Scene& scene, const SphereBatch& spheres,
                                    const RadiusRange& range, CollisionScratch& scratch) {
  const std::span<Clearance> answers = scratch.clearance(paddedToLanes(range.count));
  scene.grids()[range.radius_index].contact(centersOf(spheres, range), {answers, {}, {}});
  return answers;
}

/// Calls visit(sphere, range) for each sphere that the static scene blocks.
template <class Visit>
void visitBlocked(const Scene& scene, const SphereBatch& spheres, CollisionScratch& scratch,
                  const Visit& visit) {
  for (const RadiusRange& range : spheres.ranges) {
    const std::span<const Clearance> answers = askScene(scene, spheres, range, scratch);
    for (std::uint32_t n = 0; n < range.count; ++n) {
      if (answers[n] != Clearance::kFree) visit(range.first + n, range);
    }
  }
}

float radiusOf(const SphereBatch& spheres, std::uint32_t sphere) {
  for (const RadiusRange& range : spheres.ranges) {
    if (sphere >= range.first && sphere < range.first + range.count) return range.radius;
  }
  return 0;
}

Vec3 centerOf(const SphereBatch& spheres, std::uint32_t sphere) {
  return {spheres.x[sphere], spheres.y[sphere], spheres.z[sphere]};
}

/// Sets the bit of each sphere that penetrates a resting object. Returns whether any does.
bool addTouching(const RestingObjects& objects, const SphereBatch& spheres,
                 std::span<std::uint64_t> bits) {
  bool any = false;
  for (const RadiusRange& range : spheres.ranges) {
    for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
      if (!objects.nearest(centerOf(spheres, n), range.radius)) continue;
      setBit(bits, n);
      any = true;
    }
  }
  return any;
}

}  // namespace

CollisionScratch::CollisionScratch(std::size_t most_spheres) {
  clearance_.resize(paddedToLanes(most_spheres));
  // More overlaps hardly change a push: only the largest in each direction counts.
  constexpr std::size_t kHitsPerSphere = 4;
  hits_.resize(kHitsPerSphere * most_spheres);
}

float farthestMove(const SphereBatch& from, const SphereBatch& to) noexcept {
  float farthest = 0;
  for (const RadiusRange& range : from.ranges) {
    float squared = 0;
    for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
      const Vec3 way{to.x[n] - from.x[n], to.y[n] - from.y[n], to.z[n] - from.z[n]};
      squared = std::max(squared, dot(way, way));
    }
    farthest = std::max(farthest, std::sqrt(squared) / range.radius);
  }
  return farthest;
}

std::vector<EightSpheres> spheresByEights(std::span<const RadiusRange> ranges) {
  std::vector<EightSpheres> groups;
  for (const RadiusRange& range : ranges) {
    for (std::uint32_t n = 0; n < range.count; n += kLanes) {
      const std::uint32_t left = std::min(range.count - n, static_cast<std::uint32_t>(kLanes));
      groups.push_back({range.radius_index, range.radius, (1U << left) - 1});
    }
  }
  return groups;
}

std::uint64_t blockedSpheres(const Scene& scene, const SphereBatch& spheres,
                             std::span<const EightSpheres> groups, std::size_t first,
                             std::uint64_t asked) noexcept {
  const auto grid_of = [&](std::size_t group) -> const ColumnGrid& {
    return scene.grids()[groups[first + group].radius_index];
  };
  // Mostly only a few spheres in several groups are asked about: the first few go one by one, the
  // rest in groups of eight.
  constexpr int kFew = 4;
  std::uint64_t blocked = 0;
  for (int few = 0; few < kFew && asked != 0; ++few, asked &= asked - 1) {
    const auto bit = static_cast<std::size_t>(std::countr_zero(asked));
    const std::size_t n = first * kLanes + bit;
    const Clearance clearance =
        grid_of(bit / kLanes).clearance({spheres.x[n], spheres.y[n], spheres.z[n]});
    blocked |= std::uint64_t{clearance != Clearance::kFree} << bit;
  }
  while (asked != 0) {
    const std::size_t group = static_cast<std::size_t>(std::countr_zero(asked)) / kLanes;
    const std::size_t n = (first + group) * kLanes;
    const detail::EightsOfCenters centers{spheres.x + n, spheres.y + n, spheres.z + n};
    const ColumnGridLayout& grid = grid_of(group).layout();
    const std::uint64_t not_free = detail::hasAvx2() ? detail::notFreeAvx2(grid, centers)
                                                     : detail::notFreePortable(grid, centers);
    const std::uint64_t own = std::uint64_t{0xff} << (kLanes * group);
    blocked |= not_free << (kLanes * group) & own & asked;
    asked &= ~own;
  }
  return blocked;
}

bool penetrates(const Obstacles& obstacles, const SphereBatch& spheres) noexcept {
  // Whole groups of lanes, since the padding repeats a sphere.
  for (std::size_t n = spheres.ranges.size(); n-- > 0;) {
    const RadiusRange& range = spheres.ranges[n];
    const SphereCenters centers = centersOf(spheres, range);
    const ColumnGrid& grid = obstacles.scene.grids()[range.radius_index];
    if (grid.firstNotFree(centers) != centers.x.size()) return true;
  }
  return obstacles.objects.touches(spheres);
}

Push pushOutOfBox(const RestingBox& box, const Vec3& center, float radius) noexcept {
  const Vec3 normal = center - nearestPoint(box, center);
  const float across = std::sqrt(normal.x * normal.x + normal.z * normal.z);
  constexpr float kNoDirection = 1e-6F;
  constexpr float kMargin = 1e-4F;
  if (across > kNoDirection) {
    // Moving by t along the horizontal part of the normal makes the normal as long as the radius.
    const float needed = std::sqrt(std::max(0.0F, radius * radius - normal.y * normal.y));
    const float t = std::max(0.0F, needed - across) + kMargin;
    return {normal.x / across * t, normal.z / across * t};
  }
  const Vec3 away = center - box.center;
  const float length = std::sqrt(away.x * away.x + away.z * away.z);
  if (!(length > kNoDirection)) return {radius, 0};
  return {away.x / length * radius, away.z / length * radius};
}

std::size_t pushOutOfObjects(const RestingObjects& objects, const SphereBatch& spheres,
                             IgnoredSpheres ignored, CollisionScratch& scratch,
                             PushSum& sum) noexcept {
  std::size_t count = 0;
  const std::size_t hits = objects.hits(spheres, scratch.hits());
  for (const SphereHit& hit : scratch.hits().first(hits)) {
    if (isIgnored(ignored, hit.sphere)) continue;
    sum.add(pushOutOfBox(objects.box(hit.object), centerOf(spheres, hit.sphere),
                         radiusOf(spheres, hit.sphere)));
    ++count;
  }
  return count;
}

bool overlapping(const RestingBox& box, const SphereBatch& spheres,
                 std::span<std::uint64_t> bits) noexcept {
  std::fill(bits.begin(), bits.end(), 0);
  bool any = false;
  for (const RadiusRange& range : spheres.ranges) {
    for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
      if (!overlaps(box, centerOf(spheres, n), range.radius)) continue;
      setBit(bits, n);
      any = true;
    }
  }
  return any;
}

bool penetratingScene(const Scene& scene, const SphereBatch& spheres, CollisionScratch& scratch,
                      std::span<std::uint64_t> bits) noexcept {
  std::fill(bits.begin(), bits.end(), 0);
  bool any = false;
  visitBlocked(scene, spheres, scratch, [&](std::uint32_t sphere, const RadiusRange&) {
    setBit(bits, sphere);
    any = true;
  });
  return any;
}

bool penetratingObjects(const RestingObjects& objects, const SphereBatch& spheres,
                        std::span<std::uint64_t> bits) noexcept {
  std::fill(bits.begin(), bits.end(), 0);
  return addTouching(objects, spheres, bits);
}

void penetrating(const Obstacles& obstacles, const SphereBatch& spheres, CollisionScratch& scratch,
                 std::span<std::uint64_t> bits) noexcept {
  penetratingScene(obstacles.scene, spheres, scratch, bits);
  addTouching(obstacles.objects, spheres, bits);
}

}  // namespace galactic::simulation
