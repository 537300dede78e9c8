#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/resting_box.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

// Which objects a query has to look at. A grid of lists, such as the paper's four shifted regular
// grids (appendix G), answers that for one sphere; here all objects of an env are asked at once. Of
// each, the bounds are kept in bytes, as in the nodes of compressed wide hierarchies (Ylitie,
// Karras and Laine 2017), axis by axis, so that some thirty instructions compare the bounds of a
// query with those of 32 objects: of one sphere, of eight, or of a whole robot. That takes 192
// bytes where windows of a grid take 8,000 and their strips 640, so little that envs which have
// moved nothing share it, and the first object that one lays down copies it.
//
// The bytes wrap around: cell n stands for every 256th one, 32 meters apart. No scene is too large,
// and nothing has to be clamped. What is in another room at the same place on the torus is found
// and refused by the test of distances, and so is what shares no more than a cell.

/// Edge of a cell and height of a band, meters: powers of two, so that no rounding is involved.
inline constexpr float kCellEdge = 0.125F;
inline constexpr float kBandHeight = 0.25F;
/// Coordinates from here on, in cells, are not told apart.
inline constexpr float kFarthestCell = 0x1p29F;
/// Cells along an axis, as many as a byte tells apart.
inline constexpr std::int32_t kByteCells = 256;
/// Bits of a byte; 2 meters.
inline constexpr std::int32_t kBands = 8;
inline constexpr std::uint8_t kAllBands = 0xff;
/// Bounds that reach further, in cells, are everywhere. Those of an object and of a query together
/// stay below half a turn, so that the sign of a difference says which of two cells comes first.
inline constexpr std::int32_t kMostByteCells = kByteCells / 4 - 1;

/// Objects whose bounds are packed together.
inline constexpr std::uint32_t kPackedObjects = 32;

/// Elements of PackedBounds for so many objects.
[[nodiscard]] constexpr std::size_t packsFor(std::size_t objects) {
  return (objects + kPackedObjects - 1) / kPackedObjects;
}

/// The bounds of 32 objects, grown by the largest radius: an object is near a center whose cells
/// and band are among its own.
struct alignas(64) PackedBounds {
  /// Of the first and the last cell, modulo kByteCells.
  std::uint8_t least_x[kPackedObjects];
  std::uint8_t most_x[kPackedObjects];
  std::uint8_t least_z[kPackedObjects];
  std::uint8_t most_z[kPackedObjects];
  /// Bit b: in a band whose number is b modulo kBands.
  std::uint8_t bands[kPackedObjects];
  /// As bits: objects that are there at all, and those of them that are in any cell.
  std::uint32_t resting;
  std::uint32_t everywhere;
};

/// The cells and bands of one axis that bounds reach over.
struct CellSpan {
  std::int32_t first = 0;
  std::int32_t last = 0;
};

/// Bounds of centers, to compare with those of objects.
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
  /// One of them that is not there: in which element, and its bit. 0: there is none.
  std::uint32_t absent_pack = 0;
  std::uint32_t absent = 0;
};

/// Eight spheres of a batch, one in each lane of a register.
struct LaneGroup {
  /// Index of the range, and the group's index in it.
  std::size_t range = 0;
  std::size_t group = 0;
  /// A bit for each sphere that overlaps an object; copies that fill the group have theirs too.
  unsigned lanes = 0;
};

/// What is asked of eight spheres at a time. Both versions do the same operations in the same
/// order, and agree bit for bit.
struct RestingKernels {
  /// Moves `at` on to the first group, `at` itself or later, with a sphere that overlaps an object;
  /// false, with `at` anywhere, when there is none.
  bool (*find_touching)(const RestingView&, const SphereBatch&, LaneGroup& at) noexcept = nullptr;
  /// Whether a sphere, of the largest radius at most, whose center is within bounds could overlap
  /// an object. No means no.
  bool (*may_touch)(const RestingView&, const CenterBounds&) noexcept = nullptr;
  /// Whether any sphere overlaps any object.
  bool (*touches)(const RestingView&, const BoundedSpheres&) noexcept = nullptr;
};

/// For any processor.
[[nodiscard]] RestingKernels portableResting() noexcept;
/// For processors with AVX2.
[[nodiscard]] RestingKernels avx2Resting() noexcept;

}  // namespace galactic::simulation
