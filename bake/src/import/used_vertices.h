#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/bake/source_asset.h"

namespace galactic::bake {

/// The new index of a vertex that no triangle uses.
inline constexpr std::uint32_t kUnused = ~std::uint32_t{0};

/// The new index of each of `count` vertices after unused ones are dropped; the order stays.
/// Corners must be below `count`.
[[nodiscard]] inline std::vector<std::uint32_t> placesOfUsed(std::size_t count,
                                                             std::span<const Triangle> triangles) {
  std::vector<std::uint32_t> places(count, kUnused);
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t corner : triangle) places[corner] = 0;
  }
  std::uint32_t used = 0;
  for (std::uint32_t& place : places) {
    if (place != kUnused) place = used++;
  }
  return places;
}

/// Moves the values of used vertices to their new indices and drops the others.
template <class Value>
void keepUsed(const std::vector<std::uint32_t>& places, std::vector<Value>& values) {
  std::size_t used = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (places[n] != kUnused) values[used++] = values[n];
  }
  values.resize(used);
}

inline void moveCorners(const std::vector<std::uint32_t>& places,
                        std::vector<Triangle>& triangles) {
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = places[corner];
  }
}

}  // namespace galactic::bake
