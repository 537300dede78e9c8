#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "dynamics/episodes/comparison.h"

namespace galactic::dynamics {

/// Thresholds above which a released object is away (meters), tipped (radians) or fallen (meters).
inline constexpr double kAway = 0.05;
inline constexpr double kTipped = 0.52359877559829887;
inline constexpr double kFallen = 0.1;

/// How far the worlds are apart after `step` steps, for the episodes that are that long; meters.
struct Gap {
  std::size_t step = 0;
  std::vector<double> base;
  std::vector<double> grip;
};

/// Counts of episodes, by what became of the target in both worlds.
struct Outcomes {
  std::uint32_t in_simulation = 0;
  std::uint32_t in_dynamics = 0;
  std::uint32_t settled = 0;
  std::uint32_t both = 0;
  /// The target was in the hand at some time in the dynamics.
  std::uint32_t picked = 0;
  /// Successes in the simulation that fail in the dynamics, because the hand never held the target
  /// there, or although it did.
  std::uint32_t lost_picking = 0;
  std::uint32_t lost_later = 0;
};

/// Sums over all episodes.
struct Sums {
  std::uint32_t episodes = 0;
  Outcomes outcomes;
  std::uint32_t disturbed = 0;
  std::uint64_t steps = 0;
  std::uint64_t steps_in_dynamics = 0;
  std::uint64_t missed_steps = 0;
  std::uint64_t hindered = 0;
  std::map<InventedCause, std::uint64_t> invented;
  std::map<MissKey, std::uint64_t> missed;
  double tracking_sum = 0;
  double tracking_worst = 0;
  std::vector<double> displacements;
  std::uint32_t tipped = 0;
  std::uint32_t fallen = 0;
  std::vector<Gap> gaps;

  /// `count` per thousand steps of the simulation.
  [[nodiscard]] double perThousand(std::uint64_t count) const;
  [[nodiscard]] std::uint64_t inventedSteps() const;
  /// Missed contacts, by cause.
  [[nodiscard]] std::map<MissCause, std::uint64_t> missedByCause() const;
  /// The number of released objects that moved by more than kAway.
  [[nodiscard]] std::uint32_t away() const;
};

[[nodiscard]] Sums sumOf(const std::vector<EpisodeComparison>& episodes);

/// The value that the share `share` of the values does not exceed; 0 if there are no values.
[[nodiscard]] double quantile(std::vector<double> values, double share);

}  // namespace galactic::dynamics
