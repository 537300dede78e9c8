#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "galactic/bake/columns.h"
#include "galactic/error.h"

namespace galactic::bake {

/// What part of space a component is; see schema/column_grid.fbs.
enum class Region : std::uint8_t { kRoom = 0, kOutside = 1, kEnclosed = 2 };
inline constexpr std::size_t kRegionCount = 3;

/// What to store.
enum class Keep { kRoom, kAll };

struct FreeSpaceOptions {
  Keep keep = Keep::kRoom;
  /// Points (world frame) whose components are the room. Empty: the largest components by volume.
  std::vector<Vec3> seeds{};
  /// How many of the largest components are the room when there are no seeds.
  std::uint32_t components = 1;
};

/// One connected part of the free space.
struct Component {
  Region region = Region::kEnclosed;
  bool touches_border = false;
  /// Where it reaches the edge of the scene's bounds, x and z, ascending z then x: the first place,
  /// and how many columns of the edge it has. Of a closed room none.
  Vec3 first_at_edge;
  std::uint64_t columns_at_edge = 0;
  std::uint64_t spans = 0;
  /// Cubic meters of sphere centers.
  double volume = 0;
  /// The part of it within the scene's bounds: what makes a component the room. The padding around
  /// a small scene can hold more than the scene.
  double volume_inside = 0;
  /// Bounds of its columns and spans.
  Bounds bounds;
};

struct RegionTotals {
  std::uint32_t components = 0;
  std::uint64_t spans = 0;
  double volume = 0;
};

struct FreeSpace {
  /// What is kept.
  Columns columns;
  /// Every component by falling volume.
  std::vector<Component> components;
  /// Totals by region, indexed by Region.
  std::array<RegionTotals, kRegionCount> totals{};
};

/// Flood fill: spans that overlap in height in neighboring columns are connected. The room is what
/// the seeds reach, else the largest components by volume inside the scene's bounds; other
/// components that reach the border are outside, the rest enclosed. Fails with kInvalidInput when a
/// seed is not in free space.
[[nodiscard]] Result<FreeSpace> chooseFreeSpace(const Columns& columns,
                                                const FreeSpaceOptions& options = {});

}  // namespace galactic::bake
