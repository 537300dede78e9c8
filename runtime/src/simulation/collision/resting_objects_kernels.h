#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/resting_box.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

// The broad phase: which objects a query has to look at. A grid of lists, such as the paper's four
// shifted regular grids (appendix G), finds them for one sphere; here a query checks all objects of
// an env at once. Each object's bounds are stored as bytes, as in the nodes of compressed wide
// hierarchies (Ylitie, Karras and Laine 2017), axis by axis, so that about thirty instructions
// compare the bounds of a query (one sphere, eight, or a whole robot) with those of 32 objects. 32
// objects take 192 bytes, whereas windows of a grid would take 8,000 and their strips 640. Envs
// that have moved nothing share these bytes; the first object that an env lays down copies them.
// The bytes wrap around: cell n stands for every 256th cell, 32 meters apart. No scene is too
// large, and nothing has to be clamped. An object in another room at the same place on the torus is
// found and then rejected by the narrow phase, and so is one that only shares a cell with the
// query.

/// Edge of a cell and height of a band, meters: powers of two, so that no rounding is involved.
inline constexpr float kCellEdge = 0.125F;
inline constexpr float kBandHeight = 0.25F;
/// Coordinates beyond this, in cells, are not distinguished.
inline constexpr float kFarthestCell = 0x1p29F;
/// Cells along an axis, as many as a byte can distinguish.
inline constexpr std::int32_t kByteCells = 256;
/// The bits of a byte; together 2 meters high.
inline constexpr std::int32_t kBands = 8;
inline constexpr std::uint8_t kAllBands = 0xff;
/// Bounds wider than this, in cells, count as everywhere. Those of an object and a query together
/// stay below half a turn, so that the sign of a difference shows which of two cells comes first.
inline constexpr std::int32_t kMostByteCells = kByteCells / 4 - 1;

/// Objects whose bounds are packed together.
inline constexpr std::uint32_t kPackedObjects = 32;

/// The number of PackedBounds for this many objects.
[[nodiscard]] constexpr std::size_t packsFor(std::size_t objects) {
  return (objects + kPackedObjects - 1) / kPackedObjects;
}

/// The bounds of 32 objects, grown by the largest radius: an object may overlap a sphere only if
/// the cells and band of the sphere's center are among the object's.
struct alignas(64) PackedBounds {
  /// The first and the last cell along X and Z, modulo kByteCells.
  std::uint8_t least_x[kPackedObjects];
  std::uint8_t most_x[kPackedObjects];
  std::uint8_t least_z[kPackedObjects];
  std::uint8_t most_z[kPackedObjects];
  /// Bit b is set if the object is in a band whose number is b modulo kBands.
  std::uint8_t bands[kPackedObjects];
  /// As bits: the objects that are resting, and those of them that count as in all cells.
  std::uint32_t resting;
  std::uint32_t everywhere;
};

/// The cells, or bands, that bounds cover along one axis.
struct CellSpan {
  std::int32_t first = 0;
  std::int32_t last = 0;
};

/// Bounds of sphere centers, to compare with those of objects.
struct QueryBounds {
  std::uint8_t least_x = 0;
  std::uint8_t most_x = 0;
  std::uint8_t least_z = 0;
  std::uint8_t most_z = 0;
  std::uint8_t bands = kAllBands;
  bool is_everywhere = false;
};

/// The resting objects of an env, which others may share, as bare pointers: the code built for AVX2
/// must not instantiate library templates, which the linker could then share with code for any
/// processor.
struct RestingView {
  /// Bit b of element p stands for object 32 p + b.
  const PackedBounds* bounds = nullptr;
  std::size_t bounds_count = 0;
  const RestingBox* boxes = nullptr;
  std::size_t boxes_count = 0;
  /// One object that is absent: its element of `bounds`, and its bit; 0 if none is.
  std::uint32_t absent_pack = 0;
  std::uint32_t absent = 0;
};

/// Eight spheres of a batch, one in each lane of a register.
struct LaneGroup {
  /// Index of the range, and the group's index in it.
  std::size_t range = 0;
  std::size_t group = 0;
  /// One bit for each sphere that overlaps an object, including the copies that pad the group.
  unsigned lanes = 0;
};

/// Queries about eight spheres at a time. Both versions do the same operations in the same order,
/// and agree bit for bit.
struct RestingKernels {
  /// Moves `at` to the first group, from `at` itself on, with a sphere that overlaps an object;
  /// returns false and leaves `at` undefined if there is none.
  bool (*find_touching)(const RestingView&, const SphereBatch&, LaneGroup& at) noexcept = nullptr;
  /// Whether a sphere (radius at most the largest) whose center is within bounds could overlap an
  /// object. If false, none does.
  bool (*may_touch)(const RestingView&, const CenterBounds&) noexcept = nullptr;
  /// Whether any sphere overlaps any object.
  bool (*touches)(const RestingView&, const BoundedSpheres&) noexcept = nullptr;
};

/// For any processor.
[[nodiscard]] RestingKernels portableResting() noexcept;
/// For processors with AVX2.
[[nodiscard]] RestingKernels avx2Resting() noexcept;

}  // namespace galactic::simulation
