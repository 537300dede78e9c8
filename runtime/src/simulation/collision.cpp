#include "simulation/collision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace galactic::simulation {
namespace {

constexpr std::size_t kBitsPerWord = 64;

bool isIgnored(IgnoredSpheres ignored, std::size_t sphere) {
  return !ignored.empty() && (ignored[sphere / kBitsPerWord] >> (sphere % kBitsPerWord) & 1U) != 0;
}

/// Asks the grid of one radius about its spheres, whole lanes at a time.
std::span<const Clearance> askScene(const Scene& scene, const SphereBatch& spheres,
                                    const RadiusRange& range, CollisionScratch& scratch) {
  const std::size_t count = paddedToLanes(range.count);
  const std::span<Clearance> answers = scratch.clearance(count);
  scene.grids()[range.radius_index].contact(
      {std::span(spheres.x + range.first, count), std::span(spheres.y + range.first, count),
       std::span(spheres.z + range.first, count)},
      {answers, {}, {}});
  return answers;
}

bool allFree(std::span<const Clearance> answers) {
  static_assert(static_cast<int>(Clearance::kFree) == 0 && sizeof(std::uint64_t) == kLanes);
  for (std::size_t n = 0; n < answers.size(); n += kLanes) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, answers.data() + n, sizeof(eight));
    if (eight != 0) return false;
  }
  return true;
}

/// Calls visit(sphere, range) for each sphere that the static scene blocks.
template <class Visit>
void visitBlocked(const Obstacles& obstacles, const SphereBatch& spheres, CollisionScratch& scratch,
                  const Visit& visit) {
  for (const RadiusRange& range : spheres.ranges) {
    const std::span<const Clearance> answers = askScene(obstacles.scene, spheres, range, scratch);
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

Vec3 centreOf(const SphereBatch& spheres, std::uint32_t sphere) {
  return {spheres.x[sphere], spheres.y[sphere], spheres.z[sphere]};
}

}  // namespace

CollisionScratch::CollisionScratch(std::size_t most_spheres) {
  clearance_.resize(paddedToLanes(most_spheres));
  // More overlaps at a time change no push; only the largest in each direction count.
  constexpr std::size_t kHitsPerSphere = 4;
  hits_.resize(kHitsPerSphere * most_spheres);
}

bool penetrates(const Obstacles& obstacles, const SphereBatch& spheres,
                CollisionScratch& scratch) noexcept {
  for (const RadiusRange& range : spheres.ranges) {
    if (!allFree(askScene(obstacles.scene, spheres, range, scratch))) return true;
  }
  return obstacles.objects.touches(spheres);
}

void PushSum::add(const Push& push) noexcept {
  least_x_ = std::min(least_x_, push.x);
  most_x_ = std::max(most_x_, push.x);
  least_z_ = std::min(least_z_, push.z);
  most_z_ = std::max(most_z_, push.z);
}

Push PushSum::total(float longest) const noexcept {
  const Push sum{least_x_ + most_x_, least_z_ + most_z_};
  const float length = std::sqrt(sum.x * sum.x + sum.z * sum.z);
  if (!(length > longest)) return sum;
  return {sum.x * (longest / length), sum.z * (longest / length)};
}

Push pushOutOfScene(const ColumnGrid& grid, const Vec3& centre, float reach) noexcept {
  constexpr float kDiagonal = 0.70710678F;
  constexpr std::array<float, kLanes> kX{1, kDiagonal, 0, -kDiagonal, -1, -kDiagonal, 0, kDiagonal};
  constexpr std::array<float, kLanes> kZ{0, kDiagonal, 1, kDiagonal, 0, -kDiagonal, -1, -kDiagonal};
  std::array<float, kLanes> x{};
  std::array<float, kLanes> y{};
  std::array<float, kLanes> z{};
  std::array<Clearance, kLanes> answers{};
  y.fill(centre.y);
  // A step of one column: the nearest column decides, so nothing changes in between.
  for (int columns = 1;; ++columns) {
    const float distance = static_cast<float>(columns) * grid.spacing();
    if (!(distance <= reach)) return {};
    for (std::size_t n = 0; n < kLanes; ++n) {
      x[n] = centre.x + distance * kX[n];
      z[n] = centre.z + distance * kZ[n];
    }
    grid.contact({x, y, z}, {answers, {}, {}});
    Push sum;
    Push first;
    for (std::size_t n = kLanes; n-- > 0;) {
      if (answers[n] != Clearance::kFree) continue;
      first = {kX[n], kZ[n]};
      sum = {sum.x + kX[n], sum.z + kZ[n]};
    }
    const float length = std::sqrt(sum.x * sum.x + sum.z * sum.z);
    // Free on both sides of something thin: one of them.
    constexpr float kNoMean = 0.1F;
    if (length > kNoMean) return {sum.x * (distance / length), sum.z * (distance / length)};
    if (first.x != 0 || first.z != 0) return {first.x * distance, first.z * distance};
  }
}

Push pushOutOfBox(const RestingBox& box, const Vec3& centre, float radius) noexcept {
  const Vec3 normal = centre - nearestPoint(box, centre);
  const float across = std::sqrt(normal.x * normal.x + normal.z * normal.z);
  constexpr float kNoDirection = 1e-6F;
  constexpr float kMargin = 1e-4F;
  if (across > kNoDirection) {
    // Moving by t along the horizontal part of the normal makes its length the radius.
    const float needed = std::sqrt(std::max(0.0F, radius * radius - normal.y * normal.y));
    const float t = std::max(0.0F, needed - across) + kMargin;
    return {normal.x / across * t, normal.z / across * t};
  }
  const Vec3 away = centre - box.centre;
  const float length = std::sqrt(away.x * away.x + away.z * away.z);
  if (!(length > kNoDirection)) return {radius, 0};
  return {away.x / length * radius, away.z / length * radius};
}

std::size_t pushOut(const Obstacles& obstacles, const SphereBatch& spheres, IgnoredSpheres ignored,
                    float reach, CollisionScratch& scratch, PushSum& sum) noexcept {
  std::size_t count = 0;
  visitBlocked(obstacles, spheres, scratch, [&](std::uint32_t sphere, const RadiusRange& range) {
    if (isIgnored(ignored, sphere)) return;
    sum.add(pushOutOfScene(obstacles.scene.grids()[range.radius_index], centreOf(spheres, sphere),
                           reach));
    ++count;
  });
  const std::size_t hits = obstacles.objects.hits(spheres, scratch.hits());
  for (const SphereHit& hit : scratch.hits().first(hits)) {
    if (isIgnored(ignored, hit.sphere)) continue;
    sum.add(pushOutOfBox(obstacles.objects.box(hit.object), centreOf(spheres, hit.sphere),
                         radiusOf(spheres, hit.sphere)));
    ++count;
  }
  return count;
}

void penetrating(const Obstacles& obstacles, const SphereBatch& spheres, CollisionScratch& scratch,
                 std::span<std::uint64_t> bits) noexcept {
  std::fill(bits.begin(), bits.end(), 0);
  const auto set = [&](std::uint32_t sphere) {
    bits[sphere / kBitsPerWord] |= std::uint64_t{1} << (sphere % kBitsPerWord);
  };
  visitBlocked(obstacles, spheres, scratch,
               [&](std::uint32_t sphere, const RadiusRange&) { set(sphere); });
  for (const RadiusRange& range : spheres.ranges) {
    for (std::uint32_t n = range.first; n < range.first + range.count; ++n) {
      if (obstacles.objects.nearest(centreOf(spheres, n), range.radius)) set(n);
    }
  }
}

}  // namespace galactic::simulation
