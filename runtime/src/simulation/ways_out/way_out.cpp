#include "simulation/ways_out/way_out.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

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

/// Those that count.
Surroundings cellsOf(const CommonCells& common) {
  Surroundings cells;
  std::memcpy(cells.rows.data(), common.rows, sizeof(cells.rows));
  for (std::size_t n = 0; n < Surroundings::kWords; ++n) {
    cells.rows[n] &= Surroundings::everywhere().rows[n];
  }
  return cells;
}

constexpr std::uint16_t kAllFree = 0xffff;

/// What a move may have along the drive, as a part of its length: the cosine of 60 degrees.
constexpr float kAlongDrive = 0.5F;

}  // namespace

WayOut::WayOut(std::size_t most_eights, const WayKernels& kernels)
    : kernels_(kernels),
      most_(most_eights),
      ways_((most_eights + kWaysAtATime - 1) / kWaysAtATime * kWaysAtATime),
      deciding_(ways_.size() + 1),
      single_rows_((most_eights * kLanes + 1) * CommonCells::kRows, kAllFree) {}

void WayOut::clear(float spacing) noexcept {
  count_ = 0;
  in_eight_ = kLanes;
  single_count_ = 0;
  spacing_ = spacing;
  std::ranges::fill(common_.rows, kAllFree);
}

EightWays* WayOut::next() noexcept {
  if (count_ < most_) return &ways_[count_];
  std::ranges::fill(common_.rows, std::uint16_t{0});
  return nullptr;
}

void WayOut::add(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes) noexcept {
  if (lanes == 0) return;
  EightWays* ways = next();
  if (ways == nullptr) return;
  // Whether they count nobody can guess: no branch.
  count_ += kernels_.add(rows, places, lanes, *ways, common_) ? 1U : 0U;
}

void WayOut::add(const Surroundings& around, float part_x, float part_z) noexcept {
  if (in_eight_ == kLanes) {
    EightWays* ways = next();
    if (ways == nullptr) return;
    // No sphere yet.
    *ways = {};
    ways->rows = single_rows_.data();
    std::ranges::fill(ways->cells.rows, kAllFree);
    singles_ = count_++;
    in_eight_ = 0;
  }
  EightWays& ways = ways_[singles_];
  const std::size_t lane = in_eight_++;
  const std::size_t first = ++single_count_ * CommonCells::kRows;
  std::memcpy(&single_rows_[first], around.rows.data(), sizeof(around.rows));
  for (std::size_t n = 0; n < CommonCells::kRows; ++n) {
    ways.cells.rows[n] &= single_rows_[first + n];
    common_.rows[n] &= single_rows_[first + n];
  }
  ways.row[lane] = static_cast<std::int32_t>(first);
  ways.part_x[lane] = part_x;
  ways.part_z[lane] = part_z;
  ways.spheres |= 1U << lane;
}

void WayOut::add(const Surroundings& around, const ColumnGridLayout& grid,
                 const Vec3& center) noexcept {
  const auto part_of = [](float cell) { return cell - std::floor(cell); };
  add(around, part_of((center.x - grid.min_x) * grid.inverse_spacing),
      part_of((center.z - grid.min_z) * grid.inverse_spacing));
}

Push WayOut::shortened(const WayCell& to) noexcept {
  const CellMove move{to, kIntoCell / spacing_};
  const TakenBackBoth back = kernels_.taken_back(ways_.data(), count_, move, deciding_.data());
  const auto length = [&](int cells, float taken_back) {
    const float taken = static_cast<float>(signOf(cells)) * (taken_back - move.margin);
    return (static_cast<float>(cells) - taken) * spacing_;
  };
  const Push one{length(to.x, back.along_x_first.x), length(to.z, back.along_x_first.z)};
  const Push other{length(to.x, back.along_z_first.x), length(to.z, back.along_z_first.z)};
  const bool is_longer = one.x * one.x + one.z * one.z > other.x * other.x + other.z * other.z;
  return is_longer ? other : one;
}

bool WayOut::suits(const Push& push) const noexcept {
  // Less than what spheres go into cells by.
  const float rounding = 0.5F * kIntoCell / spacing_;
  // What a move is shortened to leaves all spheres free but for those that rounding may take
  // further.
  const float near = 1.25F * rounding;
  return kernels_.are_free(ways_.data(), count_,
                           {push.x / spacing_, push.z / spacing_, rounding, near});
}

template <class MayBe>
std::optional<Push> WayOut::shortestOf(float longest, const MayBe& may_be) noexcept {
  std::optional<Push> best;
  float least = longest * longest;
  Surroundings moves = nearest(cellsOf(common_));
  while (!moves.isEmpty()) {
    const int bit = moves.takeFirst();
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
  return best;
}

std::optional<Push> WayOut::shortest(const Push& drive, float longest) noexcept {
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
