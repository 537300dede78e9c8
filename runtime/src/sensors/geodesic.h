#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/error.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"
#include "sensors/floor_plan.h"
#include "sensors/way_field.h"

namespace galactic::sensors {

/// The ends of an episode's paths, world frame.
struct Errand {
  std::uint32_t scene = 0;
  /// Position of the base at the start.
  Vec3 base;
  Vec3 target;
  Vec3 goal;
};

/// Elements of the observation: length and direction of the paths to the target and to the goal.
inline constexpr std::size_t kGeodesicSize = 6;
/// A target within this distance of its start or of the goal counts as being there, meters.
inline constexpr float kSamePlace = 0.3F;

/// The paths along the floor in all episodes, computed at construction. Immutable afterwards.
class Geodesic {
 public:
  /// Has no paths.
  Geodesic() = default;

  /// Makes a field for each point that an errand leads to; points in the same cell of a floor plan
  /// and the same 0.25 m band of heights share a field. Uses up to `threads` threads. Fails with
  /// kInvalidInput if the fields would take more than `most_megabytes`.
  [[nodiscard]] static Result<Geodesic> make(const World& world, const StandingRobot& robot,
                                             const GroundOptions& ground,
                                             std::span<const Errand> errands,
                                             std::uint32_t most_megabytes, std::uint32_t threads);

  /// The path of errand `n` from `base` to the goal.
  [[nodiscard]] Way toGoal(std::uint32_t n, const Vec3& base) const noexcept;
  /// The path of errand `n` from `base` to the target, whose current position is `target`. There is
  /// none unless the target is near its start or near the goal.
  [[nodiscard]] Way toTarget(std::uint32_t n, const Vec3& base, const Vec3& target) const noexcept;

  [[nodiscard]] std::size_t fieldCount() const noexcept { return fields_.size(); }
  [[nodiscard]] std::size_t bytes() const noexcept;

 private:
  struct Field {
    std::uint32_t plan = 0;
    Vec3 point;
    std::vector<std::uint16_t> lengths;
  };
  struct Known {
    Errand errand;
    std::uint32_t plan = 0;
    std::uint32_t to_target = 0;
    std::uint32_t to_goal = 0;
  };

  void planFloors(const World& world, const StandingRobot& robot, const GroundOptions& ground,
                  std::size_t most_bytes, std::uint32_t threads);
  void listFields();
  [[nodiscard]] Way along(std::uint32_t field, const Vec3& base) const noexcept;

  std::vector<Known> errands_;
  std::vector<FloorPlan> plans_;
  /// The scene of each plan.
  std::vector<std::uint32_t> scenes_;
  std::vector<Field> fields_;
};

}  // namespace galactic::sensors
