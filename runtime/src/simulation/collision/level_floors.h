#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "galactic/pose.h"
#include "galactic/scene.h"
#include "simulation/collision/clearance_map.h"

namespace galactic::simulation {

/// Where floors are level: one bit for each column of a scene's first grid, set where a base that
/// stands at the floor's height finds it at just that height. Most steps need no other look at the
/// floor. Any thread may ask.
class LevelFloors {
 public:
  /// Adds a floor, by the number of its clearance map: 0, 1, ... `heightFound(center, height)`: the
  /// height at which a base finds the floor in a column when it stood at `height` before, NaN where
  /// none carries it. The floor's height is that of the base `start`.
  template <class HeightFound>
  void add(const ColumnGrid& grid, const Vec3& start, const HeightFound& heightFound);

  /// Whether a base of that height stands on the level floor. `map`: as from ClearanceMaps::add().
  [[nodiscard]] bool isLevel(std::uint32_t map, const Vec3& base) const noexcept {
    if (map == kNoClearanceMap) return false;
    const Floor& floor = floors_[map];
    const float x = (base.x - floor.min_x) * floor.inverse_spacing;
    const float z = (base.z - floor.min_z) * floor.inverse_spacing;
    if (!(base.y == floor.height && x >= 0 && x < floor.columns_x && z >= 0 && z < floor.columns_z))
      return false;
    const auto i = static_cast<std::uint32_t>(x);
    const auto k = static_cast<std::uint32_t>(z);
    const std::size_t word = floor.first + std::size_t{k} * floor.row_words + i / kBits;
    return (words_[word] >> (i % kBits) & 1U) != 0;
  }

 private:
  static constexpr std::uint32_t kBits = 32;

  struct Floor {
    float min_x = 0, min_z = 0, inverse_spacing = 0;
    float columns_x = 0, columns_z = 0;
    float height = 0;
    std::uint32_t row_words = 0;
    std::size_t first = 0;
  };

  std::vector<Floor> floors_;
  std::vector<std::uint32_t> words_;
};

template <class HeightFound>
void LevelFloors::add(const ColumnGrid& grid, const Vec3& start, const HeightFound& heightFound) {
  const ColumnGridLayout& layout = grid.layout();
  Floor floor{.min_x = layout.min_x,
              .min_z = layout.min_z,
              .inverse_spacing = layout.inverse_spacing,
              .columns_x = static_cast<float>(layout.columns_x),
              .columns_z = static_cast<float>(layout.columns_z),
              .height = start.y,
              .row_words = (layout.columns_x + kBits - 1) / kBits,
              .first = words_.size()};
  // Rounding may take the base a few times to the next float before it stays.
  constexpr int kMostRounds = 8;
  for (int round = 0; round < kMostRounds; ++round) floor.height = heightFound(start, floor.height);
  words_.resize(words_.size() + std::size_t{floor.row_words} * layout.columns_z);
  for (std::uint32_t k = 0; k < layout.columns_z; ++k) {
    std::uint32_t* row = words_.data() + floor.first + std::size_t{k} * floor.row_words;
    for (std::uint32_t i = 0; i < layout.columns_x; ++i) {
      const Vec3 center{layout.min_x + (static_cast<float>(i) + 0.5F) * layout.spacing, floor.height,
                        layout.min_z + (static_cast<float>(k) + 0.5F) * layout.spacing};
      if (heightFound(center, floor.height) == floor.height) row[i / kBits] |= 1U << (i % kBits);
    }
  }
  floors_.push_back(floor);
}

}  // namespace galactic::simulation
