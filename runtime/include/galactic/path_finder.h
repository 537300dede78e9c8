#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "galactic/pose.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"

namespace galactic {

namespace sensors {
class FloorPlan;
}

/// The shortest way of a base along the floor, from where it is to a goal.
struct GeodesicWay {
  /// Meters; infinite where there is none.
  float distance = std::numeric_limits<float>::infinity();
  /// Unit direction in which it begins, world frame; (0, 0) without a way or at its end, within
  /// 0.1 mm of which the distance is 0.
  float x = 0;
  float z = 0;
};

/// Shortest ways to some goals from everywhere on a floor. Immutable, and valid without its
/// PathFinder. One that no PathFinder has made has no goals. Numbers of goals that there are not
/// throw ErrorException with kInvalidInput; from places with numbers that are not finite, there is
/// no way.
class GeodesicFields {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return goals_.size(); }
  [[nodiscard]] std::span<const Vec3> goals() const noexcept { return goals_; }

  /// The way of a base to goal `n`. A base may be three cells beside the floor, nearer to things
  /// than the start pose can be, and half a meter above it. Ways are known up to 127 m. O(1).
  [[nodiscard]] GeodesicWay way(std::size_t n, const Vec3& base) const;
  /// Corners of a path to goal `n` along straight lines over navigable cells, from `base` on; empty
  /// where there is none. It ends at the goal, or for GoalOf::kHand where the hand reaches it. Its
  /// length is that of way() within some percent.
  [[nodiscard]] std::vector<Vec3> path(std::size_t n, const Vec3& base) const;

 private:
  friend class PathFinder;
  std::shared_ptr<const sensors::FloorPlan> plan_;
  std::vector<Vec3> goals_;
  bool are_places_ = true;
  /// Of each goal, sensors::wayField().
  std::vector<std::vector<std::uint16_t>> lengths_;
};

/// What is to get to a goal.
enum class GoalOf : std::uint8_t {
  /// The base, to a place on the floor.
  kBase,
  /// The hand, to what it can reach over the last 1.25 m from the floor, as the geodesic sensor
  /// has it.
  kHand,
};

/// Where the robot of a world can drive on one floor of a scene, and the shortest paths there. The
/// floor consists of cells of 10 cm in which the robot's start pose is free of the static scene in
/// some heading, and which lie within a step (GroundOptions) of a neighbor; objects are not in the
/// way. Lengths come from fast marching of second order (Sethian 1999), which is not bound to the
/// directions of cells. Immutable; copies share what they know, and keep the world.
class PathFinder {
 public:
  /// The floor at or up to half a meter under `start`, or that begins within 30 cm of there: where
  /// the base or the root of a robot is. kInvalidInput where there is none, where a number is
  /// not finite, where there is no such scene, and where `ground` is out of its ranges
  /// (checkOptions).
  [[nodiscard]] static Result<PathFinder> create(const World& world, std::uint32_t scene,
                                                 const Vec3& start,
                                                 const GroundOptions& ground = {});

  /// Edge of a cell, meters.
  [[nodiscard]] static float cellSize();
  /// Cells along X and along Z of the rectangle that the floor lies in.
  [[nodiscard]] std::int32_t columnsX() const;
  [[nodiscard]] std::int32_t columnsZ() const;
  /// Corner of the first cell, world frame, meters.
  [[nodiscard]] float minX() const;
  [[nodiscard]] float minZ() const;
  /// Of the floor in each cell, meters; NaN where the robot cannot go. Shape: columnsZ() x
  /// columnsX().
  [[nodiscard]] std::span<const float> heights() const;

  /// Whether a base may be here: in a cell of the floor, and not a storey above or below. False
  /// where a number is not finite.
  [[nodiscard]] bool isNavigable(const Vec3& base) const;
  /// The middle of the cell of the floor that is nearest to a point. O(cells). Throws
  /// ErrorException with kInvalidInput for a point with a number that is not finite, or further
  /// than 1000 km away.
  [[nodiscard]] Vec3 snap(const Vec3& point) const;
  /// The middles of all cells of the floor.
  [[nodiscard]] std::vector<Vec3> places() const;

  /// Shortest ways to goals; some milliseconds each, in up to `threads` threads (0: as many as
  /// there are processors). kInvalidInput where a base's goal is not navigable, or a
  /// hand's is no point of a scene.
  [[nodiscard]] Result<GeodesicFields> fieldsTo(std::span<const Vec3> goals, GoalOf of,
                                                std::uint32_t threads = 1) const;

 private:
  PathFinder(World world, std::uint32_t scene, std::shared_ptr<const sensors::FloorPlan> plan)
      : world_(std::move(world)), scene_(scene), plan_(std::move(plan)) {}

  World world_;
  /// Index into World::scenes().
  std::uint32_t scene_;
  std::shared_ptr<const sensors::FloorPlan> plan_;
};

}  // namespace galactic
