#pragma once
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "galactic/simulation_options.h"
#include "galactic/world.h"
#include "sources.h"
#include "trace.h"
#include "world.h"

namespace galactic::dynamics {

/// What a link was in.
enum class Thing : std::uint8_t { kScene, kObject };

/// What became of an object where the simulation put it, two seconds later.
struct Rest {
  /// Of the object's origin, meters.
  float displacement = 0;
  /// How far its up axis turned away, radians.
  float lean = 0;
  /// How far it went down, meters.
  float drop = 0;
};

/// One episode in both worlds.
struct EpisodeReplay {
  std::uint32_t env = 0;
  std::uint32_t episode = 0;
  EpisodeEnd end = EpisodeEnd::kNone;
  bool success_there = false;
  /// Also two seconds after the last action.
  bool success_settled = false;
  /// Whether the hand there held the target at some time.
  bool picked_there = false;
  /// After each step: how far the roots are apart on the ground, and the grips; meters.
  std::vector<float> base_gap;
  std::vector<float> grip_gap;
  /// Over all steps and controlled joints: position there against its target, radians or meters.
  double tracking_sum = 0;
  double tracking_worst = 0;
  /// Steps in which a link of the robot, where the simulation has it, is deeper than kTolerance in
  /// the triangles of the scene or in the hull of a resting object: by link and thing.
  std::map<std::pair<std::uint32_t, Thing>, std::uint32_t> missed;
  /// Steps with any of them.
  std::uint32_t missed_steps = 0;
  /// Steps in which the simulation refused the motion or pushed the robot clear, with empty hand;
  /// and those of them in which the pose that the action asked for touches nothing.
  std::uint32_t hindered = 0;
  std::uint32_t invented = 0;
  /// Objects that the hand never held there and that are more than kDisturbed from their place.
  std::uint32_t disturbed = 0;
  std::vector<Rest> rests;
};

/// Meters.
inline constexpr float kDisturbed = 0.02F;

/// Plays the actions of an episode in a dynamics world that starts as the simulation did. The world
/// and the sources must outlive the call. Deterministic; thread-safe.
[[nodiscard]] EpisodeReplay replay(const EpisodeTrace& trace, const World& world,
                                   const SimulationOptions& simulation, const Sources& sources,
                                   const WorldOptions& options);

}  // namespace galactic::dynamics
