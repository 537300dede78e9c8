#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/error.h"
#include "galactic/robot.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"
#include "sensors/scan_kernels.h"
#include "sensors/scan_plane.h"
#include "simulation/collision/resting_objects.h"
#include "simulation/motion/motion_model.h"
#include "support/random_stream.h"

namespace galactic::sensors {

/// The settings of a laser, from the options and, where those are unset, from the robot's recipe.
struct LaserSettings {
  /// Beams of one plane; 0: no laser.
  std::uint32_t beams = 0;
  /// The range of heights that each scan covers, above the floor, meters.
  std::vector<Span> heights;
  /// Radians.
  float field_of_view = 0;
  /// Meters.
  float range = 0;
  float least_range = 0;
  DrawnNumber noise = 0;
  /// Where the beams start, in the frame of the base, meters: +X is ahead, +Z to the right.
  float ahead = 0;
  float right = 0;
  /// Yaw of the laser in the frame of the base, radians.
  float yaw = 0;

  /// Elements of the observation.
  [[nodiscard]] std::size_t size() const { return beams * heights.size(); }
};

/// `motion`: of the same robot. Fails with kInvalidInput if the numbers contradict each other, and
/// with kUnsupported if an action or an episode moves the link that carries the laser.
[[nodiscard]] Result<LaserSettings> laserSettings(const LaserOptions& options, const Robot& robot,
                                                  const simulation::MotionModel& motion);

/// A floor on which robots stand: the index of its scene, and its height, meters.
struct StoodOn {
  std::uint32_t scene = 0;
  float floor = 0;
};

/// Where an env's laser is, and what it sees.
struct LaserView {
  std::uint32_t scene = 0;
  /// The point on the floor under the root, world frame.
  Vec3 base;
  /// Cosine and sine of the base's yaw.
  float cosine = 1;
  float sine = 0;
  const simulation::RestingObjects& objects;
  /// Standard deviation of a distance in this episode, meters.
  float noise = 0;
  /// The random numbers of this env and step.
  RandomStream random;
};

/// The lasers of all envs. Immutable after construction, so any thread may scan.
class Laser {
 public:
  /// No laser.
  Laser() = default;

  /// Cuts a plane through each scene at each of the settings' heights above each of the `floors`;
  /// floors within kFloorBand share their planes. Uses up to `threads` threads. Fails with
  /// kInvalidInput if a plane is blocked everywhere.
  [[nodiscard]] static Result<Laser> make(const LaserSettings& settings, const World& world,
                                          std::span<const StoodOn> floors, std::uint32_t threads);

  /// Writes the distances of an env as fractions of the range: 1 if nothing is within it. They are
  /// sorted plane by plane, and in a plane from the right to the left. Shape of `out`:
  /// settings.size(). A beam ends where a sphere of the scene's smallest radius would not be free
  /// of the static scene, or where it enters the box of a resting object; it passes through the
  /// robot and the held object. A robot that is on none of the floors scans the planes of the floor
  /// whose height is nearest.
  void scan(const LaserView& view, std::span<float> out) const noexcept;

  /// Numbers in a scan.
  [[nodiscard]] std::size_t size() const { return settings_.size(); }
  /// Standard deviation of a distance, meters: the range from which each episode draws it.
  [[nodiscard]] const DrawnNumber& noise() const { return settings_.noise; }
  /// Bytes of all planes.
  [[nodiscard]] std::size_t bytes() const;

 private:
  /// The planes of one floor, one for each of the heights.
  struct Floor {
    float height = 0;
    std::vector<ScanPlane> planes;
  };

  void aimBeams();
  [[nodiscard]] const Floor& floorAt(std::uint32_t scene, float height) const noexcept;
  void scanPlane(const LaserView& view, const ScanPlaneView& plane, const Span& heights,
                 const Vec3& origin, std::span<float> distances) const noexcept;
  void finish(std::span<const float> distances, float noise, RandomStream& random,
              std::span<float> out) const noexcept;

  LaserSettings settings_;
  ScanKernels kernels_;
  /// Directions of the beams in the frame of the base, padded to whole lanes.
  std::vector<float> beams_ahead_;
  std::vector<float> beams_right_;
  /// By scene, in ascending order of height.
  std::vector<std::vector<Floor>> floors_;
};

/// Floors whose heights differ by at most this share their planes, meters.
inline constexpr float kFloorBand = 0.1F;

}  // namespace galactic::sensors
