#include "simulation/ways_out/way_out.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace galactic::simulation {
namespace {

constexpr std::uint16_t kAllFree = 0xffff;

}  // namespace

WayOut::WayOut(std::size_t most_eights, const WayKernels& kernels)
    : kernels_(kernels),
      most_(most_eights),
      ways_((most_eights + kLanes + kWaysAtATime) / kWaysAtATime * kWaysAtATime),
      deciding_(ways_.size()),
      single_rows_((most_eights * kLanes + 1) * CommonCells::kRows, kAllFree) {}

void WayOut::clear(float spacing) noexcept {
  count_ = 0;
  in_eight_ = kLanes;
  single_count_ = 0;
  spacing_ = spacing;
  common_ = CommonCells::everywhere();
}

void WayOut::close() noexcept { std::ranges::fill(common_.rows, std::uint16_t{0}); }

bool WayOut::isOpen() const noexcept {
  constexpr unsigned kEdge = 2 * kCellsAround + 1;
  const auto first = std::begin(common_.rows);
  return std::any_of(first, first + kEdge,
                     [](unsigned row) { return (row & ((1U << kEdge) - 1)) != 0; });
}

EightWays* WayOut::next() noexcept {
  if (count_ < most_) return &ways_[count_];
  close();
  return nullptr;
}

void WayOut::add(const std::uint16_t* rows, const EightPlaces& places, unsigned lanes) noexcept {
  if (lanes == 0) return;
  EightWays* ways = next();
  if (ways == nullptr) return;
  // Whether they count is unpredictable, so there is no branch.
  count_ += kernels_.add(rows, places, lanes, *ways, common_) ? 1U : 0U;
}

AddedGroups WayOut::add(const GroupsToAdd& groups) noexcept {
  if (count_ > most_) return {};
  const AddedGroups added = kernels_.add_groups(groups, &ways_[count_], common_);
  count_ += added.count;
  if (count_ > most_) close();
  return added;
}

void WayOut::add(const Surroundings& around, float part_x, float part_z) noexcept {
  if (in_eight_ == kLanes) {
    EightWays* ways = next();
    if (ways == nullptr) return;
    // Without any sphere yet.
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

FoundWay WayOut::shortest(const Push& drive, float longest) noexcept {
  return kernels_.shortest({.ways = ways_.data(),
                            .count = count_,
                            .deciding = deciding_.data(),
                            .common = &common_,
                            .spacing = spacing_,
                            .drive_x = drive.x,
                            .drive_z = drive.z,
                            .longest = longest});
}

}  // namespace galactic::simulation
