#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "galactic/pack.h"
#include "galactic/scene.h"
#include "support/oracles/resting_oracle.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test {

/// An axis-aligned block of the static scene.
struct Block {
  Vec3 min;
  Vec3 max;
};

/// A scene of blocks whose column grids follow from geometry: above or below a point, a ball of
/// radius r touches a block exactly between min.y - s and max.y + s with s = sqrt(r^2 - d^2), where
/// d is the horizontal distance from the block.
class BoxRoom {
 public:
  static constexpr std::array<float, 3> kRadii{0.015F, 0.05F, 0.12F};
  /// Exact in floats, and 3 cm nearly; grid lines lie at multiples of it.
  static constexpr float kSpacing = 0.03125F;
  static constexpr std::uint32_t kColumns = 96;
  static constexpr float kSize = kSpacing * kColumns;
  static constexpr Span kHeights{-0.5F, 3};

  /// `columns`: along each edge of the same room.
  explicit BoxRoom(std::vector<Block> blocks, std::uint32_t columns = kColumns)
      : blocks_(std::move(blocks)),
        columns_(columns),
        spacing_(kSize / static_cast<float>(columns)) {
    bytes_ = buildPack(fields());
    pack_ =
        std::make_unique<PackFile>(PackFile::view(bytes_.bytes(), "room", Trust::kTrusted).value());
    scene_ = std::make_unique<Scene>(Scene::from(*pack_).value());
  }

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  /// The scene's pack.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_.bytes(); }

  /// Its scene pack; for a file, all radii must be at least half the spacing.
  [[nodiscard]] ScenePackFields fields(std::span<const float> radii = kRadii) const {
    ScenePackFields fields;
    for (const float radius : radii) fields.grids.emplace_back(buildGrid(radius));
    return fields;
  }

  /// Whether the grid's exact counterpart blocks a center: outside, or too near to a block in the
  /// middle of the center's cell.
  [[nodiscard]] bool isBlocked(const Point3& center, double radius) const {
    Point3 at = center;
    for (const std::size_t axis : {0U, 2U}) {
      const double cell = std::floor(center[axis] / static_cast<double>(spacing_));
      if (!(cell >= 0 && cell < columns_)) return true;
      at[axis] = (cell + 0.5) * static_cast<double>(spacing_);
    }
    if (center[1] < static_cast<double>(kHeights.lo)) return true;
    return std::any_of(blocks_.begin(), blocks_.end(),
                       [&](const Block& block) { return distance(at, block) < radius; });
  }

  static double distance(const Point3& point, const Block& block) {
    const Point3 lo = toPoint3(block.min);
    const Point3 hi = toPoint3(block.max);
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double beyond = std::max({lo[axis] - point[axis], point[axis] - hi[axis], 0.0});
      sum += beyond * beyond;
    }
    return std::sqrt(sum);
  }

 private:
  [[nodiscard]] TestGrid buildGrid(float radius) const {
    GridSpec spec{.radius = radius,
                  .spacing = spacing_,
                  .heights = kHeights,
                  .quantum = 0x1p-14F,
                  .columns_x = columns_,
                  .columns_z = columns_};
    GridBuilder builder(spec);
    for (std::uint32_t k = 0; k < columns_; ++k) {
      for (std::uint32_t i = 0; i < columns_; ++i) {
        builder.column(i, k, freeSpans(i, k, static_cast<double>(radius)));
      }
    }
    return builder.build();
  }

  [[nodiscard]] std::vector<Span> freeSpans(std::uint32_t i, std::uint32_t k, double radius) const {
    const double x = (i + 0.5) * static_cast<double>(spacing_);
    const double z = (k + 0.5) * static_cast<double>(spacing_);
    std::vector<std::array<double, 2>> blocked;
    for (const Block& block : blocks_) {
      const double aside = distance({x, static_cast<double>(block.min.y), z}, block);
      if (!(aside < radius)) continue;
      const double reach = std::sqrt(radius * radius - aside * aside);
      blocked.push_back(
          {static_cast<double>(block.min.y) - reach, static_cast<double>(block.max.y) + reach});
    }
    std::sort(blocked.begin(), blocked.end());
    std::vector<Span> free;
    auto from = static_cast<double>(kHeights.lo);
    const auto add = [&](double to) {
      constexpr double kThin = 1e-3;
      if (to - from > kThin) free.push_back({static_cast<float>(from), static_cast<float>(to)});
    };
    for (const auto& [lo, hi] : blocked) {
      add(lo);
      from = std::max(from, hi);
    }
    add(static_cast<double>(kHeights.hi));
    return free;
  }

  std::vector<Block> blocks_;
  std::uint32_t columns_;
  float spacing_;
  AlignedBytes bytes_;
  std::unique_ptr<PackFile> pack_;
  std::unique_ptr<Scene> scene_;
};

/// A room with `pieces` of furniture, of random places and heights, on a floor at height 0.
inline BoxRoom furnishedRoom(std::mt19937& random, int pieces) {
  std::vector<Block> blocks{{{-1, -0.4F, -1}, {4, 0, 4}}};
  for (int n = 0; n < pieces; ++n) {
    const float x = uniformIn(random, 0, 2.5F);
    const float z = uniformIn(random, 0, 2.5F);
    blocks.push_back({{x, 0, z}, {x + 0.4F, uniformIn(random, 0.1F, 1.2F), z + 0.3F}});
  }
  return BoxRoom(std::move(blocks));
}

}  // namespace galactic::test
