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
