#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/pose.h"
#include "galactic/scene.h"
#include "simulation/collision/clearance_map.h"

namespace galactic::simulation {

/// How the columns of a floor's grid map to bits in words, in rows along X.
struct LevelFloorLayout {
  static constexpr std::uint32_t kBits = 32;
  static constexpr std::uint32_t kMostHeights = 8;

  [[nodiscard]] std::size_t wordOf(std::uint32_t i, std::uint32_t k) const {
    return first + std::size_t{k} * row_words + i / kBits;
  }

  float min_x = 0, min_z = 0, inverse_spacing = 0;
  float columns_x = 0, columns_z = 0;
  /// Heights each of which leads to the next; the last one repeats the first.
  std::array<float, kMostHeights + 1> heights{};
  std::uint32_t height_count = 0;
  std::uint32_t row_words = 0;
  std::size_t first = 0;
};

/// One floor: see LevelFloors. `layout` counts from the first word.
struct LevelFloor {
  LevelFloorLayout layout;
  std::vector<std::uint32_t> words;
};

/// Makes the bits of one floor, whose height is that of the base `start`. `height_found(center,
/// height)`: the height at which a base that stood at `height` finds the floor in a column; NaN if
/// no floor carries it there.
template <class HeightFound>
[[nodiscard]] LevelFloor makeLevelFloor(const ColumnGrid& grid, const Vec3& start,
                                        const HeightFound& height_found) {
  const ColumnGridLayout& from = grid.layout();
  constexpr std::uint32_t kBits = LevelFloorLayout::kBits;
  constexpr std::uint32_t kMostHeights = LevelFloorLayout::kMostHeights;
  LevelFloor made;
  LevelFloorLayout& floor = made.layout;
  floor.min_x = from.min_x;
  floor.min_z = from.min_z;
  floor.inverse_spacing = from.inverse_spacing;
  floor.columns_x = static_cast<float>(from.columns_x);
  floor.columns_z = static_cast<float>(from.columns_z);
  floor.row_words = (from.columns_x + kBits - 1) / kBits;
  std::array<float, kMostHeights + 1>& heights = floor.heights;
  heights[0] = start.y;
  for (std::uint32_t n = 0; n < kMostHeights; ++n) heights[0] = height_found(start, heights[0]);
  for (std::uint32_t n = 0; n < kMostHeights && floor.height_count == 0; ++n) {
    heights[n + 1] = height_found(start, heights[n]);
    if (heights[n + 1] == heights[0]) floor.height_count = n + 1;
  }
  const auto stays_level = [&](const Vec3& center) {
    bool is_level = floor.height_count > 0;
    for (std::uint32_t n = 0; n < floor.height_count; ++n) {
      is_level = is_level && height_found(center, heights[n]) == heights[n + 1];
    }
    return is_level;
  };
  made.words.resize(std::size_t{floor.row_words} * from.columns_z);
  for (std::uint32_t k = 0; k < from.columns_z; ++k) {
    for (std::uint32_t i = 0; i < from.columns_x; ++i) {
      const Vec3 center{from.min_x + (static_cast<float>(i) + 0.5F) * from.spacing, 0,
                        from.min_z + (static_cast<float>(k) + 0.5F) * from.spacing};
      if (stays_level(center)) made.words[floor.wordOf(i, k)] |= 1U << (i % kBits);
    }
  }
  return made;
}

/// Where floors are level: one bit for each column of a scene's first grid, set if a base that
/// stands on the floor finds it at the floor's height again. Most steps need no other query of the
/// floor. Const members may be called from any thread. Rounding may move a base that stands still
/// to the next float in each step, and back after a few steps. So a floor has a cycle of heights,
/// each of which leads to the next.
class LevelFloors {
 public:
  /// Adds a floor. Its number is that of its clearance map: 1, 2, ...
  void add(const LevelFloor& floor);

  /// The height at which a base finds the floor; none if it is not known. `map`: as from
  /// ClearanceMaps::add(). `base`: its y is the height at which it stood before.
  [[nodiscard]] std::optional<float> heightUnder(std::uint32_t map,
                                                 const Vec3& base) const noexcept {
    const LevelFloorLayout& floor = floors_[map];
    const float x = (base.x - floor.min_x) * floor.inverse_spacing;
    const float z = (base.z - floor.min_z) * floor.inverse_spacing;
    const bool is_inside = x >= 0 && x < floor.columns_x && z >= 0 && z < floor.columns_z;
    if (!is_inside) return std::nullopt;
    const auto i = static_cast<std::uint32_t>(x);
    const auto k = static_cast<std::uint32_t>(z);
    if ((words_[floor.wordOf(i, k)] >> (i % kBits) & 1U) == 0) return std::nullopt;
    // Which height it is is unpredictable, so there is no branch.
    std::uint32_t is_height = 0;
    for (std::uint32_t n = 0; n < floor.height_count; ++n) {
      is_height |= (base.y == floor.heights[n] ? 1U : 0U) << n;
    }
    if (is_height == 0) return std::nullopt;
    return floor.heights[static_cast<std::size_t>(std::countr_zero(is_height)) + 1];
  }

  /// Bases over one floor, a multiple of kLanes. `y`: the heights at which they stood before.
  struct Bases {
    const float* x = nullptr;
    const float* y = nullptr;
    const float* z = nullptr;
    std::size_t count = 0;
  };

  /// The same for several bases. Returns whether all heights are known; writes `heights` in any
  /// case.
  [[nodiscard]] bool heightsUnder(std::uint32_t map, const Bases& bases,
                                  float* heights) const noexcept;

  [[nodiscard]] std::size_t bytes() const noexcept {
    return std::span(floors_).size_bytes() + std::span(words_).size_bytes();
  }

 private:
  static constexpr std::uint32_t kBits = LevelFloorLayout::kBits;

  /// 1 if all heights of the eight bases from `first` on are known, else 0.
  std::int32_t heightsOfEight(const LevelFloorLayout& floor, const Bases& bases, std::size_t first,
                              float* heights) const noexcept;

  /// The first layout, for kNoClearanceMap, has no width.
  std::vector<LevelFloorLayout> floors_ = std::vector<LevelFloorLayout>(1);
  /// The first word, which is 0, answers for places outside of all floors.
  std::vector<std::uint32_t> words_ = {0};
};

}  // namespace galactic::simulation
