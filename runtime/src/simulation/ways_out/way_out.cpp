#include "simulation/ways_out/way_out.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "column_grid/column_grid_kernels.h"

namespace galactic::simulation {
namespace {

constexpr int kRowBits = 16;

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
  const float cell = part + by + kAboveCells;
  constexpr auto kAbove = static_cast<int>(kAboveCells);
  return {static_cast<int>(cell - rounding) - kAbove, static_cast<int>(cell + rounding) - kAbove};
}

bool isFree(const EightWays& ways, std::size_t lane, int x, int z) {
  const auto row = static_cast<unsigned>(z + kCellsAround);
  const unsigned bit = 16 * (row % 2) + static_cast<unsigned>(x + kCellsAround);
  return (ways.rows[row / 2][lane] >> bit & 1U) != 0;
}

/// Both of the nine bits that count of each half.
constexpr std::uint32_t kEverywhere = 0x01ff'01ff;
/// The upper half of the last pair: there is no tenth row.
constexpr std::uint32_t kNoRow = 0x01ff'0000;

/// What a move may have along the drive, as a part of its length: the cosine of 60 degrees.
constexpr float kAlongDrive = 0.5F;

}  // namespace

bool addWaysPortable(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes,
                     EightWays& ways, AllWays& all) noexcept {
  bool any = false;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const bool is_added = (lanes >> lane & 1U) != 0;
    std::uint32_t is_free = kEverywhere;
    for (std::size_t pair = 0; pair < kRowPairs; ++pair) {
      std::uint32_t cells = kEverywhere;
      if (is_added) {
        const std::uint16_t* at = rows + places.row[lane] + 2 * pair;
        const std::uint32_t lower = unsigned{at[0]} >> places.column[lane] & 0x1ffU;
        const std::uint32_t upper = unsigned{at[1]} >> places.column[lane] & 0x1ffU;
        cells = lower | upper << 16U;
      }
      if (pair + 1 == kRowPairs) cells |= kNoRow;
      ways.rows[pair][lane] = cells;
      all.rows[pair][lane] &= cells;
      is_free &= cells;
    }
    ways.part_x[lane] = places.part_x[lane];
    ways.part_z[lane] = places.part_z[lane];
    ways.counts[lane] = is_free == kEverywhere ? 0 : ~std::uint32_t{0};
    any = any || is_free != kEverywhere;
  }
  return any;
}

TakenBackBoth takenBackPortable(const EightWays* ways, std::size_t count,
                                const CellMove& move) noexcept {
  const WayCell to = move.to;
  const WayCell before_x{to.x - signOf(to.x), to.z};
  const WayCell before_z{to.x, to.z - signOf(to.z)};
  const WayCell before_both{before_x.x, before_z.z};
  const auto isFreeIn = [&](std::size_t n, const WayCell& cell) {
    return isFree(ways[n / kLanes], n % kLanes, cell.x, cell.z);
  };
  const auto toBorderX = [&](std::size_t n) {
    return fromBorder(ways[n / kLanes].part_x[n % kLanes], to.x);
  };
  const auto toBorderZ = [&](std::size_t n) {
    return fromBorder(ways[n / kLanes].part_z[n % kLanes], to.z);
  };
  TakenBackBoth back;
  for (std::size_t n = 0; n < count * kLanes; ++n) {
    float& x = back.along_x_first.x;
    float& z = back.along_z_first.z;
    if (!isFreeIn(n, before_x)) x = std::min(x, toBorderX(n));
    if (!isFreeIn(n, before_z)) z = std::min(z, toBorderZ(n));
  }
  const auto isBehind = [&](float to_border, float taken) {
    return to_border - taken + move.margin < 0;
  };
  for (std::size_t n = 0; n < count * kLanes; ++n) {
    float& x = back.along_z_first.x;
    float& z = back.along_x_first.z;
    const bool is_behind_x = isBehind(toBorderX(n), back.along_x_first.x);
    const bool is_behind_z = isBehind(toBorderZ(n), back.along_z_first.z);
    if (!isFreeIn(n, is_behind_x ? before_both : before_z)) z = std::min(z, toBorderZ(n));
    if (!isFreeIn(n, is_behind_z ? before_both : before_x)) x = std::min(x, toBorderX(n));
  }
  return back;
}

bool noneAtBorderPortable(const EightWays* ways, std::size_t count, const CellPush& by,
                          float distance) noexcept {
  const auto isNear = [distance](float part, float by_this) {
    const float cell = part + by_this + kAboveCells;
    return by_this != 0 && std::abs(cell - std::nearbyint(cell)) <= distance;
  };
  for (std::size_t n = 0; n < count * kLanes; ++n) {
    const EightWays& eight = ways[n / kLanes];
    const std::size_t lane = n % kLanes;
    if (eight.counts[lane] == 0) continue;
    if (isNear(eight.part_x[lane], by.x) || isNear(eight.part_z[lane], by.z)) return false;
  }
  return true;
}

bool allFreePortable(const EightWays* ways, std::size_t count, const CellPush& by,
                     float rounding) noexcept {
  for (std::size_t n = 0; n < count * kLanes; ++n) {
    const EightWays& eight = ways[n / kLanes];
    const std::size_t lane = n % kLanes;
    if (eight.counts[lane] == 0) continue;
    const CellRange x = cellsAfter(eight.part_x[lane], by.x, rounding);
    const CellRange z = cellsAfter(eight.part_z[lane], by.z, rounding);
    const bool is_known =
        std::min(x.first, z.first) >= -kCellsAround && std::max(x.last, z.last) <= kCellsAround;
    const bool is_free =
        is_known && isFree(eight, lane, x.first, z.first) && isFree(eight, lane, x.first, z.last) &&
        isFree(eight, lane, x.last, z.first) && isFree(eight, lane, x.last, z.last);
    if (!is_free) return false;
  }
  return true;
}

void WayOut::clear(float spacing) noexcept {
  count_ = 0;
  single_count_ = kLanes;
  spacing_ = spacing;
  for (std::uint32_t* pair : all_.rows) std::fill_n(pair, kLanes, kEverywhere);
}

EightWays* WayOut::next() noexcept {
  if (count_ < ways_.size()) return &ways_[count_];
  for (std::uint32_t* pair : all_.rows) std::fill_n(pair, kLanes, 0U);
  return nullptr;
}

void WayOut::add(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes) noexcept {
  if (lanes == 0) return;
  EightWays* ways = next();
  if (ways == nullptr) return;
  const bool counts = detail::hasAvx2() ? addWaysAvx2(rows, places, lanes, *ways, all_)
                                        : addWaysPortable(rows, places, lanes, *ways, all_);
  if (counts) ++count_;
}

void WayOut::add(const Surroundings& around, float part_x, float part_z) noexcept {
  if (single_count_ == kLanes) {
    EightWays* ways = next();
    if (ways == nullptr) return;
    // No sphere yet: nothing is added to all.
    addWaysPortable(nullptr, {}, 0, *ways, all_);
    singles_ = count_++;
    single_count_ = 0;
  }
  EightWays& ways = ways_[singles_];
  const std::size_t lane = single_count_++;
  for (std::size_t pair = 0; pair < kRowPairs; ++pair) {
    const std::uint32_t lower = around.row(2 * pair);
    const std::uint32_t upper = pair + 1 == kRowPairs ? kNoRow : around.row(2 * pair + 1) << 16U;
    ways.rows[pair][lane] = lower | upper;
    all_.rows[pair][lane] &= lower | upper;
  }
  ways.part_x[lane] = part_x;
  ways.part_z[lane] = part_z;
  ways.counts[lane] = ~std::uint32_t{0};
}

void WayOut::add(const Surroundings& around, const ColumnGridLayout& grid,
                 const Vec3& center) noexcept {
  const auto part_of = [](float cell) { return cell - std::floor(cell); };
  add(around, part_of((center.x - grid.min_x) * grid.inverse_spacing),
      part_of((center.z - grid.min_z) * grid.inverse_spacing));
}

Surroundings WayOut::inAll() const noexcept {
  Surroundings cells;
  for (std::size_t pair = 0; pair < kRowPairs; ++pair) {
    std::uint32_t in_all = kEverywhere;
    for (const std::uint32_t lane : all_.rows[pair]) in_all &= lane;
    cells.rows[pair / 2] |= std::uint64_t{in_all} << (pair % 2 * 32);
  }
  constexpr std::uint64_t kLastRow = 0x1ff;
  cells.rows.back() &= kLastRow;
  return cells;
}

Push WayOut::shortened(const WayCell& to) const noexcept {
  const CellMove move{to, kIntoCell / spacing_};
  const TakenBackBoth back = detail::hasAvx2() ? takenBackAvx2(ways_.data(), count_, move)
                                               : takenBackPortable(ways_.data(), count_, move);
  const auto length = [&](int cells, float taken_back) {
    const int sign = signOf(cells);
    const float taken = static_cast<float>(sign) * (taken_back - move.margin);
    return sign == 0 ? 0.0F : (static_cast<float>(cells) - taken) * spacing_;
  };
  const Push one{length(to.x, back.along_x_first.x), length(to.z, back.along_x_first.z)};
  const Push other{length(to.x, back.along_z_first.x), length(to.z, back.along_z_first.z)};
  const bool is_longer = one.x * one.x + one.z * one.z > other.x * other.x + other.z * other.z;
  return is_longer ? other : one;
}

bool WayOut::suits(const Push& push) const noexcept {
  const CellPush by{push.x / spacing_, push.z / spacing_};
  // Less than what spheres go into cells by.
  const float rounding = 0.5F * kIntoCell / spacing_;
  // What a move is shortened to leaves all spheres free but for those that rounding may take
  // further.
  const float near = 1.25F * rounding;
  if (detail::hasAvx2()) {
    return noneAtBorderAvx2(ways_.data(), count_, by, near) ||
           allFreeAvx2(ways_.data(), count_, by, rounding);
  }
  return noneAtBorderPortable(ways_.data(), count_, by, near) ||
         allFreePortable(ways_.data(), count_, by, rounding);
}

template <class MayBe>
std::optional<Push> WayOut::shortestOf(float longest, const MayBe& may_be) const noexcept {
  std::optional<Push> best;
  float least = longest * longest;
  const Surroundings moves = nearest(inAll());
  for (std::size_t n = 0; n < Surroundings::kWords; ++n) {
    for (std::uint64_t left = moves.rows[n]; left != 0; left &= left - 1) {
      const int bit = 64 * static_cast<int>(n) + std::countr_zero(left);
      const int x = bit % kRowBits - kCellsAround;
      const int z = bit / kRowBits - kCellsAround;
      // One cell less along each axis for spheres at its border.
      const auto least_x = static_cast<float>(x - signOf(x)) * spacing_;
      const auto least_z = static_cast<float>(z - signOf(z)) * spacing_;
      if (least_x * least_x + least_z * least_z >= least) continue;
      const Push push = shortened({x, z});
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
