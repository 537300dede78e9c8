#pragma once
#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "support/packs/grid_builder.h"

namespace galactic::test {

/// The height at which ScatteredGrid's blocks differ from its free cells, meters.
inline constexpr float kCutHeight = 1;

/// A grid whose columns are free below 2 m but for scattered cells and blocks.
class ScatteredGrid {
 public:
  ScatteredGrid(std::uint32_t seed, std::uint32_t columns_x, std::uint32_t columns_z)
      : columns_x_(columns_x), columns_z_(columns_z) {
    std::mt19937 random(seed);
    std::vector<bool> blocked(std::size_t{columns_x} * columns_z);
    const auto below = [&random](std::uint64_t end) {
      return static_cast<std::uint32_t>(random() % end);
    };
    const auto block = [&](std::uint32_t i, std::uint32_t k, std::uint32_t nx, std::uint32_t nz) {
      for (std::uint32_t b = k; b < std::min(k + nz, columns_z); ++b) {
        for (std::uint32_t a = i; a < std::min(i + nx, columns_x); ++a) {
          blocked[std::size_t{b} * columns_x + a] = true;
        }
      }
    };
    const std::uint32_t blocks = 6 + below(12);
    for (std::uint32_t n = 0; n < blocks; ++n) {
      const std::uint32_t i = below(columns_x);
      const std::uint32_t k = below(columns_z);
      const std::uint32_t nx = 1 + below(9);
      block(i, k, nx, 1 + below(9));
    }
    const std::uint32_t single = below(columns_x * columns_z / 40 + 1);
    for (std::uint32_t n = 0; n < single; ++n) {
      const std::uint32_t i = below(columns_x);
      block(i, below(columns_z), 1, 1);
    }
    GridBuilder builder({.radius = 0.015F,
                         .spacing = kSpacing,
                         .min_x = kMinX,
                         .min_z = kMinZ,
                         .heights = {0, 2},
                         .columns_x = columns_x,
                         .columns_z = columns_z});
    for (std::uint32_t k = 0; k < columns_z; ++k) {
      for (std::uint32_t i = 0; i < columns_x; ++i) {
        // A table, or nothing.
        const bool is_blocked = blocked[std::size_t{k} * columns_x + i];
        builder.column(
            i, k, is_blocked ? std::vector<Span>{{0, 0.5F}, {1.5F, 2}} : std::vector<Span>{{0, 2}});
      }
    }
    grid_ = builder.build();
    blocked_ = std::move(blocked);
  }

  static constexpr float kSpacing = 0.03125F;
  static constexpr float kMinX = -0.5F;
  static constexpr float kMinZ = 0.25F;

  [[nodiscard]] ColumnGrid view() const { return grid_.view(); }
  [[nodiscard]] std::int64_t columnsX() const { return columns_x_; }
  [[nodiscard]] std::int64_t columnsZ() const { return columns_z_; }

  /// At kCutHeight; also what lies outside.
  [[nodiscard]] bool isBlocked(std::int64_t i, std::int64_t k) const {
    if (i < 0 || k < 0 || i >= columns_x_ || k >= columns_z_) return true;
    return blocked_[static_cast<std::size_t>(k * columns_x_ + i)];
  }

 private:
  std::int64_t columns_x_;
  std::int64_t columns_z_;
  TestGrid grid_;
  std::vector<bool> blocked_;
};

}  // namespace galactic::test
