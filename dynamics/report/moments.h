#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/episodes/comparison.h"
#include "galactic/world.h"
#include "view/run_track.h"

namespace galactic::dynamics {

/// What went wrong at a moment. The unit of Moment::meters depends on it.
enum class MomentKind : std::uint8_t {
  /// The episode succeeds only in the simulation. The moment is when the hands begin to hold
  /// different things, or else the end of the episode. Meters: between the grips.
  kLost,
  /// The deepest contact that the simulation misses. Meters: its depth.
  kMissed,
  /// The grips are farthest apart while the hands hold the same. Meters: between the grips.
  kApart,
  /// An object is released and does not stay. Meters: how far it has moved two seconds later.
  kMoved,
};
inline constexpr std::array<std::string_view, 4> kMomentNames{"success lost", "contact missed",
                                                              "grips apart", "object moved"};

struct Moment {
  MomentKind kind = MomentKind::kLost;
  /// Index of the comparison.
  std::size_t comparison = 0;
  /// The state after this step.
  std::uint32_t step = 0;
  float meters = 0;
};

/// The worst moments, at most `most`: takes the worst remaining one of each kind in turn, in the
/// order of the kinds. Each episode has at most one moment of a kind. Distances up to kDisturbed do
/// not count. In a closed loop there is no kApart, since the actions differ.
[[nodiscard]] std::vector<Moment> worstMoments(const std::vector<EpisodeComparison>& episodes,
                                               std::size_t most, ComparisonMode mode);

/// The world in which to look at a moment, and after how many steps.
struct MomentPlace {
  bool is_simulation = false;
  std::uint32_t frame = 0;

  friend bool operator==(const MomentPlace&, const MomentPlace&) = default;
};

/// Contacts and releases are shown in the simulation, whose steps they count. Everything else is
/// shown in the dynamics, whose steps in a closed loop are its own. `steps`, `steps_in_dynamics`:
/// the length of the episode in both worlds; if the episode ends before the moment, its end is
/// shown.
[[nodiscard]] MomentPlace placeOf(const Moment& moment, std::size_t steps,
                                  std::size_t steps_in_dynamics);

/// An episode in both worlds; each is the first env of its track.
struct BothTracks {
  const RunTrack& simulated;
  const RunTrack& dynamic;
};

/// A moment in one of the worlds: the frame of its track, and the caption.
struct MomentSide {
  std::uint32_t frame = 0;
  std::string said;
};

struct MomentSides {
  MomentSide simulated;
  MomentSide dynamic;
  /// For a released object: its pose in the dynamics two seconds later. The rest of that picture is
  /// as in the simulation, without the robot.
  std::optional<Pose> rest;
};

/// How to show a moment in both worlds. In a replay, both are shown after the same step. In a
/// closed loop, the same step means little: for a lost success, both ends are shown, and otherwise
/// the frame of the dynamics in which the robot's pose is closest to that in the simulation. A
/// released object is shown two seconds later. If an episode ends before the moment, its end is
/// shown, or its start if it has no steps.
[[nodiscard]] MomentSides sidesOf(const Moment& moment, const EpisodeComparison& episode,
                                  const BothTracks& tracks, ComparisonMode mode);

/// "episode 17, step 203: grips apart, 0.123 m".
[[nodiscard]] std::string describe(const Moment& moment, const EpisodeComparison& episode,
                                   const World& world);

}  // namespace galactic::dynamics
