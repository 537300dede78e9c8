#include "sensors/way_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

namespace galactic::sensors {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Both neighbors along X, then both along Z.
constexpr std::array<PlanCell, 4> kAround{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
/// How far above and below a floor a point may be so that it can be reached from there, meters.
constexpr Span kReach{-0.3F, 2.2F};

/// Distance in the ground plane.
float across(const Vec3& a, const Vec3& b) {
  const float x = a.x - b.x;
  const float z = a.z - b.z;
  return std::sqrt(x * x + z * z);
}

/// Whether a line of sight to a point from the place `from` is free of the static scene, at either
/// of two heights above the point.
bool isInSight(const ColumnGrid& grid, const Vec3& point, const Vec3& from) {
  // What the point lies on or in does not count as between them.
  constexpr float kNear = 0.06F;
  const float length = across(point, from);
  for (const float above : {0.06F, 0.2F}) {
    bool is_open = true;
    for (float way = kNear; is_open && way < length; way += grid.spacing()) {
      const float share = way / length;
      is_open = grid.clearance({point.x + share * (from.x - point.x), point.y + above,
                                point.z + share * (from.z - point.z)}) == Clearance::kFree;
    }
    if (is_open) return true;
  }
  return false;
}

/// Spreads the lengths of paths over a plan by fast marching (Sethian 1999, "Fast Marching
/// Methods"): of second order if the next two cells in a line have lengths, otherwise of first
/// order.
class Spreading {
 public:
  explicit Spreading(const FloorPlan& plan)
      : plan_(plan),
        steps_{1, -1, plan.columnsX(), -plan.columnsX()},
        exits_(plan.cellCount()),
        tried_(plan.cellCount(), kInfinity),
        lengths_(plan.cellCount(), kInfinity) {
    for (std::size_t index = 0; index < exits_.size(); ++index) {
      const PlanCell cell = cellOf(index);
      unsigned exits = 0;
      for (std::size_t way = 0; way < kAround.size(); ++way) {
        const PlanCell next{cell.i + kAround[way].i, cell.k + kAround[way].k};
        if (plan.areConnected(cell, next)) exits |= 1U << way;
      }
      exits_[index] = static_cast<std::uint8_t>(exits);
    }
  }

  void begin(const PlanCell& cell, float length) { tryLength(plan_.indexOf(cell), length); }

  void run() {
    while (!waiting_.empty()) {
      std::ranges::pop_heap(waiting_, std::greater<>());
      const auto [length, index] = waiting_.back();
      waiting_.pop_back();
      if (lengths_[index] != kInfinity) continue;
      lengths_[index] = length;
      for (std::size_t way = 0; way < kAround.size(); ++way) {
        if (!leadsOn(index, way)) continue;
        const std::size_t next = beside(index, way);
        if (lengths_[next] == kInfinity) tryLength(next, reachedFrom(next));
      }
    }
  }

  /// Gives lengths to the impassable cells next to cells that have one.
  void widen() {
    std::vector<float> wide = lengths_;
    for (std::size_t index = 0; index < lengths_.size(); ++index) {
      const PlanCell cell = cellOf(index);
      if (lengths_[index] != kInfinity || plan_.isPassable(cell)) continue;
      for (std::int32_t k = -1; k <= 1; ++k) {
        for (std::int32_t i = -1; i <= 1; ++i) {
          const float step = i != 0 && k != 0 ? kPlanCell * std::sqrt(2.0F) : kPlanCell;
          wide[index] = std::min(wide[index], at({cell.i + i, cell.k + k}) + step);
        }
      }
    }
    lengths_ = std::move(wide);
  }

  /// The lengths of all cells; infinite for cells without a path.
  [[nodiscard]] const std::vector<float>& lengths() const { return lengths_; }

 private:
  /// A term (weight (length - from) / cell)^2 of the eikonal equation. The terms of an equation add
  /// up to 1.
  struct Term {
    float weight = 0;
    float from = kInfinity;
    /// The length if this is the only term: the path goes along the axis, from cell to cell.
    float alone = kInfinity;
  };

  [[nodiscard]] PlanCell cellOf(std::size_t index) const {
    const auto columns = static_cast<std::size_t>(plan_.columnsX());
    return {static_cast<std::int32_t>(index % columns), static_cast<std::int32_t>(index / columns)};
  }
  [[nodiscard]] float at(const PlanCell& cell) const {
    return plan_.isInside(cell) ? lengths_[plan_.indexOf(cell)] : kInfinity;
  }
  /// Whether a base can go from a cell to the one beside it.
  [[nodiscard]] bool leadsOn(std::size_t index, std::size_t way) const {
    return (static_cast<unsigned>(exits_[index]) >> way & 1U) != 0;
  }
  [[nodiscard]] std::size_t beside(std::size_t index, std::size_t way) const {
    return index + static_cast<std::size_t>(steps_[way]);
  }
  void tryLength(std::size_t index, float length) {
    if (!(length < tried_[index])) return;
    tried_[index] = length;
    waiting_.emplace_back(length, index);
    std::ranges::push_heap(waiting_, std::greater<>());
  }

  /// The term of the neighbor on one side of a cell, and of the cell behind that neighbor.
  [[nodiscard]] Term termOf(std::size_t index, std::size_t way) const {
    if (!leadsOn(index, way)) return {};
    const std::size_t first = beside(index, way);
    const float length = lengths_[first];
    if (length == kInfinity) return {};
    if (leadsOn(first, way)) {
      const float behind = lengths_[beside(first, way)];
      if (behind <= length) {
        return {1.5F, (4 * length - behind) / 3, length + kPlanCell};
      }
    }
    return {1, length, length + kPlanCell};
  }
  /// The term along X or Z for the side from which the path is shorter. `way`: the first of the two
  /// sides.
  [[nodiscard]] Term shorterOf(std::size_t index, std::size_t way) const {
    const Term one = termOf(index, way);
    const Term other = termOf(index, way + 1);
    return one.alone <= other.alone ? one : other;
  }
  /// Solves the eikonal equation at a cell, upwind, for the neighbors from which a base can come.
  [[nodiscard]] float reachedFrom(std::size_t index) const {
    const Term x = shorterOf(index, 0);
    const Term z = shorterOf(index, 2);
    const float alone = std::min(x.alone, z.alone);
    if (x.weight == 0 || z.weight == 0) return alone;
    const float square_x = x.weight * x.weight;
    const float square_z = z.weight * z.weight;
    const float sum = square_x + square_z;
    const float apart = x.from - z.from;
    const float rest = kPlanCell * kPlanCell - square_x * square_z / sum * apart * apart;
    if (!(rest > 0)) return alone;
    const float both = (square_x * x.from + square_z * z.from) / sum + std::sqrt(rest / sum);
    return both >= std::max(x.from, z.from) ? std::min(both, alone) : alone;
  }

  const FloorPlan& plan_;
  /// What to add to the index of a cell for each neighbor of kAround.
  std::array<std::ptrdiff_t, kAround.size()> steps_;
  /// For each cell, the directions of kAround in which a base can leave it, as bits.
  std::vector<std::uint8_t> exits_;
  /// The shortest lengths found so far.
  std::vector<float> tried_;
  /// Final lengths, which no other path can shorten.
  std::vector<float> lengths_;
  std::vector<std::pair<float, std::size_t>> waiting_;
};

/// Begins in the cells from which a hand can reach the point.
void beginAt(const FloorPlan& plan, const Scene& scene, const Vec3& point, Spreading& spreading) {
  const ColumnGrid& grid = scene.grids().front();
  const auto reach = static_cast<std::int32_t>(kLastLeg / kPlanCell) + 1;
  const PlanCell at = plan.cellAt(point.x, point.z);
  for (std::int32_t k = at.k - reach; k <= at.k + reach; ++k) {
    for (std::int32_t i = at.i - reach; i <= at.i + reach; ++i) {
      if (!plan.isPassable({i, k})) continue;
      const Vec3 from = plan.middle({i, k});
      const float above = point.y - from.y;
      const float length = across(point, from);
      if (!(above >= kReach.lo && above <= kReach.hi) || length > kLastLeg) continue;
      if (isInSight(grid, point, from)) spreading.begin({i, k}, length);
    }
  }
}

/// Begins in the cell of a place on the floor and in those around it.
void beginAround(const FloorPlan& plan, const Vec3& place, Spreading& spreading) {
  const PlanCell at = plan.cellAt(place.x, place.z);
  for (std::int32_t k = at.k - 1; k <= at.k + 1; ++k) {
    for (std::int32_t i = at.i - 1; i <= at.i + 1; ++i) {
      if (!plan.areConnected(at, {i, k})) continue;
      spreading.begin({i, k}, across(place, plan.middle({i, k})));
    }
  }
}

/// Spreads out from where it has begun, and returns the field.
std::vector<std::uint16_t> spreadOut(Spreading& spreading) {
  spreading.run();
  for (int n = 0; n < kBeside; ++n) spreading.widen();
  std::vector<std::uint16_t> field(spreading.lengths().size(), kNoWay);
  for (std::size_t n = 0; n < field.size(); ++n) {
    const float length = spreading.lengths()[n];
    if (length == kInfinity) continue;
    field[n] =
        static_cast<std::uint16_t>(std::min(std::lround(length / kWayUnit), long{kNoWay} - 1));
  }
  return field;
}

/// The length at a cell; infinite if no path leads from there.
float lengthAt(const FloorPlan& plan, std::span<const std::uint16_t> field, std::int32_t i,
               std::int32_t k) {
  const PlanCell cell{i, k};
  if (!plan.isInside(cell)) return kInfinity;
  const std::uint16_t value = field[plan.indexOf(cell)];
  return value == kNoWay ? kInfinity : static_cast<float>(value) * kWayUnit;
}

/// The length at a neighbor of `here`; infinite also beyond a ledge.
float lengthBeside(const FloorPlan& plan, std::span<const std::uint16_t> field,
                   const PlanCell& here, const PlanCell& neighbor) {
  if (plan.areApart(here, neighbor)) return kInfinity;
  return lengthAt(plan, field, neighbor.i, neighbor.k);
}

/// Change per cell from one neighbor to the other, or to `here` from the only neighbor that has a
/// path.
float slope(float before, float here, float after) {
  if (before == kInfinity) return after == kInfinity ? 0 : after - here;
  return after == kInfinity ? here - before : 0.5F * (after - before);
}

}  // namespace

std::vector<std::uint16_t> wayField(const FloorPlan& plan, const Scene& scene, const Vec3& point) {
  Spreading spreading(plan);
  beginAt(plan, scene, point, spreading);
  return spreadOut(spreading);
}

std::vector<std::uint16_t> wayFieldToPlace(const FloorPlan& plan, const Vec3& place) {
  Spreading spreading(plan);
  beginAround(plan, place, spreading);
  return spreadOut(spreading);
}

Way wayFrom(const FloorPlan& plan, std::span<const std::uint16_t> field, float x,
            float z) noexcept {
  const float u = (x - plan.minX()) / kPlanCell - 0.5F;
  const float v = (z - plan.minZ()) / kPlanCell - 0.5F;
  const auto i0 = static_cast<std::int32_t>(std::floor(u));
  const auto k0 = static_cast<std::int32_t>(std::floor(v));
  const float part_x = u - static_cast<float>(i0);
  const float part_z = v - static_cast<float>(k0);
  // The cell of the point; of the four cells, those beyond a ledge of it do not count.
  const PlanCell at = plan.cellAt(x, z);
  float weights = 0;
  float length = 0;
  float slope_x = 0;
  float slope_z = 0;
  for (const auto& [i, k, weight] : std::array<std::tuple<std::int32_t, std::int32_t, float>, 4>{
           {{i0, k0, (1 - part_x) * (1 - part_z)},
            {i0 + 1, k0, part_x * (1 - part_z)},
            {i0, k0 + 1, (1 - part_x) * part_z},
            {i0 + 1, k0 + 1, part_x * part_z}}}) {
    const float here = lengthAt(plan, field, i, k);
    const PlanCell cell{i, k};
    const int steps = std::abs(i - at.i) + std::abs(k - at.k);
    if (here == kInfinity || plan.areApart(at, cell, std::max(steps, 1))) continue;
    weights += weight;
    length += weight * here;
    slope_x += weight * slope(lengthBeside(plan, field, cell, {i - 1, k}), here,
                              lengthBeside(plan, field, cell, {i + 1, k}));
    slope_z += weight * slope(lengthBeside(plan, field, cell, {i, k - 1}), here,
                              lengthBeside(plan, field, cell, {i, k + 1}));
  }
  if (!(weights > 0)) return {};
  const float steep = std::sqrt(slope_x * slope_x + slope_z * slope_z);
  Way way{.distance = length / weights};
  if (steep > 0) {
    way.x = -slope_x / steep;
    way.z = -slope_z / steep;
  }
  return way;
}

}  // namespace galactic::sensors
