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

/// The shortest path of a base along the floor, from where it is to a goal.
struct GeodesicWay {
  /// Length, meters; infinite if there is no path.
  float distance = std::numeric_limits<float>::infinity();
  /// Unit direction in which the path begins, world frame; (0, 0) if there is no path, or at its
  /// end: within 0.1 mm of it, the distance is 0.
  float x = 0;
  float z = 0;
};

/// Shortest paths to some goals from everywhere on a floor. Immutable, and valid without its
/// PathFinder. A default-constructed one has no goals. Indices of goals that are out of range throw
/// ErrorException with kInvalidInput. From places with numbers that are not finite, there is no
/// path.
class GeodesicFields {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return goals_.size(); }
  [[nodiscard]] std::span<const Vec3> goals() const noexcept { return goals_; }

  /// The shortest path of a base to goal `n`. The base may be up to three cells beside the floor,
  /// nearer to things than the start pose can be, and up to half a meter above it. Paths are known
  /// up to a length of 127 m. O(1).
  [[nodiscard]] GeodesicWay way(std::size_t n, const Vec3& base) const;
  /// Corners of a path to goal `n` along straight lines over navigable cells, beginning at `base`;
  /// empty if there is no path. The path ends at the goal or, for GoalOf::kHand, where the hand can
  /// reach it. Its length is within a few percent of that of way().
  [[nodiscard]] std::vector<Vec3> path(std::size_t n, const Vec3& base) const;

 private:
  friend class PathFinder;
  std::shared_ptr<const sensors::FloorPlan> plan_;
  std::vector<Vec3> goals_;
  bool are_places_ = true;
  /// sensors::wayField() of each goal.
  std::vector<std::vector<std::uint16_t>> lengths_;
};

/// What has to get to a goal.
enum class GoalOf : std::uint8_t {
  /// The base, to a place on the floor.
  kBase,
  /// The hand, to a place that it can reach from the floor over the last 1.25 m, as for the
  /// geodesic sensor.
  kHand,
};

/// Where a world's robot can drive on one floor of a scene, and the shortest paths there. The floor
/// consists of cells of 10 cm in which the robot's start pose is free of the static scene in some
/// heading, and which lie within a step (GroundOptions) of a neighbor. Objects are ignored. Lengths
/// come from second-order fast marching (Sethian 1999), which is not restricted to the directions
/// of the cells. Immutable; copies share their data, and keep the world alive.
class PathFinder {
 public:
  /// Finds the floor at `start` or up to half a meter below it, or one that begins within 30 cm of
  /// there. `start` is where the base or the root of a robot is. Fails with kInvalidInput if there
  /// is no floor, if a number is not finite, if there is no such scene, or if `ground` is out of
  /// range (checkOptions).
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
  /// Height of the floor in each cell, meters; NaN where the robot cannot go. Shape: columnsZ() x
  /// columnsX().
  [[nodiscard]] std::span<const float> heights() const;

  /// Whether a base may be here: in a cell of the floor, and not a storey above or below. False if
  /// a number is not finite.
  [[nodiscard]] bool isNavigable(const Vec3& base) const;
  /// The middle of the floor's cell that is nearest to a point. O(cells). Throws ErrorException
  /// with kInvalidInput if a number of the point is not finite, or if the point is further than
  /// 1000 km away.
  [[nodiscard]] Vec3 snap(const Vec3& point) const;
  /// The middles of all cells of the floor.
  [[nodiscard]] std::vector<Vec3> places() const;

  /// Shortest paths to goals. Takes some milliseconds per goal, on up to `threads` threads (0: as
  /// many as there are processors). Fails with kInvalidInput if a goal for the base is not
  /// navigable, or a goal for the hand is not a point of a scene.
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
