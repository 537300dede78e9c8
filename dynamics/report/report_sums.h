#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "dynamics/episodes/comparison.h"

namespace galactic::dynamics {

/// Farther is away, leaning more is tipped, lower is fallen: meters, radians, meters.
inline constexpr double kAway = 0.05;
inline constexpr double kTipped = 0.52359877559829887;
inline constexpr double kFallen = 0.1;

/// How far the worlds are apart after so many steps, of the episodes that are as long.
struct Gap {
  std::size_t step = 0;
  std::vector<double> base;
  std::vector<double> grip;
};

/// Of all episodes, by what became of the target in both worlds.
struct Outcomes {
  std::uint32_t in_simulation = 0;
  std::uint32_t in_dynamics = 0;
  std::uint32_t settled = 0;
  std::uint32_t both = 0;
  /// Target in the hand at some time, in the dynamics.
  std::uint32_t picked = 0;
  /// Of the successes in the simulation that are none in the dynamics: the hand never held the
  /// target there; it did, and the target is elsewhere at the end.
  std::uint32_t lost_picking = 0;
  std::uint32_t lost_later = 0;
};

/// All episodes together.
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

  /// Of the steps of the simulation.
  [[nodiscard]] double perThousand(std::uint64_t count) const;
  [[nodiscard]] std::uint64_t inventedSteps() const;
  /// Contacts that a cause hides, by cause.
  [[nodiscard]] std::map<MissCause, std::uint64_t> missedByCause() const;
  /// Objects that were let go and are more than kAway from where they were put.
  [[nodiscard]] std::uint32_t away() const;
};

[[nodiscard]] Sums sumOf(const std::vector<EpisodeComparison>& episodes);

/// The value that `share` of the values do not exceed, 0 of none.
[[nodiscard]] double quantile(std::vector<double> values, double share);

}  // namespace galactic::dynamics
