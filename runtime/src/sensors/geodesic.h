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

/// What an episode's ways lead from and to, world frame.
struct Errand {
  std::uint32_t scene = 0;
  /// The base at the start.
  Vec3 base;
  Vec3 target;
  Vec3 goal;
};

/// Elements of the observation: to the target and to the goal, length and direction.
inline constexpr std::size_t kGeodesicSize = 6;
/// A target this near to where it began, or to the goal, meters, is taken to be there.
inline constexpr float kSamePlace = 0.3F;

/// The ways along the floor of all episodes, worked out at the start. Immutable afterwards.
class Geodesic {
 public:
  /// None.
  Geodesic() = default;

  /// One field for each point that some errand leads to; points of one cell of a floor plan and
  /// one height, within 0.25 m, share one. Uses up to `threads` threads. Fails with kInvalidInput
  /// when fields would take more than `most_megabytes`.
  [[nodiscard]] static Result<Geodesic> make(const World& world, const StandingRobot& robot,
                                             const GroundOptions& ground,
                                             std::span<const Errand> errands,
                                             std::uint32_t most_megabytes, std::uint32_t threads);

  /// The way of errand `n` to its goal.
  [[nodiscard]] Way toGoal(std::uint32_t n, const Vec3& base) const noexcept;
  /// The way to the target, which is at `target` now; none where that is neither near to where it
  /// began nor to the goal.
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
  /// Of each plan.
  std::vector<std::uint32_t> scenes_;
  std::vector<Field> fields_;
};

}  // namespace galactic::sensors
