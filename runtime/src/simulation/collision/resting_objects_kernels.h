#pragma once
#include <cstddef>
#include <cstdint>

#include "simulation/collision/resting_box.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

// The four shifted regular grids of the paper (appendix G), as they are stored here.
//
// A cell of the paper is at least four times the largest radius wide; the second grid is shifted by
// half a cell in x, the third in z, the fourth in both, so any sphere of the working set lies
// inside one cell of one of them, and only that cell's list is read. The cells of all four begin at
// the points of one lattice and each point begins exactly one cell, so the four grids are one array
// of overlapping windows, and which of them holds a sphere follows from the lattice square around
// its center: a window answers for the centers in one square and knows the objects whose bounds
// come within the largest radius of it. Three more steps make it small and fast:
//
// - Bounds are boxes, so a window knows an object exactly when the window's strip along x and its
//   strip along z both do. Only the strips are stored, as sets of bits: a window is the
//   intersection of two words. That is 640 bytes per env for a room for which the windows take
//   8,000, so that thousands of envs stay in the cache, and it makes grasping and dropping cheap.
// - A third set, by height, leaves out what stands on the shelf above or the floor below.
// - The strips wrap around: strip n stands for every 64th square, 16 meters apart. No scene is too
//   large, nothing has to be clamped, and a coordinate becomes a strip in three instructions. What
//   stands in another room at the same place on the torus is found and refused by the next test.

/// Edge of a square and height of a band, meters: a power of two, so that no rounding is involved.
/// Smaller squares leave out few more objects and take more memory; see
/// benchmarks/simulation/resting_objects.
inline constexpr float kSquareEdge = 0.25F;
inline constexpr float kInverseSquareEdge = 1 / kSquareEdge;
/// Sets of each horizontal axis, a power of two; 16 meters.
inline constexpr std::uint32_t kStrips = 64;
/// Sets of the vertical axis: as many words as a register holds; 2 meters.
inline constexpr std::uint32_t kBands = 8;
/// So many strips one after the other can be read without a look at where they wrap around: the
/// first ones follow once more after the last.
inline constexpr std::uint32_t kRun = 8;

/// 32 objects as bits in sets: of strip i, those that come within the largest radius of a square
/// whose number along that axis is i modulo the number of sets. Square n of an axis reaches from
/// n - 1/2 to n + 1/2 edges.
struct alignas(64) SetPlane {
  std::uint32_t along_x[kStrips + kRun];
  std::uint32_t along_z[kStrips + kRun];
  std::uint32_t at_height[kBands];
};

/// Objects of a plane.
inline constexpr std::uint32_t kPlaneObjects = 32;

/// The resting objects of one env as bare pointers: the code built for AVX2 must not instantiate
/// library templates, which the linker could then share with code for any processor.
struct RestingView {
  /// Bit b of plane p stands for object 32 p + b.
  const SetPlane* planes = nullptr;
  std::size_t plane_count = 0;
  const RestingBox* boxes = nullptr;
};

/// Eight spheres of a batch, one in each lane of a register.
struct LaneGroup {
  /// Index of the range, and the group's index in it.
  std::size_t range = 0;
  std::size_t group = 0;
  /// A bit for each sphere that overlaps an object; copies that fill the group have theirs too.
  unsigned lanes = 0;
};

/// Moves `at` on to the first group, `at` itself or later, with a sphere that overlaps an object;
/// false, with `at` anywhere, when there is none.
bool findTouchingPortable(const RestingView& objects, const SphereBatch& spheres,
                          LaneGroup& at) noexcept;

/// The same, eight spheres at a time. Call it only where detail::hasAvx2(). Bit for bit the answers
/// of the portable one: both do the same operations in the same order, and none is contracted.
bool findTouchingAvx2(const RestingView& objects, const SphereBatch& spheres,
                      LaneGroup& at) noexcept;

}  // namespace galactic::simulation
