#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "simulation/collision/resting_box.h"
#include "simulation/collision/resting_objects_kernels.h"
#include "simulation/collision/sphere_batch.h"
#include "support/optional_index.h"

namespace galactic::simulation {

/// A sphere of a batch that overlaps an object.
struct SphereHit {
  /// Index into the batch's arrays.
  std::uint32_t sphere = 0;
  std::uint32_t object = 0;

  friend bool operator==(const SphereHit&, const SphereHit&) = default;
};

/// The objects of one env that rest in the scene. Their bounds are stored in packs of 32 objects,
/// as many packs as needed, so no capacity can overflow, and a query costs the same for each pack;
/// resting_objects_kernels.h has the details. The objects may be shared with others at first
/// (share()) and are copied when they change. After construction nothing allocates and nothing
/// throws. One thread at a time; const members from any.
class alignas(64) RestingObjects {
 public:
  /// Room for `most_objects` objects, in `memory`, and for their bounds, which each query reads, in
  /// `bounds_memory`. Queries are for spheres of up to `largest_radius`, meters.
  RestingObjects(std::size_t most_objects, float largest_radius,
                 std::pmr::memory_resource* memory = std::pmr::get_default_resource(),
                 std::pmr::memory_resource* bounds_memory = std::pmr::get_default_resource());
  /// Shared objects stay shared; the moved-from one may not be used.
  RestingObjects(RestingObjects&&) = default;
  RestingObjects& operator=(RestingObjects&&) = delete;
  RestingObjects(const RestingObjects&) = delete;
  RestingObjects& operator=(const RestingObjects&) = delete;
  ~RestingObjects() = default;

  /// Forgets all objects.
  void clear() noexcept;

  /// Takes the objects of `others`, capacity() at most, made for the same largest radius. Copies
  /// nothing until it changes here; `others` must neither change nor go away while shared. So envs
  /// that began the same episode read the same memory.
  void share(const RestingView& others) noexcept;

  /// Lays object `index` (less than capacity()) to rest at `box`. It must not be resting already.
  /// It may be anywhere: there are no limits to be outside of.
  void insert(std::uint32_t index, const RestingBox& box) noexcept;

  /// Removes object `index`, which must be resting (it was grasped).
  void remove(std::uint32_t index) noexcept;

  /// The number of objects that there is room for.
  [[nodiscard]] std::uint32_t capacity() const noexcept {
    return static_cast<std::uint32_t>(own_boxes_.size());
  }
  [[nodiscard]] bool isResting(std::uint32_t index) const noexcept;
  /// The box of a resting object.
  [[nodiscard]] const RestingBox& box(std::uint32_t index) const noexcept {
    return now_.boxes[index];
  }
  [[nodiscard]] float largestRadius() const noexcept { return largest_radius_; }

  /// Whether any sphere overlaps any object. No radius may exceed the largest. A sphere whose
  /// center has a NaN overlaps nothing.
  [[nodiscard]] bool touches(const SphereBatch& spheres) const noexcept;
  /// The same for a robot's spheres; their bounds suffice for the answer most of the time.
  [[nodiscard]] bool touches(const BoundedSpheres& spheres) const noexcept;

  /// Whether a sphere (radius at most the largest) whose center is within bounds could overlap an
  /// object. If false, none does.
  [[nodiscard]] bool mayTouch(const CenterBounds& centers) const noexcept;

  /// Writes all overlaps, sorted by sphere, then object, as far as `out` has room. Returns how many
  /// were written.
  [[nodiscard]] std::size_t hits(const SphereBatch& spheres,
                                 std::span<SphereHit> out) const noexcept;

  /// The object whose box is nearest to `center` among those that a sphere of `radius` (at most the
  /// largest) overlaps; the lower index if equally near.
  [[nodiscard]] OptionalIndex nearest(const Vec3& center, float radius) const noexcept;

  /// How far a sphere (radius at most the largest) can sink from `center` before it touches an
  /// object: 0 if it overlaps one already, infinity if nothing is under it. Exact except for
  /// rounding: the sphere sinks to where its center enters the box grown by the radius.
  [[nodiscard]] float fall(const Vec3& center, float radius) const noexcept;

  /// Calls `visit(box, y)` for each resting object, ascending, whose box overlaps the range
  /// `heights`; `y`: the height in the range nearest to its center.
  template <class Visit>
  void forEachBetween(const Span& heights, const Visit& visit) const {
    forEachOf([&](std::size_t pack) { return between(pack, heights); },
              [&](std::uint32_t index) {
                const RestingBox& box = now_.boxes[index];
                const float y = std::clamp(box.center.y, heights.lo, heights.hi);
                if (std::fabs(y - box.center.y) < box.half_height) visit(box, y);
              });
  }

  /// Calls `visit(index)` for each resting object, ascending, that a sphere (radius at most the
  /// largest) around `center` could overlap if it were higher or lower: few objects, among them all
  /// that it overlaps.
  template <class Visit>
  void forEachInColumnOf(const Vec3& center, const Visit& visit) const {
    forEachOf([&](std::size_t pack) { return inColumnOf(pack, center); }, visit);
  }

  /// The data that touches() reads: for the kernels, and to share.
  [[nodiscard]] const RestingView& view() const noexcept { return now_; }

  /// Bytes of its own memory.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Calls `visit` with the index of each object, ascending, whose bit is set in choose(pack).
  template <class Choose, class Visit>
  void forEachOf(const Choose& choose, const Visit& visit) const {
    for (std::size_t p = 0; p < now_.bounds_count; ++p) {
      for (std::uint32_t bits = choose(p); bits != 0; bits &= bits - 1) {
        visit(static_cast<std::uint32_t>(p * kPackedObjects) +
              static_cast<std::uint32_t>(std::countr_zero(bits)));
      }
    }
  }
  /// The objects of a pack that may be near centers between `heights`, or in the column of
  /// `center`, as bits.
  [[nodiscard]] std::uint32_t between(std::size_t pack, const Span& heights) const noexcept;
  [[nodiscard]] std::uint32_t inColumnOf(std::size_t pack, const Vec3& center) const noexcept;

  [[nodiscard]] bool ownsBounds() const noexcept { return now_.bounds == own_bounds_.data(); }
  void showOwn() noexcept;
  /// Its own bounds, or box, of an object; copies shared ones first.
  [[nodiscard]] PackedBounds& ownBounds(std::uint32_t index) noexcept;
  [[nodiscard]] RestingBox& ownBox(std::uint32_t index) noexcept;

  /// Its own or shared objects; first member, because each step reads it.
  RestingView now_;
  float largest_radius_;
  std::pmr::vector<PackedBounds> own_bounds_;
  std::pmr::vector<RestingBox> own_boxes_;
};

}  // namespace galactic::simulation
