#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/oriented_box.h"
#include "galactic/pose.h"
#include "galactic/vec3.h"
#include "simulation/sphere_batch.h"

namespace galactic::simulation {

/// Where the four shifted regular grids of one scene lie (paper, appendix G). A cell is at least
/// four times the largest radius wide; the second grid is shifted by half a cell in x, the third in
/// z, the fourth in both, so any sphere of the working set lies inside one cell of one of them.
/// The cells of all four begin at the points of one lattice with half a cell between its points,
/// each point begins exactly one cell, and so the four grids are stored as one array of windows:
/// window (i, k) covers [i, i + 2) x [k, k + 2) half cells, and a sphere whose lowest corner
/// (centre minus the largest radius) lies in half cell (i, k) lies inside window (i, k).
struct WindowFrame {
  /// Corner of half cell (0, 0), metres.
  float min_x = 0;
  float min_z = 0;
  /// Of half a cell, 1 / metres.
  float inverse_half_cell = 0;
  float largest_radius = 0;
  std::uint32_t windows_x = 0;
  std::uint32_t windows_z = 0;

  [[nodiscard]] std::size_t windowCount() const {
    return static_cast<std::size_t>(windows_x) * windows_z;
  }
};

/// The frame that covers the rectangle [min_x, max_x] x [min_z, max_z], metres.
[[nodiscard]] WindowFrame makeWindowFrame(Span x, Span z, float largest_radius);

/// A resting object as the narrow phase reads it: one cache line.
struct alignas(64) RestingBox {
  /// World frame, metres.
  Vec3 centre;
  /// world_from_box.
  Quat rotation;
  Vec3 half_extents;
  /// Lowest and highest point.
  Span heights;
};

/// The oriented box of an object at `world_from_object`.
[[nodiscard]] RestingBox restingBox(const OrientedBox& box, const Pose& world_from_object);

/// The point of the box nearest to `point`, both in the world frame; `point` itself when inside.
[[nodiscard]] Vec3 nearestPoint(const RestingBox& box, const Vec3& point) noexcept;

/// Whether sphere and box overlap: distance from centre to box < radius (touching is no overlap).
[[nodiscard]] bool overlaps(const RestingBox& box, const Vec3& centre, float radius) noexcept;

/// A sphere of a batch that overlaps an object.
struct SphereHit {
  std::uint32_t sphere = 0;
  std::uint32_t object = 0;
};

/// The objects of one env that rest in the scene. Windows hold sets of object indices as bits, as
/// many 64-bit words as the objects need, so no capacity can overflow. After construction nothing
/// allocates and nothing throws.
class RestingObjects {
 public:
  /// Room for `most_objects` objects in any frame of up to `most_windows` windows.
  RestingObjects(std::size_t most_windows, std::size_t most_objects);

  /// Forgets all objects and works in `frame` from now on.
  void begin(const WindowFrame& frame) noexcept;

  /// Object `index` rests at `box` from now on. It must not be resting already. A box, or a part of
  /// one, outside the frame is kept in the windows at the border.
  void insert(std::uint32_t index, const RestingBox& box) noexcept;

  /// Object `index` rests no more (it was grasped).
  void remove(std::uint32_t index) noexcept;

  [[nodiscard]] bool isResting(std::uint32_t index) const noexcept;
  /// Of a resting object.
  [[nodiscard]] const RestingBox& box(std::uint32_t index) const noexcept { return boxes_[index]; }

  /// Whether any sphere overlaps any object.
  [[nodiscard]] bool touches(const SphereBatch& spheres) const noexcept;

  /// All overlaps, by sphere, then object; as many as `out` takes. Returns how many were written.
  [[nodiscard]] std::size_t hits(const SphereBatch& spheres,
                                 std::span<SphereHit> out) const noexcept;

  /// The object whose box is nearest to `centre` among those that a sphere of `radius` (of the
  /// working set, or smaller than the largest) overlaps; the lower index when equally near.
  [[nodiscard]] std::optional<std::uint32_t> nearest(const Vec3& centre,
                                                     float radius) const noexcept;

  /// How far a sphere can sink from `centre` (not overlapping anything) before it touches an
  /// object; infinity when nothing is under it.
  [[nodiscard]] float fall(const Vec3& centre, float radius) const noexcept;

  [[nodiscard]] std::size_t bytes() const;

 private:
  WindowFrame frame_;
  std::size_t words_ = 0;
  std::vector<std::uint64_t> windows_;
  std::vector<RestingBox> boxes_;
  std::vector<std::uint64_t> resting_;
};

}  // namespace galactic::simulation
