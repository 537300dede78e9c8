#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "galactic/batch_simulator.h"
#include "galactic/pose.h"
#include "galactic/scene.h"
#include "galactic/world.h"

namespace galactic {

/// Straight lines in the world frame, along which rays are cast and spheres swept: three arrays of
/// one length.
struct CastLines {
  /// Where the rays begin, or the centers of the spheres; meters, finite.
  std::span<const Vec3> origins;
  /// Finite, and not zero; their lengths play no part.
  std::span<const Vec3> directions;
  /// How far to go at most, meters: 0 and more, infinity included.
  std::span<const float> lengths;
};

/// What a ray or a sphere comes to.
enum class CastEnd : std::uint8_t {
  kNothing = 0,  ///< Nothing: it goes all its way.
  kScene = 1,    ///< The static scene.
  kObject = 2,   ///< An object.
  kRobot = 3,    ///< The robot.
  kOutside = 4,  ///< Where the column grid ends: it does not know what comes then.
};

/// How far a ray or a sphere gets.
struct CastHit {
  /// Meters; 0 where it begins in what it comes to, or outside the grid.
  float distance = 0;
  CastEnd end = CastEnd::kNothing;
  /// kObject: index into EnvState::objects; kRobot: into Robot::links(); else -1.
  std::int32_t index = -1;

  friend bool operator==(const CastHit&, const CastHit&) = default;
};

/// Whether casts see the robot of an env, and what it holds.
enum class CastRobot : std::uint8_t {
  kIsUnseen,  ///< Neither: for what is mounted on the robot, as the laser.
  kIsSeen,    ///< Both, as spheres.
};

/// Casts rays and sweeps spheres through a home as the simulation knows it: column grids of the
/// static scene, boxes of objects at rest, spheres of the robot and of what it holds. What is
/// nearest counts; of two that are equally near, scene before object before robot, and lower
/// indices first. Immutable, so safe to share between threads; copies are cheap. Answers depend
/// neither on the number of threads nor on other lines.
class RayCaster {
 public:
  /// Of a static scene alone, whose pack must outlive this.
  explicit RayCaster(const Scene& scene);
  /// Of an env as `state` has it, which has to be one of this world: with its objects where they
  /// are. Throws ErrorException with kInvalidInput where the world has no such scene or episode, or
  /// the episode is in another scene, where the episode or the robot has another number of objects
  /// or positions, where EnvState::held is no index of an object nor -1, and where a number is not
  /// finite or a rotation is not of unit length. Keeps the world.
  RayCaster(const World& world, const EnvState& state, CastRobot robot = CastRobot::kIsUnseen);

  /// How far rays get. `hits`: one for each line, overwritten. Objects and the robot are hit on
  /// the surface of their boxes and spheres, exactly but for rounding. Of the scene, a ray sees
  /// what the grid of the smallest radius r says: it ends where a sphere of that radius would
  /// touch, so r before a surface that it meets head-on, r / cos(a) before one that it meets at an
  /// angle a, and goes through no gap that is narrower than 2 r; like all queries, judged in each
  /// cell by its column. Uses up to `threads` threads (0: as many as there are processors).
  /// Throws ErrorException with kInvalidInput, before anything is written, where lengths of arrays
  /// differ or a line is not as CastLines wants it.
  void castRays(const CastLines& lines, std::span<CastHit> hits, std::uint32_t threads = 1) const;

  /// How far spheres of a radius of the working set get before they touch something: in the scene,
  /// up to where ColumnGrid::clearance() of that radius no longer says free. Objects and the robot
  /// are exact but for rounding. Else as castRays(); a radius that the scene has no grid for is
  /// refused, too.
  void sweepSpheres(float radius, const CastLines& lines, std::span<CastHit> hits,
                    std::uint32_t threads = 1) const;

  /// Whether spheres of a radius of the working set touch nothing where they are: what
  /// sweepSpheres() says of ways without length. `centers`: world frame, meters, finite. `free`: 1
  /// or 0 for each, overwritten; 0 also where the grid does not know. Threads and errors are those
  /// of sweepSpheres().
  void areSpheresFree(float radius, std::span<const Vec3> centers, std::span<std::uint8_t> free,
                      std::uint32_t threads = 1) const;

 private:
  class Impl;
  std::shared_ptr<const Impl> impl_;
};

/// How far rays get in all envs of a batch as they are now, as many in each: of `lines` and `hits`,
/// the first belong to env 0, as many next to env 1, and so on. Each env answers as
/// RayCaster(simulator.world(), simulator.envState(env), robot).castRays() does; up to `threads`
/// threads share the envs (0: as many as there are processors). Throws ErrorException with
/// kInvalidInput, before anything is written, where castRays() would, where a step has begun, or
/// where the number of lines is no multiple of that of the envs.
void castRaysInEnvs(const BatchSimulator& simulator, const CastLines& lines,
                    std::span<CastHit> hits, CastRobot robot = CastRobot::kIsUnseen,
                    std::uint32_t threads = 1);

/// The same for spheres of a radius of World::radii(), as RayCaster::sweepSpheres() has it.
void sweepSpheresInEnvs(const BatchSimulator& simulator, float radius, const CastLines& lines,
                        std::span<CastHit> hits, CastRobot robot = CastRobot::kIsUnseen,
                        std::uint32_t threads = 1);

}  // namespace galactic
