#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/pose.h"
#include "galactic/scene.h"
#include "galactic/world.h"

namespace galactic {

/// Straight lines in the world frame along which rays are cast or spheres are swept: three arrays
/// of the same length.
struct CastLines {
  /// Where the rays begin, or the centers of the spheres; meters, finite.
  std::span<const Vec3> origins;
  /// Finite and not zero; their lengths are ignored.
  std::span<const Vec3> directions;
  /// Longest distance to go, meters: 0 or more; may be infinite.
  std::span<const float> lengths;
};

/// What stops a ray or a sphere.
enum class CastEnd : std::uint8_t {
  kNothing = 0,  ///< Nothing: it goes its whole length.
  kScene = 1,    ///< The static scene.
  kObject = 2,   ///< An object.
  kRobot = 3,    ///< The robot.
  kOutside = 4,  ///< The end of the column grid: what lies beyond is unknown.
};

/// How far a ray or a sphere gets.
struct CastHit {
  /// Meters; 0 if it begins inside what stops it, or outside the grid.
  float distance = 0;
  CastEnd end = CastEnd::kNothing;
  /// For kObject, index into EnvState::objects; for kRobot, into Robot::links(); otherwise -1.
  std::int32_t index = -1;

  friend bool operator==(const CastHit&, const CastHit&) = default;
};

/// Whether casts see the robot of an env, and what it holds.
enum class CastRobot : std::uint8_t {
  kIsUnseen,  ///< Neither: for sensors that are mounted on the robot, such as the laser.
  kIsSeen,    ///< Both, as spheres.
};

/// Casts rays and sweeps spheres through a home as the simulation knows it: column grids of the
/// static scene, boxes of objects at rest, spheres of the robot and of what it holds. The nearest
/// thing stops a ray or sphere. Ties: scene before object before robot, and lower indices first.
/// Immutable, so safe to share between threads; copies are cheap. Answers depend neither on the
/// number of threads nor on other lines.
class RayCaster {
 public:
  /// Casts in a static scene alone, whose pack must outlive this.
  explicit RayCaster(const Scene& scene);
  /// Casts in an env whose state is `state`, with its objects where they are; the state must be one
  /// of this world. Throws ErrorException with kInvalidInput if the world has no such scene or
  /// episode, if the episode is in another scene, if the number of objects or positions is not that
  /// of the episode or robot, if EnvState::held is neither an object's index nor -1, if a number is
  /// not finite, or if a rotation is not of unit length. Keeps the world alive.
  RayCaster(const World& world, const EnvState& state, CastRobot robot = CastRobot::kIsUnseen);

  /// How far rays get. `hits`: one for each line, overwritten. Rays hit objects and the robot on
  /// the surface of their boxes and spheres, exactly except for rounding. For the scene, a ray uses
  /// the grid of the smallest radius r. It ends where a sphere of that radius would touch
  /// something: r before a surface that it meets head-on, r / cos(a) before one that it meets at an
  /// angle a. It passes through no gap narrower than 2 r. As in all queries, each cell is judged by
  /// its column. Uses up to `threads` threads (0: as many as there are processors). If the lengths
  /// of arrays differ or a line breaks the rules of CastLines, throws ErrorException with
  /// kInvalidInput before anything is written.
  void castRays(const CastLines& lines, std::span<CastHit> hits, std::uint32_t threads = 1) const;

  /// How far spheres of a radius in the working set get before they touch something: in the scene,
  /// up to where ColumnGrid::clearance() of that radius is no longer kFree. Objects and the robot
  /// are exact except for rounding. Otherwise like castRays(). A radius for which the scene has no
  /// grid is also refused.
  void sweepSpheres(float radius, const CastLines& lines, std::span<CastHit> hits,
                    std::uint32_t threads = 1) const;

  /// Whether spheres of a radius in the working set touch nothing where they are, like
  /// sweepSpheres() along lines of length 0. `centers`: world frame, meters, finite. `free`: 1 or 0
  /// for each, overwritten; also 0 outside the grid. Threads and errors are those of
  /// sweepSpheres().
  void areSpheresFree(float radius, std::span<const Vec3> centers, std::span<std::uint8_t> free,
                      std::uint32_t threads = 1) const;

 private:
  class Impl;
  std::shared_ptr<const Impl> impl_;
};

/// How far rays get in all envs of a batch as they are now. Each env has the same number of lines:
/// the first `lines` and `hits` belong to env 0, the next to env 1, and so on. Each env gives the
/// answers of RayCaster(simulator.world(), simulator.envState(env), robot).castRays(). Up to
/// `threads` threads share the envs (0: as many as there are processors). Throws ErrorException
/// with kInvalidInput before anything is written if castRays() would, if a step is under way, or if
/// the number of lines is not a multiple of the number of envs.
void castRaysInEnvs(const BatchSimulator& simulator, const CastLines& lines,
                    std::span<CastHit> hits, CastRobot robot = CastRobot::kIsUnseen,
                    std::uint32_t threads = 1);

/// The same for spheres of a radius in World::radii(), as in RayCaster::sweepSpheres().
void sweepSpheresInEnvs(const BatchSimulator& simulator, float radius, const CastLines& lines,
                        std::span<CastHit> hits, CastRobot robot = CastRobot::kIsUnseen,
                        std::uint32_t threads = 1);

}  // namespace galactic
