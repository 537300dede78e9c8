#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/pose.h"
#include "galactic/scene.h"
#include "simulation/collision/push.h"
#include "simulation/collision/resting_objects.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Room for the answers about the spheres of one batch, allocated once.
class CollisionScratch {
 public:
  /// `most_spheres`: padded to lanes, of any batch.
  explicit CollisionScratch(std::size_t most_spheres);

  [[nodiscard]] std::span<Clearance> clearance(std::size_t count) {
    return std::span(clearance_).first(count);
  }
  [[nodiscard]] std::span<SphereHit> hits() { return hits_; }

 private:
  std::vector<Clearance> clearance_;
  std::vector<SphereHit> hits_;
};

/// The farthest way of a sphere from one batch to the other, in radii of the sphere that goes it.
/// Both have the same ranges.
[[nodiscard]] float farthestMove(const SphereBatch& from, const SphereBatch& to) noexcept;

/// The groups of a batch with these ranges, in order.
[[nodiscard]] std::vector<EightSpheres> spheresByEights(std::span<const RadiusRange> ranges);

/// What a robot, and an object that it holds or releases, can hit.
struct Obstacles {
  const Scene& scene;
  const RestingObjects& objects;
};

/// Whether any sphere penetrates the static scene or a resting object. A place that the grid does
/// not know counts as penetrated.
[[nodiscard]] bool penetrates(const Obstacles& obstacles, const SphereBatch& spheres) noexcept;

/// Which spheres of up to eight groups the static scene blocks, as bits from the first of the
/// groups on. `groups`: of the whole batch; `asked`: the spheres of those from `first` on, as bits.
[[nodiscard]] std::uint64_t blockedSpheres(const Scene& scene, const SphereBatch& spheres,
                                           std::span<const EightSpheres> groups, std::size_t first,
                                           std::uint64_t asked) noexcept;

/// The way out of a box for a sphere that overlaps it: the shortest horizontal one along the normal
/// of contact.
[[nodiscard]] Push pushOutOfBox(const RestingBox& box, const Vec3& center, float radius) noexcept;

/// Spheres that do not count, as one bit each: those of a held object that penetrated something
/// already when it was grasped (its spheres reach further than the box as which it rested), until
/// they are free. Empty: all count.
using IgnoredSpheres = std::span<const std::uint64_t>;

[[nodiscard]] inline bool isEmpty(std::span<const std::uint64_t> bits) {
  return std::ranges::all_of(bits, [](std::uint64_t word) { return word == 0; });
}

/// Whether a bit is set that is not ignored.
[[nodiscard]] inline bool anyCounts(std::span<const std::uint64_t> bits, IgnoredSpheres ignored) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < bits.size(); ++w) any |= bits[w] & ~ignored[w];
  return any != 0;
}

/// Spheres that are free now, which do not have their bit, count from now on; whether some still do
/// not.
inline bool keepPenetrating(std::span<std::uint64_t> ignored, std::span<const std::uint64_t> bits) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < ignored.size(); ++w) {
    ignored[w] &= bits[w];
    any |= ignored[w];
  }
  return any != 0;
}

/// The way out of resting objects for all spheres that penetrate some and are not ignored. Returns
/// their number.
std::size_t pushOutOfObjects(const RestingObjects& objects, const SphereBatch& spheres,
                             IgnoredSpheres ignored, CollisionScratch& scratch,
                             PushSum& sum) noexcept;

/// Sets the bit of each sphere that overlaps the box, clears the others. Returns whether any does.
bool overlapping(const RestingBox& box, const SphereBatch& spheres,
                 std::span<std::uint64_t> bits) noexcept;

/// Sets the bit of each sphere that penetrates the static scene, clears the others. Returns whether
/// any does.
bool penetratingScene(const Scene& scene, const SphereBatch& spheres, CollisionScratch& scratch,
                      std::span<std::uint64_t> bits) noexcept;
/// The same for resting objects.
bool penetratingObjects(const RestingObjects& objects, const SphereBatch& spheres,
                        std::span<std::uint64_t> bits) noexcept;
/// The same for both.
void penetrating(const Obstacles& obstacles, const SphereBatch& spheres, CollisionScratch& scratch,
                 std::span<std::uint64_t> bits) noexcept;

}  // namespace galactic::simulation
