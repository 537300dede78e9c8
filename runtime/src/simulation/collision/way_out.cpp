#include "simulation/collision/way_out.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

namespace galactic::simulation {
namespace {

constexpr int kEdge = 2 * kCellsAround + 1;
constexpr int kRowBits = 16;

constexpr int signOf(int value) { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

/// The cells of a set that `is_in` says.
template <class IsIn>
constexpr Surroundings cellsThat(const IsIn& is_in) {
  Surroundings cells;
  for (int z = -kCellsAround; z <= kCellsAround; ++z) {
    for (int x = -kCellsAround; x <= kCellsAround; ++x) {
      if (is_in(x, z)) cells.setFree(x, z);
    }
  }
  return cells;
}

constexpr Surroundings kToPositiveX = cellsThat([](int x, int) { return x > 0; });
constexpr Surroundings kToNegativeX = cellsThat([](int x, int) { return x < 0; });
constexpr Surroundings kToPositiveZ = cellsThat([](int, int z) { return z > 0; });
constexpr Surroundings kToNegativeZ = cellsThat([](int, int z) { return z < 0; });
constexpr Surroundings kElsewhere = cellsThat([](int x, int z) { return x != 0 || z != 0; });

/// The cells of a set from which no cell of it is nearer to the middle along an axis: nobody needs
/// to go on from a free cell.
Surroundings nearest(const Surroundings& cells) {
  Surroundings found;
  for (std::size_t n = 0; n < Surroundings::kWords; ++n) {
    const std::uint64_t here = cells.rows[n];
    const std::uint64_t before = n > 0 ? cells.rows[n - 1] >> (64 - kRowBits) : 0;
    const std::uint64_t behind =
        n + 1 < Surroundings::kWords ? cells.rows[n + 1] << (64 - kRowBits) : 0;
    const std::uint64_t beyond = (here << 1U & kToPositiveX.rows[n]) |
                                 (here >> 1U & kToNegativeX.rows[n]) |
                                 ((here << kRowBits | before) & kToPositiveZ.rows[n]) |
                                 ((here >> kRowBits | behind) & kToNegativeZ.rows[n]);
    found.rows[n] = here & kElsewhere.rows[n] & ~beyond;
  }
  return found;
}

/// How far a place in a cell, 0 to 1, is from the border that a move towards `sign` crosses last.
float fromBorder(float part, int sign) { return sign > 0 ? part : 1 - part; }

/// The cells along one axis that a place may be in, from a sphere's own.
struct CellRange {
  int first = 0;
  int last = 0;
};

/// `part`: where in its cell a sphere is; `by`: how far it goes, in cells. Rounding may take what
/// moves `rounding` further.
CellRange cellsAfter(float part, float by, float rounding) {
  if (by == 0) return {};
  // Truncation rounds down what is positive.
  constexpr int kAbove = 64;
  const float cell = part + by + static_cast<float>(kAbove);
  return {static_cast<int>(cell - rounding) - kAbove, static_cast<int>(cell + rounding) - kAbove};
}

/// What a move may have along the drive, as a part of its length: the cosine of 60 degrees.
constexpr float kAlongDrive = 0.5F;

}  // namespace

Push WayOut::shortened(int x, int z, bool along_x_first) const noexcept {
  // Along the first axis as if the whole way along the second were gone; then along the second,
  // each sphere from the cell along the first in which it is then.
  const int first = along_x_first ? x : z;
  const int second = along_x_first ? z : x;
  const int sign_first = signOf(first);
  const int sign_second = signOf(second);
  const auto is_free = [&](const Sphere& sphere, int to_first, int to_second) {
    return along_x_first ? sphere.around.isFree(to_first, to_second)
                         : sphere.around.isFree(to_second, to_first);
  };
  const auto part_first = [&](const Sphere& sphere) {
    return fromBorder(along_x_first ? sphere.part_x : sphere.part_z, sign_first);
  };
  const std::span<const Sphere> spheres = std::span(spheres_).first(count_);
  const float margin = kIntoCell / spacing_;
  float back_first = 1;
  float back_second = 1;
  if (sign_first != 0) {
    for (const Sphere& sphere : spheres) {
      const bool blocks = !is_free(sphere, first - sign_first, second);
      back_first = std::min(back_first, blocks ? part_first(sphere) : 1.0F);
    }
  }
  if (sign_second != 0) {
    for (const Sphere& sphere : spheres) {
      const bool is_before = sign_first != 0 && part_first(sphere) - back_first + margin < 0;
      const int there = is_before ? first - sign_first : first;
      const bool blocks = !is_free(sphere, there, second - sign_second);
      const float part = along_x_first ? sphere.part_z : sphere.part_x;
      back_second = std::min(back_second, blocks ? fromBorder(part, sign_second) : 1.0F);
    }
  }
  const auto length = [&](int cells, int sign, float back) {
    const float taken = static_cast<float>(sign) * (back - margin);
    return sign == 0 ? 0.0F : (static_cast<float>(cells) - taken) * spacing_;
  };
  const float to_first = length(first, sign_first, back_first);
  const float to_second = length(second, sign_second, back_second);
  return along_x_first ? Push{to_first, to_second} : Push{to_second, to_first};
}

Push WayOut::shortened(int x, int z) const noexcept {
  const Push one = shortened(x, z, true);
  if (x == 0 || z == 0) return one;
  const Push other = shortened(x, z, false);
  const bool is_longer = one.x * one.x + one.z * one.z > other.x * other.x + other.z * other.z;
  return is_longer ? other : one;
}

bool WayOut::suits(const Push& push) const noexcept {
  const float by_x = push.x / spacing_;
  const float by_z = push.z / spacing_;
  // Less than what spheres go into cells by.
  const float rounding = 0.5F * kIntoCell / spacing_;
  for (std::size_t n = 0; n < count_; ++n) {
    const CellRange x = cellsAfter(spheres_[n].part_x, by_x, rounding);
    const CellRange z = cellsAfter(spheres_[n].part_z, by_z, rounding);
    const bool is_known =
        std::min(x.first, z.first) >= -kCellsAround && std::max(x.last, z.last) <= kCellsAround;
    const SurroundingRows& around = spheres_[n].around;
    if (!is_known || !around.isFree(x.first, z.first)) return false;
    if (x.first == x.last && z.first == z.last) continue;
    const bool is_free = around.isFree(x.first, z.last) && around.isFree(x.last, z.first) &&
                         around.isFree(x.last, z.last);
    if (!is_free) return false;
  }
  return true;
}

template <class MayBe>
std::optional<Push> WayOut::shortestOf(float longest, const MayBe& may_be) const noexcept {
  std::optional<Push> best;
  float least = longest * longest;
  const Surroundings moves = nearest(all_);
  for (std::size_t n = 0; n < Surroundings::kWords; ++n) {
    for (std::uint64_t left = moves.rows[n]; left != 0; left &= left - 1) {
      const int bit = 64 * static_cast<int>(n) + std::countr_zero(left);
      const int x = bit % kRowBits - kCellsAround;
      const int z = bit / kRowBits - kCellsAround;
      // One cell less along each axis for spheres at its border.
      const auto least_x = static_cast<float>(x - signOf(x)) * spacing_;
      const auto least_z = static_cast<float>(z - signOf(z)) * spacing_;
      if (least_x * least_x + least_z * least_z >= least) continue;
      const Push push = shortened(x, z);
      const float squared = push.x * push.x + push.z * push.z;
      if (!(squared < least) || !may_be(push, squared)) continue;
      least = squared;
      best = push;
    }
  }
  return best;
}

std::optional<Push> WayOut::shortest(const Push& drive, float longest) const noexcept {
  const float driven = std::sqrt(drive.x * drive.x + drive.z * drive.z);
  const auto is_back = [&](const Push& push, float squared) {
    const float along = push.x * drive.x + push.z * drive.z;
    return along <= 0 || along <= kAlongDrive * driven * std::sqrt(squared);
  };
  const std::optional<Push> push = shortestOf(longest, is_back);
  if (!push || suits(*push)) return push;
  // A sphere goes further than into the next cell, which happens to those at a border: ask each.
  return shortestOf(longest, [&](const Push& other, float squared) {
    return is_back(other, squared) && suits(other);
  });
}

}  // namespace galactic::simulation
