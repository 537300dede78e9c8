#include "simulation/ways_out/column_ways.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "column_grid/column_grid_kernels.h"
#include "support/processor.h"

namespace galactic::simulation {
namespace {

constexpr int kRowBits = 16;
/// The bits that stand for cells.
constexpr std::array<std::uint64_t, Surroundings::kWords> kCells = Surroundings::everywhere().rows;

/// The most cells in one query.
constexpr std::size_t kMostAsked = 64;

/// Cells to ask the grid of one radius about.
struct Question {
  alignas(32) std::array<float, kMostAsked> x;
  alignas(32) std::array<float, kMostAsked> y;
  alignas(32) std::array<float, kMostAsked> z;
  std::array<int, kMostAsked> bits;
  std::size_t count = 0;
};

/// Sets the bits of the cells that are free.
void answer(const ColumnGrid& grid, Question& question, Surroundings& free) {
  if (question.count == 0) return;
  const std::size_t padded = paddedToLanes(question.count);
  for (std::size_t n = question.count; n < padded; ++n) {
    question.x[n] = question.x[question.count - 1];
    question.y[n] = question.y[question.count - 1];
    question.z[n] = question.z[question.count - 1];
  }
  const auto eights = static_cast<unsigned>((std::uint64_t{1} << (padded / kLanes)) - 1);
  const detail::EightsOfCenters centers{question.x.data(), question.y.data(), question.z.data(),
                                        eights};
  const std::uint64_t not_free = detail::hasAvx2()
                                     ? detail::notFreeAvx2(grid.layout(), centers)
                                     : detail::notFreePortable(grid.layout(), centers);
  for (std::size_t n = 0; n < question.count; ++n) {
    const auto bit = static_cast<unsigned>(question.bits[n]);
    const std::uint64_t is_free = ~not_free >> n & 1U;
    free.rows[bit / 64] |= is_free << (bit % 64);
  }
  question.count = 0;
}

/// The cells of a set and all that touch one of them, even at a corner only.
Surroundings grown(const Surroundings& cells) {
  std::array<std::uint64_t, Surroundings::kWords> wide{};
  for (std::size_t n = 0; n < wide.size(); ++n) {
    const std::uint64_t row = cells.rows[n] & kCells[n];
    wide[n] = (row | row << 1U | row >> 1U) & kCells[n];
  }
  Surroundings found;
  for (std::size_t n = 0; n < wide.size(); ++n) {
    const std::uint64_t before = n > 0 ? wide[n - 1] >> (64 - kRowBits) : 0;
    const std::uint64_t behind = n + 1 < wide.size() ? wide[n + 1] << (64 - kRowBits) : 0;
    found.rows[n] =
        (wide[n] | wide[n] << kRowBits | wide[n] >> kRowBits | before | behind) & kCells[n];
  }
  return found;
}

}  // namespace

void ColumnWays::clear() noexcept {
  spheres_.clear();
  may_be_free_ = Surroundings::everywhere();
  is_full_ = false;
}

bool ColumnWays::isHopeless() const noexcept { return may_be_free_.isEmpty(); }

void ColumnWays::add(const ColumnGrid& grid, const Vec3& center,
                     const std::optional<SurroundingRows>& around) noexcept {
  if (spheres_.size() == spheres_.capacity()) {
    is_full_ = true;
    return;
  }
  Sphere& sphere = spheres_.emplace_back();
  sphere.grid = &grid;
  sphere.center = center;
  if (around) {
    sphere.free = around->cells();
    sphere.asked = around->blockedCells();
  }
  bool is_free_everywhere = true;
  for (std::size_t n = 0; n < kCells.size(); ++n) {
    sphere.free.rows[n] &= kCells[n];
    is_free_everywhere = is_free_everywhere && sphere.free.rows[n] == kCells[n];
    may_be_free_.rows[n] &= ~sphere.asked.rows[n];
    sphere.asked.rows[n] |= sphere.free.rows[n];
  }
  // A sphere that is free everywhere decides nothing.
  if (is_free_everywhere) spheres_.pop_back();
}

void ColumnWays::ask(const Surroundings& cells, Sphere& sphere) noexcept {
  std::uint64_t any = 0;
  for (std::size_t n = 0; n < kCells.size(); ++n) any |= cells.rows[n] & ~sphere.asked.rows[n];
  if (any == 0) return;
  const ColumnGridLayout& layout = sphere.grid->layout();
  const float own_x = std::floor((sphere.center.x - layout.min_x) * layout.inverse_spacing) + 0.5F;
  const float own_z = std::floor((sphere.center.z - layout.min_z) * layout.inverse_spacing) + 0.5F;
  Question question;
  for (std::size_t n = 0; n < kCells.size(); ++n) {
    std::uint64_t left = cells.rows[n] & ~sphere.asked.rows[n];
    sphere.asked.rows[n] |= left;
    for (; left != 0; left &= left - 1) {
      const int bit = 64 * static_cast<int>(n) + std::countr_zero(left);
      const int x = bit % kRowBits - kCellsAround;
      const int z = bit / kRowBits - kCellsAround;
      question.x[question.count] = layout.min_x + (own_x + static_cast<float>(x)) * layout.spacing;
      question.z[question.count] = layout.min_z + (own_z + static_cast<float>(z)) * layout.spacing;
      question.y[question.count] = sphere.center.y;
      question.bits[question.count++] = bit;
      if (question.count == kMostAsked) answer(*sphere.grid, question, sphere.free);
    }
  }
  answer(*sphere.grid, question, sphere.free);
}

bool ColumnWays::addTo(WayOut& way) noexcept {
  if (is_full_) return false;
  Surroundings in_all = may_be_free_;
  if (isHopeless()) return false;
  for (Sphere& sphere : spheres_) {
    ask(in_all, sphere);
    for (std::size_t n = 0; n < kCells.size(); ++n) {
      in_all.rows[n] &= sphere.free.rows[n];
    }
    if (in_all.isEmpty()) return false;
  }
  const Surroundings near = grown(in_all);
  for (Sphere& sphere : spheres_) {
    ask(near, sphere);
    way.add(sphere.free, sphere.grid->layout(), sphere.center);
  }
  return true;
}

}  // namespace galactic::simulation
