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

/// What went wrong at a moment.
enum class MomentKind : std::uint8_t {
  /// The episode succeeds in the simulation alone; the hands begin to hold different things, or
  /// where they never do, the episode ends. Meters: between the grips.
  kLost,
  /// The deepest contact that the simulation does not see. Meters: how deep.
  kMissed,
  /// Farthest apart while the hands hold the same. Meters: between the grips.
  kApart,
  /// An object is let go that does not stay. Meters: how far it is two seconds later.
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

/// The worst moments, at most `most`: in turn the worst of each kind that is left, in the order of
/// the kinds. Of each kind and episode there is one. In a closed loop the actions differ, and that
/// the grips are apart means nothing. What is no more than kDisturbed apart or moved is no moment.
[[nodiscard]] std::vector<Moment> worstMoments(const std::vector<EpisodeComparison>& episodes,
                                               std::size_t most, ComparisonMode mode);

/// In which world a moment is seen, and after how many steps.
struct MomentPlace {
  bool is_simulation = false;
  std::uint32_t frame = 0;

  friend bool operator==(const MomentPlace&, const MomentPlace&) = default;
};

/// Contacts and releases are looked for in the simulation: their steps are its steps. All else is
/// seen in the dynamics, which in a closed loop takes steps of its own. `steps`,
/// `steps_in_dynamics`: of the episode in both worlds; where it ends before, its end is seen.
[[nodiscard]] MomentPlace placeOf(const Moment& moment, std::size_t steps,
                                  std::size_t steps_in_dynamics);

/// An episode in both worlds, each the first env of its track.
struct BothTracks {
  const RunTrack& simulated;
  const RunTrack& dynamic;
};

/// What a moment looks like in one of them: in which frame of its track, and what is to be said of
/// it.
struct MomentSide {
  std::uint32_t frame = 0;
  std::string said;
};

struct MomentSides {
  MomentSide simulated;
  MomentSide dynamic;
  /// Of an object that was let go, where it is in the dynamics two seconds later: all else is as in
  /// the simulation, and the robot is gone.
  std::optional<Pose> rest;
};

/// In a replay both are seen after the same step. In a closed loop the same step says nothing:
/// where a success is lost, both ends are seen, and else the dynamics when the robot stands
/// most as it does in the simulation. What an object did that was let go is seen two seconds later.
/// Where an episode ends before, its end is seen, and its start where it has no step.
[[nodiscard]] MomentSides sidesOf(const Moment& moment, const EpisodeComparison& episode,
                                  const BothTracks& tracks, ComparisonMode mode);

/// "episode 17, step 203: grips apart, 0.123 m".
[[nodiscard]] std::string describe(const Moment& moment, const EpisodeComparison& episode,
                                   const World& world);

}  // namespace galactic::dynamics
