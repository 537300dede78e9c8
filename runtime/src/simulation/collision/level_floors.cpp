#include "simulation/collision/level_floors.h"

#include <algorithm>
#include <cassert>

namespace galactic::simulation {

void LevelFloors::add(const LevelFloor& floor) {
  floors_.push_back(floor.layout);
  floors_.back().first += words_.size();
  words_.insert(words_.end(), floor.words.begin(), floor.words.end());
}

// Loops without branches and of known length, so that the compiler vectorizes all but the look-up
// itself.
bool LevelFloors::heightsUnder(std::uint32_t map, const Bases& bases,
                               float* heights) const noexcept {
  assert(bases.count % kLanes == 0);
  std::int32_t all = 1;
  for (std::size_t first = 0; first < bases.count; first += kLanes) {
    all &= heightsOfEight(floors_[map], bases, first, heights + first);
  }
  return all != 0;
}

std::int32_t LevelFloors::heightsOfEight(const LevelFloorLayout& floor, const Bases& bases,
                                         std::size_t first, float* heights) const noexcept {
  using Whole = std::array<std::int32_t, kLanes>;
  Whole i;
  Whole k;
  Whole is_inside;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const float x = (bases.x[first + n] - floor.min_x) * floor.inverse_spacing;
    const float z = (bases.z[first + n] - floor.min_z) * floor.inverse_spacing;
    const float least = std::min(x, z);
    const bool inside = (least >= 0) & (x < floor.columns_x) & (z < floor.columns_z);
    // Bases outside of the grid look up the first column.
    i[n] = static_cast<std::int32_t>(inside ? x : 0);
    k[n] = static_cast<std::int32_t>(inside ? z : 0);
    is_inside[n] = inside ? 1 : 0;
  }
  std::uint32_t known = 1;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const auto column = static_cast<std::uint32_t>(i[n]);
    known &= words_[floor.wordOf(column, static_cast<std::uint32_t>(k[n]))] >> (column % kBits);
  }
  Whole is_height{};
  std::array<float, kLanes> found{};
  for (std::uint32_t h = 0; h < floor.height_count; ++h) {
    for (std::size_t n = 0; n < kLanes; ++n) {
      const bool is_this = bases.y[first + n] == floor.heights[h];
      is_height[n] = is_this ? 1 : is_height[n];
      found[n] = is_this ? floor.heights[h + 1] : found[n];
    }
  }
  std::ranges::copy(found, heights);
  auto all = static_cast<std::int32_t>(known);
  for (std::size_t n = 0; n < kLanes; ++n) all &= is_inside[n] & is_height[n];
  return all;
}

}  // namespace galactic::simulation
