#include "column_grid/grid_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>

#include "column_grid/column_grid_kernels.h"

namespace galactic::detail {
namespace {

/// Cells along each side of a block.
constexpr std::uint32_t kBlockCells = 4;

constexpr Span kNoHeights{std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()};

std::uint32_t blocksOf(std::uint32_t columns) { return (columns + kBlockCells - 1) / kBlockCells; }

float heightOf(const Span& span) { return span.hi - span.lo; }

std::vector<Span> intersection(const std::vector<Span>& a, const std::vector<Span>& b) {
  std::vector<Span> both;
  for (const Span& one : a) {
    for (const Span& other : b) {
      const Span common{std::max(one.lo, other.lo), std::min(one.hi, other.hi)};
      if (common.lo <= common.hi) both.push_back(common);
    }
  }
  return both;
}

/// Signed distance from the nearest point of an interval to `at`.
float offsetFrom(float lo, float hi, float at) {
  if (at < lo) return at - lo;
  return at > hi ? at - hi : 0;
}

/// The squares of a grid and the place of a center among them.
class Squares {
 public:
  /// Each square has `cells` x `cells` cells.
  Squares(const ColumnGridLayout& grid, const Vec3& center, std::uint32_t cells)
      : edge_(grid.spacing * static_cast<float>(cells)),
        // Computed as queries do, so that rounding never separates a center from its column.
        x_((center.x - grid.min_x) * grid.inverse_spacing / static_cast<float>(cells)),
        z_((center.z - grid.min_z) * grid.inverse_spacing / static_cast<float>(cells)),
        count_x_(static_cast<std::int32_t>((grid.columns_x + cells - 1) / cells)),
        count_z_(static_cast<std::int32_t>((grid.columns_z + cells - 1) / cells)) {}

  /// Signed distance from the nearest point of a square to the center along one axis, meters.
  [[nodiscard]] float offsetX(std::int32_t i) const { return offset(x_, i); }
  [[nodiscard]] float offsetZ(std::int32_t k) const { return offset(z_, k); }

  /// Calls `visit(i, k)` for the squares nearer than `squared`, which `visit` may reduce, ring by
  /// ring around the square of the center.
  template <class Visit>
  void visitOutward(const float& squared, const Visit& visit) const {
    const std::int32_t i0 = indexOf(x_, count_x_);
    const std::int32_t k0 = indexOf(z_, count_z_);
    const float x = x_ - static_cast<float>(i0);
    const float z = z_ - static_cast<float>(k0);
    const float inner = std::max(0.0F, std::min({x, 1 - x, z, 1 - z}));
    const std::int32_t last = std::max({i0, count_x_ - 1 - i0, k0, count_z_ - 1 - k0});
    for (std::int32_t ring = 0; ring <= last; ++ring) {
      const float least = (static_cast<float>(ring - 1) + inner) * edge_;
      if (ring > 0 && least * least >= squared) return;
      visitRing({i0, k0, ring}, squared, visit);
    }
  }

 private:
  struct Ring {
    std::int32_t i, k, radius;
  };
  template <class Visit>
  void visitRing(const Ring& ring, const float& squared, const Visit& visit) const {
    const std::int32_t last_k = std::min(ring.k + ring.radius, count_z_ - 1);
    for (std::int32_t k = std::max(ring.k - ring.radius, 0); k <= last_k; ++k) {
      const float z = offsetZ(k);
      if (z * z >= squared) continue;
      const bool is_side = std::abs(k - ring.k) < ring.radius;
      const std::int32_t step = is_side ? 2 * ring.radius : 1;
      for (std::int32_t i = ring.i - ring.radius; i <= ring.i + ring.radius; i += step) {
        if (i < 0 || i >= count_x_) continue;
        const float x = offsetX(i);
        if (x * x + z * z < squared) visit(i, k);
      }
    }
  }

  [[nodiscard]] float offset(float at, std::int32_t square) const {
    const auto lo = static_cast<float>(square);
    return offsetFrom(lo, lo + 1, at) * edge_;
  }
  /// The index of the nearest square.
  static std::int32_t indexOf(float at, std::int32_t count) {
    return static_cast<std::int32_t>(std::clamp(at, 0.0F, static_cast<float>(count - 1)));
  }

  float edge_;
  float x_, z_;
  std::int32_t count_x_, count_z_;
};

}  // namespace

/// One query: the nearest point found so far.
class GridDistance::Search {
 public:
  Search(const GridDistance& distance, const Vec3& center, float most, Directions directions)
      : distance_(distance),
        grid_(distance.grid_),
        layout_(grid_.layout()),
        center_(center),
        is_level_(directions == Directions::kLevel),
        cells_(layout_, center, 1),
        squared_(most * most) {}

  void findNotFree() {
    takeEdges();
    const Squares blocks(layout_, center_, kBlockCells);
    blocks.visitOutward(squared_, [&](std::int32_t i, std::int32_t k) {
      const float x = blocks.offsetX(i);
      const float z = blocks.offsetZ(k);
      if (!isFreeThroughout(i, k, x * x + z * z)) searchBlock(i, k);
    });
  }

  void findFree() {
    cells_.visitOutward(squared_, [&](std::int32_t i, std::int32_t k) {
      const ColumnIndex column{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k)};
      const std::optional<float> free = nearestFreeHeight(layout_, column, center_.y);
      if (!free || (is_level_ && *free != center_.y)) return;
      take({cells_.offsetX(i), center_.y - *free, cells_.offsetZ(k)});
    });
  }

  [[nodiscard]] float length() const { return std::sqrt(squared_); }
  /// Unit vector from the nearest point to the center.
  [[nodiscard]] Vec3 direction() const {
    const float whole = std::sqrt(dot(offset_, offset_));
    return whole > 0 ? offset_ * (1 / whole) : Vec3{};
  }

 private:
  void take(const Vec3& offset) {
    const float squared = dot(offset, offset);
    if (!(squared < squared_)) return;
    squared_ = squared;
    offset_ = offset;
  }

  /// Nothing is known beyond the edges of the grid.
  void takeEdges() {
    const float width = layout_.spacing * static_cast<float>(layout_.columns_x);
    const float depth = layout_.spacing * static_cast<float>(layout_.columns_z);
    take({center_.x - layout_.min_x, 0, 0});
    take({center_.x - layout_.min_x - width, 0, 0});
    take({0, 0, center_.z - layout_.min_z});
    take({0, 0, center_.z - layout_.min_z - depth});
  }

  /// Whether the block is free at all heights within reach; `squared` is the squared horizontal
  /// distance to it.
  [[nodiscard]] bool isFreeThroughout(std::int32_t i, std::int32_t k, float squared) const {
    const float reach = is_level_ ? 0 : std::sqrt(squared_ - squared);
    const Block& block = distance_.blocks_[static_cast<std::size_t>(k) * distance_.blocks_x_ +
                                           static_cast<std::size_t>(i)];
    return std::ranges::any_of(block, [&](const Span& span) {
      return center_.y - reach >= span.lo && center_.y + reach <= span.hi;
    });
  }

  void searchBlock(std::int32_t block_i, std::int32_t block_k) {
    const std::uint32_t first_i = static_cast<std::uint32_t>(block_i) * kBlockCells;
    const std::uint32_t first_k = static_cast<std::uint32_t>(block_k) * kBlockCells;
    const std::uint32_t end_i = std::min(first_i + kBlockCells, layout_.columns_x);
    const std::uint32_t end_k = std::min(first_k + kBlockCells, layout_.columns_z);
    for (std::uint32_t k = first_k; k < end_k; ++k) {
      const float z = cells_.offsetZ(static_cast<std::int32_t>(k));
      if (z * z >= squared_) continue;
      for (std::uint32_t i = first_i; i < end_i; ++i) {
        const float x = cells_.offsetX(static_cast<std::int32_t>(i));
        if (x * x + z * z >= squared_) continue;
        const Contact contact = grid_.contact({i, k}, center_.y);
        if (contact.clearance != Clearance::kFree) {
          take({x, 0, z});
        } else if (!is_level_) {
          take({x, contact.down < contact.up ? contact.down : -contact.up, z});
        }
      }
    }
  }

  const GridDistance& distance_;
  const ColumnGrid& grid_;
  const ColumnGridLayout& layout_;
  Vec3 center_;
  bool is_level_;
  Squares cells_;
  float squared_;
  Vec3 offset_;
};

GridDistance::GridDistance(const ColumnGrid& grid)
    : grid_(grid), blocks_x_(blocksOf(grid.columnsX())), blocks_z_(blocksOf(grid.columnsZ())) {
  blocks_.reserve(std::size_t{blocks_x_} * blocks_z_);
  for (std::uint32_t k = 0; k < blocks_z_; ++k) {
    for (std::uint32_t i = 0; i < blocks_x_; ++i) blocks_.push_back(commonSpans(i, k));
  }
}

GridDistance::Block GridDistance::commonSpans(std::uint32_t block_i, std::uint32_t block_k) const {
  const std::uint32_t end_i = std::min((block_i + 1) * kBlockCells, grid_.columnsX());
  const std::uint32_t end_k = std::min((block_k + 1) * kBlockCells, grid_.columnsZ());
  std::vector<Span> common{grid_.heights()};
  std::vector<Span> spans;
  for (std::uint32_t k = block_k * kBlockCells; k < end_k; ++k) {
    for (std::uint32_t i = block_i * kBlockCells; i < end_i && !common.empty(); ++i) {
      spans.resize(grid_.spanCount(i, k));
      grid_.spans(i, k, spans);
      common = intersection(common, spans);
    }
  }
  std::ranges::stable_sort(common, std::greater<>(), heightOf);
  common.resize(std::tuple_size_v<Block>, kNoHeights);
  return {common[0], common[1]};
}

SignedDistance GridDistance::at(const Vec3& center, float most,
                                Directions directions) const noexcept {
  Search search(*this, center, most, directions);
  if (grid_.clearance(center) == Clearance::kFree) {
    search.findNotFree();
    return {std::min(search.length(), most), search.direction()};
  }
  search.findFree();
  return {-std::min(search.length(), most), search.direction() * -1.0F};
}

}  // namespace galactic::detail
