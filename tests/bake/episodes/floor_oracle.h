#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "double_pose.h"
#include "galactic/robot.h"
#include "galactic/scene.h"

namespace galactic::test {

/// The free spans of the column nearest to (x, z); none outside the grid.
inline std::vector<Span> nearestColumn(const ColumnGrid& grid, double x, double z) {
  const ColumnGridLayout& layout = grid.layout();
  const double i =
      std::floor((x - static_cast<double>(layout.min_x)) / static_cast<double>(layout.spacing));
  const double k =
      std::floor((z - static_cast<double>(layout.min_z)) / static_cast<double>(layout.spacing));
  if (i < 0 || k < 0 || i >= grid.columnsX() || k >= grid.columnsZ()) return {};
  std::vector<Span> spans(
      grid.spanCount(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k)));
  grid.spans(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), spans);
  return spans;
}

/// Turned about +Y, counter-clockwise seen from above.
inline Point turned(const Point& p, double yaw) {
  return {p[0] * std::cos(yaw) + p[2] * std::sin(yaw), p[1],
          p[2] * std::cos(yaw) - p[0] * std::sin(yaw)};
}

/// The robot's spheres and grasp point, in double precision.
struct OracleBody {
  struct Ball {
    Point center{};
    double radius = 0;
    std::size_t grid = 0;
  };

  std::vector<Ball> balls;
  Point grasp_point{};

  [[nodiscard]] OracleBody moved(const Point& offset, double yaw) const {
    OracleBody result = *this;
    const auto move = [&](const Point& p) {
      const Point q = turned(p, yaw);
      return Point{q[0] + offset[0], q[1] + offset[1], q[2] + offset[2]};
    };
    for (Ball& ball : result.balls) ball.center = move(ball.center);
    result.grasp_point = move(grasp_point);
    return result;
  }

  [[nodiscard]] bool isFree(const Scene& scene) const {
    return std::all_of(balls.begin(), balls.end(), [&](const Ball& ball) {
      return scene.grids()[ball.grid].clearance(floatOf(ball.center)) == Clearance::kFree;
    });
  }

  [[nodiscard]] bool touches(const PlacedBox& box) const {
    // Rounding of the floats in which the sampler decided.
    constexpr double kTolerance = 1e-5;
    return std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
      return distance(ball.center, box.nearest(ball.center)) < ball.radius - kTolerance;
    });
  }
};

/// The robot with its base at the origin, looking along +X.
inline OracleBody oracleBody(const Robot& robot, std::span<const float> positions) {
  std::vector<Pose> ground_from_link(robot.links().size());
  forwardKinematics(robot.links(), {{0, robot.base()->root_height, 0}, {}}, positions,
                    ground_from_link);
  OracleBody body;
  for (const SphereGroup& group : robot.groups()) {
    for (const SetSphere& sphere : group.spheres) {
      body.balls.push_back({transformed(ground_from_link[group.link], pointOf(sphere.center)),
                            static_cast<double>(robot.radii()[sphere.radius_index]),
                            sphere.radius_index});
    }
  }
  const EndEffector& hand = *robot.endEffector();
  body.grasp_point = transformed(ground_from_link[hand.link], pointOf(hand.grasp_point));
  return body;
}

/// Where the robot can stand, column by column: some heading of sixteen is free, and the column
/// belongs to the largest part of the floor over columns side by side.
class FloorOracle {
 public:
  FloorOracle(const Scene& scene, const Robot& robot)
      : grid_(scene.grids().back()), fine_grid_(scene.grids().front()) {
    const ColumnGridLayout& layout = grid_.layout();
    for (std::uint32_t k = 0; k < grid_.columnsZ(); ++k) {
      for (std::uint32_t i = 0; i < grid_.columnsX(); ++i) {
        const double x =
            static_cast<double>(layout.min_x) + (i + 0.5) * static_cast<double>(layout.spacing);
        const double z =
            static_cast<double>(layout.min_z) + (k + 0.5) * static_cast<double>(layout.spacing);
        addPlaces(scene, i, k, {x, 0, z});
      }
    }
    first_.push_back(places_.size());
    testHeadings(scene, robot);
    joinNeighbors();
    std::vector<std::size_t> sizes(places_.size(), 0);
    for (std::size_t n = 0; n < places_.size(); ++n) {
      if (places_[n].stands) ++sizes[rootOf(n)];
    }
    largest_ =
        static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  }

  [[nodiscard]] std::size_t placesTried() const { return places_.size(); }
  [[nodiscard]] std::size_t placesOnLargestPart() const {
    std::size_t count = 0;
    for (std::size_t n = 0; n < places_.size(); ++n) {
      if (places_[n].stands && rootOf(n) == largest_) ++count;
    }
    return count;
  }

  /// The height of the largest part of the floor at (x, z), if it is there.
  [[nodiscard]] std::optional<double> largestPartAt(double x, double z) const {
    const auto [first, last] = rangeAt(x, z);
    for (std::size_t n = first; n < last; ++n) {
      if (places_[n].stands && rootOf(n) == largest_) return places_[n].at[1];
    }
    return std::nullopt;
  }

  /// Whether (x, y, z) is on the floor there, and a place of the largest part is not a step away.
  [[nodiscard]] bool isOnLargestPart(double x, double y, double z) const {
    // The generator lifts the base's point by 0.1 mm; a floor is known to 0.1 mm.
    constexpr double kTolerance = 0.001;
    const std::optional<double> part = largestPartAt(x, z);
    if (!part || std::abs(*part - y) > kStep) return false;
    const std::vector<Span> spans = nearestColumn(fine_grid_, x, z);
    return std::any_of(spans.begin(), spans.end(), [&](const Span& span) {
      const double floor = static_cast<double>(span.lo) - static_cast<double>(fine_grid_.radius());
      return std::abs(floor - y) < kTolerance;
    });
  }

  /// Whether `is` holds for the height of some place of the largest part within a distance.
  [[nodiscard]] bool anyOnLargestPart(const Point& p, double reach,
                                      const std::function<bool(double)>& is) const {
    for (std::size_t n = 0; n < places_.size(); ++n) {
      const Place& place = places_[n];
      if (!place.stands || std::hypot(place.at[0] - p[0], place.at[2] - p[2]) > reach) continue;
      if (rootOf(n) == largest_ && is(place.at[1])) return true;
    }
    return false;
  }

 private:
  struct Place {
    Point at{};
    bool stands = false;
  };

  void addPlaces(const Scene& scene, std::uint32_t i, std::uint32_t k, Point at) {
    first_.push_back(places_.size());
    std::vector<Span> spans(grid_.spanCount(i, k));
    grid_.spans(i, k, spans);
    const double radius = static_cast<double>(scene.grids().front().radius());
    for (const Span& span : spans) {
      for (const Span& small : nearestColumn(scene.grids().front(), at[0], at[2])) {
        if (small.lo > span.lo || span.lo > small.hi) continue;
        at[1] = static_cast<double>(small.lo) - radius;
        places_.push_back({at, false});
      }
    }
  }

  void testHeadings(const Scene& scene, const Robot& robot) {
    const OracleBody body = oracleBody(robot, robot.startPositions());
    constexpr int kHeadings = 16;
    for (int heading = 0; heading < kHeadings; ++heading) {
      const OracleBody there = body.moved({}, 2 * std::numbers::pi * heading / kHeadings);
      for (Place& place : places_) {
        place.stands = place.stands || there.moved(place.at, 0).isFree(scene);
      }
    }
    parent_.resize(places_.size());
    for (std::size_t n = 0; n < parent_.size(); ++n) parent_[n] = n;
  }

  void joinNeighbors() {
    const std::size_t width = grid_.columnsX();
    const auto join = [&](std::size_t a, std::size_t b) {
      for (std::size_t n = first_[a]; n < first_[a + 1]; ++n) {
        for (std::size_t m = first_[b]; m < first_[b + 1]; ++m) {
          if (!places_[n].stands || !places_[m].stands) continue;
          if (std::abs(places_[n].at[1] - places_[m].at[1]) <= kStep)
            parent_[rootOf(n)] = rootOf(m);
        }
      }
    };
    for (std::size_t column = 0; column + 1 < first_.size(); ++column) {
      if ((column + 1) % width != 0) join(column, column + 1);
      if (column + width + 1 < first_.size()) join(column, column + width);
    }
  }

  [[nodiscard]] std::size_t rootOf(std::size_t n) const {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }

  [[nodiscard]] std::pair<std::size_t, std::size_t> rangeAt(double x, double z) const {
    const ColumnGridLayout& layout = grid_.layout();
    const double i =
        std::floor((x - static_cast<double>(layout.min_x)) / static_cast<double>(layout.spacing));
    const double k =
        std::floor((z - static_cast<double>(layout.min_z)) / static_cast<double>(layout.spacing));
    if (i < 0 || k < 0 || i >= grid_.columnsX() || k >= grid_.columnsZ()) return {0, 0};
    const std::size_t column =
        static_cast<std::size_t>(k) * grid_.columnsX() + static_cast<std::size_t>(i);
    return {first_[column], first_[column + 1]};
  }

  /// The step that a run's base takes, meters.
  static constexpr double kStep = 0.05;

  ColumnGrid grid_;
  ColumnGrid fine_grid_;
  std::vector<Place> places_;
  std::vector<std::size_t> first_;
  mutable std::vector<std::size_t> parent_;
  std::size_t largest_ = 0;
};

}  // namespace galactic::test
