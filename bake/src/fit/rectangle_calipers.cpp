#include "fit/rectangle_calipers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace galactic::bake::fit {
namespace {

double crossOf(const Vec2d& origin, const Vec2d& a, const Vec2d& b) {
  return (a.x - origin.x) * (b.y - origin.y) - (a.y - origin.y) * (b.x - origin.x);
}

double along(const Vec2d& point, const Vec2d& direction) {
  return point.x * direction.x + point.y * direction.y;
}

/// Tracks the corner of a convex polygon that is farthest in a direction while that direction turns
/// counter-clockwise.
class TurningSupport {
 public:
  TurningSupport(std::span<const Vec2d> polygon, const Vec2d& direction) : polygon_(polygon) {
    double size = 0;
    for (std::size_t corner = 0; corner < polygon.size(); ++corner) {
      if (along(polygon[corner], direction) > along(polygon[at_], direction)) at_ = corner;
      size = std::max({size, std::abs(polygon[corner].x), std::abs(polygon[corner].y)});
    }
    slack_ = kRounding * size;
  }

  /// The greatest extent in `direction`, which must be at most half a turn after the last one.
  double turnTo(const Vec2d& direction) {
    double best = along(polygon_[at_], direction);
    std::size_t probe = at_;
    for (std::size_t step = 0; step < polygon_.size(); ++step) {
      probe = probe + 1 < polygon_.size() ? probe + 1 : 0;
      const double reached = along(polygon_[probe], direction);
      if (reached < best - slack_) break;
      if (reached < best) continue;
      best = reached;
      at_ = probe;
    }
    return best;
  }

 private:
  /// Rounding may make nearly coincident corners appear to go back by this share of the polygon's
  /// size.
  static constexpr double kRounding = 1e-12;

  double slack_ = 0;
  std::span<const Vec2d> polygon_;
  std::size_t at_ = 0;
};

}  // namespace

void convexPolygon(std::vector<Vec2d>& points, std::vector<Vec2d>& polygon) {
  std::sort(points.begin(), points.end(),
            [](const Vec2d& a, const Vec2d& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  polygon.clear();
  if (points.size() < 3) {
    polygon = points;
    return;
  }
  const auto extend = [&](const Vec2d& point, std::size_t fixed) {
    while (polygon.size() >= fixed + 2 &&
           crossOf(polygon[polygon.size() - 2], polygon.back(), point) <= 0) {
      polygon.pop_back();
    }
    polygon.push_back(point);
  };
  for (const Vec2d& point : points) extend(point, 0);
  const std::size_t lower = polygon.size() - 1;
  for (std::size_t at = points.size() - 1; at-- > 0;) extend(points[at], lower);
  polygon.pop_back();
}

Vec2d leastRectangleDirection(std::span<const Vec2d> polygon, double min_side) {
  if (polygon.size() < 2) return {1, 0};
  const auto edge_direction = [&](std::size_t from) {
    const Vec2d& a = polygon[from];
    const Vec2d& b = polygon[from + 1 < polygon.size() ? from + 1 : 0];
    const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
    return length > 0 ? Vec2d{(b.x - a.x) / length, (b.y - a.y) / length} : Vec2d{1, 0};
  };
  const Vec2d first = edge_direction(0);
  TurningSupport front(polygon, first);
  TurningSupport left(polygon, {-first.y, first.x});
  TurningSupport back(polygon, {-first.x, -first.y});
  Vec2d best_direction = first;
  double best_area = 0;
  for (std::size_t edge = 0; edge < polygon.size(); ++edge) {
    const Vec2d u = edge_direction(edge);
    const Vec2d v{-u.y, u.x};
    const double length = front.turnTo(u) + back.turnTo({-u.x, -u.y});
    const double width = left.turnTo(v) - along(polygon[edge], v);
    const double area = std::max(length, min_side) * std::max(width, min_side);
    if (edge == 0 || area < best_area) {
      best_area = area;
      best_direction = u;
    }
  }
  return best_direction;
}

}  // namespace galactic::bake::fit
