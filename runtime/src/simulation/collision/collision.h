#pragma once
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
#include "simulation/collision/sphere_bits.h"

namespace galactic::simulation {

/// Scratch space for the answers about the spheres of one batch, allocated once.
class CollisionScratch {
 public:
  /// `most_spheres`: the most of any batch, padded to lanes.
  explicit CollisionScratch(std::size_t most_spheres);

  [[nodiscard]] std::span<Clearance> clearance(std::size_t count) {
    return std::span(clearance_).first(count);
  }
  [[nodiscard]] std::span<SphereHit> hits() { return hits_; }

 private:
  std::vector<Clearance> clearance_;
  std::vector<SphereHit> hits_;
};

/// The farthest move of any sphere from one batch to the other, in radii of that sphere. Both
/// batches have the same ranges.
[[nodiscard]] float farthestMove(const SphereBatch& from, const SphereBatch& to) noexcept;

/// The groups of a batch with these ranges, in order.
[[nodiscard]] std::vector<EightSpheres> spheresByEights(std::span<const RadiusRange> ranges);

/// Everything that a robot, or an object that it holds or releases, can hit.
struct Obstacles {
  const Scene& scene;
  const RestingObjects& objects;
};

/// Whether any sphere penetrates the static scene or a resting object. A place outside of the grid
/// counts as penetrated.
[[nodiscard]] bool penetrates(const Obstacles& obstacles, const SphereBatch& spheres) noexcept;

/// The spheres of up to eight groups from `first` on that the static scene blocks, as bits.
/// `groups`: of the whole batch; `asked`: the spheres to check, as bits from group `first` on.
[[nodiscard]] std::uint64_t blockedSpheres(const Scene& scene, const SphereBatch& spheres,
                                           std::span<const EightSpheres> groups, std::size_t first,
                                           std::uint64_t asked) noexcept;

/// The push that moves an overlapping sphere out of a box: the shortest horizontal one along the
/// normal of contact.
[[nodiscard]] Push pushOutOfBox(const RestingBox& box, const Vec3& center, float radius) noexcept;

/// Adds to `sum` the pushes out of resting objects for all overlaps of spheres that are not
/// ignored. Returns the number of these overlaps.
std::size_t pushOutOfObjects(const RestingObjects& objects, const SphereBatch& spheres,
                             IgnoredSpheres ignored, CollisionScratch& scratch,
                             PushSum& sum) noexcept;

/// Sets the bit of each sphere that overlaps the box and clears the others. Returns whether any
/// does.
bool overlapping(const RestingBox& box, const SphereBatch& spheres,
                 std::span<std::uint64_t> bits) noexcept;

/// Sets the bit of each sphere that penetrates the static scene and clears the others. Returns
/// whether any does.
bool penetratingScene(const Scene& scene, const SphereBatch& spheres, CollisionScratch& scratch,
                      std::span<std::uint64_t> bits) noexcept;
/// The same for resting objects.
bool penetratingObjects(const RestingObjects& objects, const SphereBatch& spheres,
                        std::span<std::uint64_t> bits) noexcept;
/// The same for both.
void penetrating(const Obstacles& obstacles, const SphereBatch& spheres, CollisionScratch& scratch,
                 std::span<std::uint64_t> bits) noexcept;

}  // namespace galactic::simulation
