#include "simulation/collision/clearance_map.h"

#include <algorithm>
#include <array>
#include <utility>

#include "support/huge_pages.h"
#include "support/processor.h"

namespace galactic::simulation {
namespace {

/// Padding cells after the last one, because look-ups read two cells at a time.
constexpr std::size_t kReadBeyond = 1;

}  // namespace

ClearanceMaps::ClearanceMaps(std::vector<std::uint32_t> radius_of_lane, std::size_t most_bytes)
    : radius_of_lane_(std::move(radius_of_lane)),
      eights_(paddedToLanes(radius_of_lane_.size()) / kLanes),
      most_bytes_(most_bytes),
      lanes_(eights_),
      cells_(1 + kReadBeyond, detail::hugePages()) {
  // Lanes beyond the last group repeat the first lane of their eight, as bounds do.
  for (std::size_t n = radius_of_lane_.size(); n < eights_ * kLanes; ++n) {
    radius_of_lane_.push_back(radius_of_lane_[n / kLanes * kLanes]);
  }
}

bool ClearanceMaps::isAsked(std::uint32_t radius) const {
  return std::ranges::find(radius_of_lane_, radius) != radius_of_lane_.end();
}

void ClearanceMaps::reserve(std::size_t cells) {
  cells_.reserve(std::min(cells + kReadBeyond + 1, most_bytes_ / sizeof(RoomAround)));
}

std::uint32_t ClearanceMaps::add(const FloorClearance& floor) {
  std::size_t cells = 0;
  for (std::uint32_t radius = 0; radius < floor.size(); ++radius) {
    if (isAsked(radius)) cells += floor[radius].cells.size();
  }
  if (!hasRoomFor(cells)) return kNoClearanceMap;
  const std::uint32_t map = count_++;
  lanes_.resize(count_ * eights_);
  const std::span<ClearanceLanes> lanes = std::span(lanes_).last(eights_);
  for (std::uint32_t radius = 0; radius < floor.size(); ++radius) {
    if (!isAsked(radius)) continue;
    const RadiusClearance& from = floor[radius];
    const std::size_t first = cells_.size() - kReadBeyond;
    cells_.resize(first);
    cells_.insert(cells_.end(), from.cells.begin(), from.cells.end());
    cells_.resize(cells_.size() + kReadBeyond);
    for (std::size_t n = 0; n < radius_of_lane_.size(); ++n) {
      if (radius_of_lane_[n] != radius) continue;
      ClearanceLanes& to = lanes[n / kLanes];
      const std::size_t lane = n % kLanes;
      to.min_x[lane] = from.min_x;
      to.min_z[lane] = from.min_z;
      to.inverse_step[lane] = from.inverse_step;
      to.steps_x[lane] = from.steps_x;
      to.steps_z[lane] = from.steps_z;
      to.lowest[lane] = from.lowest;
      to.low[lane] = from.low;
      to.highest[lane] = from.highest;
      to.band_from[lane] = from.band_from;
      to.inverse_band[lane] = from.inverse_band;
      to.first[lane] = static_cast<std::int32_t>(first);
      to.band_cells[lane] = from.band_cells;
      to.tiles_x[lane] = from.tiles_x;
    }
  }
  return map;
}

void ClearanceMaps::surelyFree(std::uint32_t map, std::size_t eight, const GroupBounds& bounds,
                               SureGroups& sure) const noexcept {
  const ClearanceQuestion question{lanesOf(map, eight), bounds.values};
  answer({&question, 1}, bounds.stride, &sure);
}

void ClearanceMaps::surelyFree(std::span<const std::uint32_t> maps, std::size_t eight,
                               const GroupBounds& bounds, std::size_t env_stride,
                               std::span<SureGroups> sure) const noexcept {
  std::array<ClearanceQuestion, kMostAsked> questions;
  for (std::size_t n = 0; n < maps.size(); ++n) {
    questions[n] = {lanesOf(maps[n], eight), bounds.values + n * env_stride};
  }
  answer(std::span(questions).first(maps.size()), bounds.stride, sure.data());
}

void ClearanceMaps::surelyFree(std::span<const std::uint32_t> maps, std::size_t eight,
                               std::span<const CenterBounds> bounds,
                               std::span<unsigned> free) const noexcept {
  std::array<BoxQuestion, kMostAsked> questions;
  for (std::size_t n = 0; n < maps.size(); ++n) {
    questions[n] = {lanesOf(maps[n], eight), &bounds[n]};
  }
  const auto ask = detail::hasAvx2() ? boxesSurelyFreeAvx2 : boxesSurelyFreePortable;
  ask(questions.data(), maps.size(), cells_.data(), free.data());
}

unsigned ClearanceMaps::freeAfter(std::uint32_t map, std::size_t eight, const SureGroups& sure,
                                  float x, float z) const noexcept {
  const ClearanceLanes& lanes = *lanesOf(map, eight);
  return detail::hasAvx2() ? freeAfterAvx2(lanes, sure, x, z)
                           : freeAfterPortable(lanes, sure, x, z);
}

void ClearanceMaps::answer(std::span<const ClearanceQuestion> questions, std::size_t stride,
                           SureGroups* sure) const noexcept {
  const auto ask = detail::hasAvx2() ? surelyFreeAvx2 : surelyFreePortable;
  ask(questions.data(), questions.size(), cells_.data(), stride, sure);
}

namespace {

/// How far the room reaches on one side, in steps from the middle of its cell.
float roomOn(int side, RoomAround room) {
  return static_cast<float>(static_cast<unsigned>(room) >> side & kMostRoom);
}

SureGroups surelyFree(const ClearanceLanes& lanes, const RoomAround* cells, const float* bounds,
                      std::size_t stride) {
  SureGroups sure;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const auto steps = [&](std::size_t bound, float from) {
      return (bounds[bound * stride + n] - from) * lanes.inverse_step[n];
    };
    const float least_x = steps(0, lanes.min_x[n]);
    const float most_x = steps(1, lanes.min_x[n]);
    const float least_z = steps(4, lanes.min_z[n]);
    const float most_z = steps(5, lanes.min_z[n]);
    const float x = 0.5F * (least_x + most_x);
    const float z = 0.5F * (least_z + most_z);
    const float least_y = bounds[2 * stride + n];
    const float most_y = bounds[3 * stride + n];
    const bool inside = x >= 0 && x < lanes.steps_x[n] && z >= 0 && z < lanes.steps_z[n] &&
                        least_y >= lanes.lowest[n] && most_y <= lanes.highest[n];
    if (!inside) continue;
    const auto i = static_cast<std::uint32_t>(x) / kStepsPerCell;
    const auto k = static_cast<std::uint32_t>(z) / kStepsPerCell;
    const float above = (least_y - lanes.band_from[n]) * lanes.inverse_band[n];
    const std::int32_t plane = least_y >= lanes.low[n]
                                   ? std::min(static_cast<std::int32_t>(above) + 1,
                                              static_cast<std::int32_t>(kClearancePlanes) - 1)
                                   : 0;
    const std::uint32_t tile =
        k / kClearanceTile * static_cast<std::uint32_t>(lanes.tiles_x[n]) + i / kClearanceTile;
    const std::size_t cell =
        (std::size_t{tile} * kClearanceTile + k % kClearanceTile) * kClearanceTile +
        i % kClearanceTile;
    const RoomAround room =
        cells[static_cast<std::size_t>(lanes.first[n] + plane * lanes.band_cells[n]) + cell];
    // Room is counted from the middle of the cell; a cell that is not free has none.
    const auto middle_x = static_cast<float>(i * kStepsPerCell + 1);
    const auto middle_z = static_cast<float>(k * kStepsPerCell + 1);
    const float down_x = least_x - (middle_x - roomOn(kRoomDownX, room));
    const float up_x = middle_x + roomOn(kRoomUpX, room) - most_x;
    const float down_z = least_z - (middle_z - roomOn(kRoomDownZ, room));
    const float up_z = middle_z + roomOn(kRoomUpZ, room) - most_z;
    sure.down_x.values[n] = down_x;
    sure.up_x.values[n] = up_x;
    sure.down_z.values[n] = down_z;
    sure.up_z.values[n] = up_z;
    const bool is_free = down_x > 0 && up_x > 0 && down_z > 0 && up_z > 0;
    sure.free |= (is_free ? 1U : 0U) << n;
  }
  return sure;
}

}  // namespace

void surelyFreePortable(const ClearanceQuestion* questions, std::size_t count,
                        const RoomAround* cells, std::size_t stride, SureGroups* sure) noexcept {
  for (std::size_t n = 0; n < count; ++n) {
    sure[n] = surelyFree(*questions[n].lanes, cells, questions[n].bounds, stride);
  }
}

void boxesSurelyFreePortable(const BoxQuestion* questions, std::size_t count,
                             const RoomAround* cells, unsigned* free) noexcept {
  for (std::size_t n = 0; n < count; ++n) {
    std::array<float, kBounds * kLanes> of_all;
    for (std::size_t k = 0; k < of_all.size(); ++k) {
      of_all[k] = questions[n].bounds->values[k / kLanes];
    }
    free[n] = surelyFree(*questions[n].lanes, cells, of_all.data(), kLanes).free;
  }
}

unsigned freeAfterPortable(const ClearanceLanes& lanes, const SureGroups& sure, float x,
                           float z) noexcept {
  unsigned free = 0;
  for (std::size_t n = 0; n < kLanes; ++n) {
    const float by_x = x * lanes.inverse_step[n];
    const float by_z = z * lanes.inverse_step[n];
    const auto goes = [n](const SlackOfGroups& slack, float by) {
      return slack.values[n] >= by + kMoveRounding;
    };
    const bool is_free = goes(sure.down_x, -by_x) && goes(sure.up_x, by_x) &&
                         goes(sure.down_z, -by_z) && goes(sure.up_z, by_z);
    free |= (is_free ? 1U : 0U) << n;
  }
  return free & sure.free;
}

}  // namespace galactic::simulation
