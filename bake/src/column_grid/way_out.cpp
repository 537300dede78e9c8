#include "column_grid/way_out.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <queue>
#include <vector>

#include "column_grid/column_at.h"

namespace galactic::bake {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();

/// A graph of a room's spans. Spans of neighboring columns are linked if they overlap in height.
class SpanGraph {
 public:
  explicit SpanGraph(const Columns& room)
      : room_(room),
        scene_(sceneBounds(room.frame)),
        column_of_(room.spans.size()),
        clearance_(room.spans.size(), kUnbounded) {
    for (std::size_t at = 0; at < room.frame.columnCount(); ++at) {
      std::fill(column_of_.begin() + room.first[at], column_of_.begin() + room.first[at + 1],
                static_cast<std::uint32_t>(at));
    }
    measureClearance();
  }

  [[nodiscard]] std::optional<WayOut> wayOutFrom(std::span<const std::uint32_t> starts) const;
  [[nodiscard]] std::vector<std::uint32_t> startsAt(std::span<const Vec3> seeds) const;
  [[nodiscard]] std::vector<std::uint32_t> roomiest() const;

 private:
  /// A step from one span to another, and how narrow the way has been so far.
  struct Step {
    float width = 0;
    std::uint32_t to = 0;
    WayOut narrowest;
    /// Ties go to the first span, so that the result depends only on the room.
    friend bool operator<(const Step& a, const Step& b) {
      return a.width != b.width ? a.width < b.width : a.to > b.to;
    }
  };

  [[nodiscard]] std::uint32_t i(std::uint32_t span) const {
    return column_of_[span] % room_.frame.columns_x;
  }
  [[nodiscard]] std::uint32_t k(std::uint32_t span) const {
    return column_of_[span] / room_.frame.columns_x;
  }
  [[nodiscard]] Vec3 centerAt(std::uint32_t span, float height) const {
    return {static_cast<float>(room_.frame.centerX(i(span))), height,
            static_cast<float>(room_.frame.centerZ(k(span)))};
  }
  [[nodiscard]] bool isOutside(std::uint32_t span) const {
    const Span& heights = room_.spans[span];
    const Vec3 at = centerAt(span, heights.lo);
    return at.x < scene_.min.x || at.x > scene_.max.x || at.z < scene_.min.z ||
           at.z > scene_.max.z || heights.lo > scene_.max.y || heights.hi < scene_.min.y;
  }

  /// Calls `each(neighbor)` for the linked spans on one side. Returns whether there are any or the
  /// grid ends there.
  template <class Each>
  bool visitSide(std::uint32_t span, int side, const Each& each) const {
    constexpr std::array<std::array<int, 2>, 4> kSides{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
    const std::int64_t x = std::int64_t{i(span)} + kSides[static_cast<std::size_t>(side)][0];
    const std::int64_t z = std::int64_t{k(span)} + kSides[static_cast<std::size_t>(side)][1];
    if (x < 0 || z < 0 || x >= room_.frame.columns_x || z >= room_.frame.columns_z) return true;
    const std::size_t at =
        room_.index(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(z));
    bool any = false;
    for (std::uint32_t other = room_.first[at]; other < room_.first[at + 1]; ++other) {
      if (overlapOf(span, other) <= 0) continue;
      any = true;
      each(other);
    }
    return any;
  }

  [[nodiscard]] float overlapOf(std::uint32_t a, std::uint32_t b) const {
    return std::min(room_.spans[a].hi, room_.spans[b].hi) -
           std::max(room_.spans[a].lo, room_.spans[b].lo);
  }

  /// Measures the horizontal distance of each span to the nearest one that is blocked on a side,
  /// meters.
  void measureClearance() {
    std::vector<std::uint32_t> front;
    for (std::uint32_t span = 0; span < clearance_.size(); ++span) {
      bool is_bounded = false;
      for (int side = 0; side < 4; ++side) is_bounded |= !visitSide(span, side, [](auto) {});
      if (!is_bounded) continue;
      clearance_[span] = room_.frame.spacing / 2;
      front.push_back(span);
    }
    while (!front.empty()) {
      std::vector<std::uint32_t> next;
      for (const std::uint32_t span : front) {
        for (int side = 0; side < 4; ++side) {
          visitSide(span, side, [&](std::uint32_t other) {
            if (clearance_[other] < kUnbounded) return;
            clearance_[other] = clearance_[span] + room_.frame.spacing;
            next.push_back(other);
          });
        }
      }
      front = std::move(next);
    }
  }

  /// The place and width of the link from `from` to `to`.
  [[nodiscard]] WayOut linkOf(std::uint32_t from, std::uint32_t to) const {
    const float lo = std::max({room_.spans[from].lo, room_.spans[to].lo, scene_.min.y});
    const float hi = std::min({room_.spans[from].hi, room_.spans[to].hi, scene_.max.y});
    const float wide = 2 * std::min(clearance_[from], isOutside(to) ? kUnbounded : clearance_[to]);
    return {.at = centerAt(isOutside(to) ? from : to, std::midpoint(lo, std::max(lo, hi))),
            .width = std::min(wide, overlapOf(from, to))};
  }

  const Columns& room_;
  Bounds scene_;
  std::vector<std::uint32_t> column_of_;
  /// Meters; kUnbounded if nothing blocks the way.
  std::vector<float> clearance_;
};

std::vector<std::uint32_t> SpanGraph::startsAt(std::span<const Vec3> seeds) const {
  std::vector<std::uint32_t> starts;
  for (const Vec3& seed : seeds) {
    const std::optional<std::size_t> at = columnAt(room_, seed);
    if (!at) continue;
    for (std::uint32_t span = room_.first[*at]; span < room_.first[*at + 1]; ++span) {
      const Span& heights = room_.spans[span];
      if (seed.y >= heights.lo && seed.y <= heights.hi) starts.push_back(span);
    }
  }
  return starts;
}

std::vector<std::uint32_t> SpanGraph::roomiest() const {
  std::vector<std::uint32_t> best;
  for (std::uint32_t span = 0; span < clearance_.size(); ++span) {
    if (isOutside(span) || room_.spans[span].hi > scene_.max.y) continue;
    if (best.empty() || clearance_[span] > clearance_[best.front()]) best = {span};
  }
  return best;
}

std::optional<WayOut> SpanGraph::wayOutFrom(std::span<const std::uint32_t> starts) const {
  std::vector<bool> is_done(room_.spans.size(), false);
  // Width of the widest way to each span found so far.
  std::vector<float> widest(room_.spans.size(), 0);
  std::priority_queue<Step> open;
  for (const std::uint32_t start : starts) {
    open.push({.width = kUnbounded, .to = start, .narrowest = {.at = {}, .width = kUnbounded}});
  }
  while (!open.empty()) {
    const Step step = open.top();
    open.pop();
    if (is_done[step.to]) continue;
    is_done[step.to] = true;
    if (isOutside(step.to)) {
      return step.width < kUnbounded ? std::optional(step.narrowest) : std::nullopt;
    }
    for (int side = 0; side < 4; ++side) {
      visitSide(step.to, side, [&](std::uint32_t other) {
        if (is_done[other]) return;
        const WayOut link = linkOf(step.to, other);
        const WayOut& narrowest = link.width < step.width ? link : step.narrowest;
        if (narrowest.width <= widest[other]) return;
        widest[other] = narrowest.width;
        open.push({.width = narrowest.width, .to = other, .narrowest = narrowest});
      });
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<WayOut> findWayOut(const Columns& room, std::span<const Vec3> seeds) {
  const SpanGraph graph(room);
  return graph.wayOutFrom(seeds.empty() ? graph.roomiest() : graph.startsAt(seeds));
}

}  // namespace galactic::bake
