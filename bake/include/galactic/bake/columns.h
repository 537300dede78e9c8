#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/error.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// Where the columns of a grid stand. The numbers are floats because the pack stores them as such;
/// positions are computed from them in double.
struct GridFrame {
  float radius = 0;
  float spacing = 0;
  /// Corner of cell (0, 0).
  float min_x = 0;
  float min_z = 0;
  /// Heights between which the grid is built.
  Span heights;
  std::uint32_t columns_x = 0;
  std::uint32_t columns_z = 0;

  [[nodiscard]] double centerX(std::uint32_t i) const {
    return static_cast<double>(min_x) + (i + 0.5) * static_cast<double>(spacing);
  }
  [[nodiscard]] double centerZ(std::uint32_t k) const {
    return static_cast<double>(min_z) + (k + 0.5) * static_cast<double>(spacing);
  }
  [[nodiscard]] std::size_t columnCount() const { return std::size_t{columns_x} * columns_z; }
};

/// The bounds of the scene that a frame was made for: the frame without its padding, accurate to
/// within a cell at the far ends in the plane.
[[nodiscard]] Bounds sceneBounds(const GridFrame& frame);

/// The frame for a scene: its bounds padded by the radius and one cell in the plane (so that the
/// border columns touch nothing), and by the radius and 1 cm in height. Fails with kInvalidInput if
/// the radius is less than half the spacing, or if there would be more cells than a grid may have;
/// the error's `where` is the option in backquotes.
[[nodiscard]] Result<GridFrame> makeGridFrame(const Bounds& bounds, float radius, float spacing);

/// Free spans of all columns, ascending and disjoint in each column, row by row (i fastest).
struct Columns {
  GridFrame frame;
  /// Prefix sums into spans. Shape: columnCount() + 1.
  std::vector<std::uint32_t> first;
  std::vector<Span> spans;

  [[nodiscard]] std::span<const Span> column(std::size_t index) const {
    return std::span(spans).subspan(first[index], first[index + 1] - first[index]);
  }
  [[nodiscard]] std::size_t index(std::uint32_t i, std::uint32_t k) const {
    return std::size_t{k} * frame.columns_x + i;
  }
};

/// Gaps between blocked intervals up to this width are closed: smaller gaps are float rounding.
inline constexpr float kMergeTolerance = 1e-5F;

/// What part of space a component is; see schema/column_grid.fbs.
enum class Region : std::uint8_t { kRoom = 0, kOutside = 1, kEnclosed = 2 };
inline constexpr std::size_t kRegionCount = 3;

/// Which free space to store.
enum class Keep { kRoom, kAll };

struct FreeSpaceOptions {
  Keep keep = Keep::kRoom;
  /// Points (world frame) whose components are the room. Empty: the largest components.
  std::vector<Vec3> seeds{};
  /// How many of the largest components are the room when there are no seeds.
  std::uint32_t components = 1;

  friend bool operator==(const FreeSpaceOptions&, const FreeSpaceOptions&) = default;
};

/// One connected part of the free space.
struct Component {
  Region region = Region::kEnclosed;
  bool touches_border = false;
  /// In how many columns it reaches the edge of the scene's bounds, in x or z. 0 for a closed room.
  std::uint64_t columns_at_edge = 0;
  std::uint64_t spans = 0;
  /// Volume of sphere centers, cubic meters.
  double volume = 0;
  /// Floor on which a robot could stand, square meters. `floor`: under a roof or, if walls enclose
  /// the scene on all sides, under the sky. `yard`: under the sky in other scenes.
  double floor = 0;
  double yard = 0;
  /// Height of its tallest span, meters.
  float greatest_height = 0;
  /// The part of `volume` within the scene's bounds. The padding around a small scene can hold more
  /// than the scene.
  double volume_inside = 0;
  /// The parts of `volume_inside` in spans that end above and below these bounds.
  double volume_open_above = 0;
  double volume_open_below = 0;
  /// Bounds of its columns and spans.
  Bounds bounds;

  /// Whether it is the inside of something flat, such as a floor.
  [[nodiscard]] bool isSlab() const {
    constexpr float kThin = 0.3F;
    return !touches_border && greatest_height < kThin;
  }
};

struct RegionTotals {
  std::uint32_t components = 0;
  std::uint64_t spans = 0;
  double volume = 0;
};

struct FreeSpace {
  /// What is kept.
  Columns columns;
  /// The room alone, where more is kept; else empty.
  Columns room_of_all;
  /// Every component, by descending volume.
  std::vector<Component> components;
  /// Totals by region, indexed by Region.
  std::array<RegionTotals, kRegionCount> totals{};
};

/// Flood fill: spans that overlap in height in neighboring columns are connected. The room is what
/// the seeds reach. Without seeds, it is the component with the most floor or, if none has 4 m² of
/// floor, the one with the most volume inside the scene's bounds, slabs last. Other components that
/// reach the border are outside, and the rest are enclosed. Fails with kInvalidInput if a seed is
/// not in free space. `wider_room`: the room of the same scene for spheres of a smaller radius.
/// Without seeds, only space that lies in it can be the room, so that all radii have the same room.
[[nodiscard]] Result<FreeSpace> chooseFreeSpace(const Columns& columns,
                                                const FreeSpaceOptions& options = {},
                                                const Columns* wider_room = nullptr);

/// A grid in the layout of schema/column_grid.fbs, ready to be written or queried in place.
struct EncodedGrid {
  GridFrame frame;
  float quantum = 0;
  std::vector<std::uint64_t> cells;
  std::vector<std::uint16_t> tile_base;
  /// One of the next two is empty: `overflow_spans` has heights if there are tile bases; otherwise
  /// `overflow_codes` has pairs of codes. The spans of each overflow cell end with an end mark.
  std::vector<std::uint32_t> overflow_codes;
  std::vector<Span> overflow_spans;
  /// Spans stored, and those dropped because they are thinner than the quantum.
  std::uint64_t spans = 0;
  std::uint64_t slivers = 0;
  std::uint32_t max_spans_per_column = 0;
  std::uint64_t overflow_columns = 0;
};

/// Bytes of the grid's cells and overflow spans.
[[nodiscard]] std::uint64_t storedBytes(const EncodedGrid& grid);

/// Largest height of a code, meters. Since ends are rounded to the blocked side, no stored end is
/// further than this from the exact one.
inline constexpr float kMaxQuantum = 9.5e-5F;

/// Encodes the columns' spans. Every end is rounded to the blocked side, so the stored grid is
/// never freer than `columns`.
[[nodiscard]] EncodedGrid encodeGrid(const Columns& columns);

}  // namespace galactic::bake
