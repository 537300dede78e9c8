#pragma once
#include <string>
#include <vector>

#include "galactic/column_grid.h"
#include "pack_tool/verbs/verbs.h"

namespace galactic::pack_tool {

/// A level rectangle that closes free space from below (floor) or above (ceiling); world frame,
/// meters.
struct Patch {
  enum class Side { kFloor, kCeiling };

  float min_x = 0;
  float max_x = 0;
  float min_z = 0;
  float max_z = 0;
  float y = 0;
  Side side = Side::kFloor;
};

struct GridMeshOptions {
  PatchHeight height = PatchHeight::kSphereCenter;
  MeshParts parts = MeshParts::kFloorsAndCeilings;
};

/// The ends of all free spans as patches. Neighboring cells at exactly the same height share one
/// patch where they form a rectangle. Without the walls between heights: they would hide the rest.
[[nodiscard]] std::vector<Patch> gridPatches(const ColumnGrid& grid,
                                             const GridMeshOptions& options);

/// The most patches that a mesh file may hold: its indices are 32 signed bits.
inline constexpr std::size_t kMaxPatches = (std::size_t{1} << 31) / 4 - 1;

/// The patches as a binary PLY file: quads that face free space, colored by height (floors) or
/// gray (ceilings). At most kMaxPatches.
[[nodiscard]] std::string encodePly(const std::vector<Patch>& patches);

/// The patches as an OBJ file: the objects "floors" and "ceilings" of quads that face free space,
/// without colors. At most kMaxPatches.
[[nodiscard]] std::string encodeObj(const std::vector<Patch>& patches);

}  // namespace galactic::pack_tool
