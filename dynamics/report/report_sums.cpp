#include "dynamics/report/report_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace galactic::dynamics {
namespace {

void addGaps(const EpisodeComparison& episode, Sums& sums) {
  for (Gap& gap : sums.gaps) {
    if (episode.base_gap.size() < gap.step) continue;
    gap.base.push_back(static_cast<double>(episode.base_gap[gap.step - 1]));
    gap.grip.push_back(static_cast<double>(episode.grip_gap[gap.step - 1]));
  }
}

void addRests(const EpisodeComparison& episode, Sums& sums) {
  for (const Rest& rest : episode.rests) {
    sums.displacements.push_back(static_cast<double>(rest.displacement));
    sums.tipped += static_cast<double>(rest.lean) > kTipped ? 1U : 0U;
    sums.fallen += static_cast<double>(rest.drop) > kFallen ? 1U : 0U;
  }
}

void addOutcome(const EpisodeComparison& episode, Outcomes& outcomes) {
  const bool in_simulation = episode.succeedsInSimulation();
  const bool in_dynamics = episode.succeedsInDynamics();
  outcomes.in_simulation += in_simulation ? 1U : 0U;
  outcomes.in_dynamics += in_dynamics ? 1U : 0U;
  outcomes.settled += episode.success_settled ? 1U : 0U;
  outcomes.both += in_simulation && in_dynamics ? 1U : 0U;
  outcomes.picked += episode.picked_in_dynamics ? 1U : 0U;
  if (!in_simulation || in_dynamics) return;
  ++(episode.picked_in_dynamics ? outcomes.lost_later : outcomes.lost_picking);
}

}  // namespace

double Sums::perThousand(std::uint64_t count) const {
  return steps == 0 ? 0 : 1000 * static_cast<double>(count) / static_cast<double>(steps);
}

std::uint64_t Sums::inventedSteps() const {
  std::uint64_t sum = 0;
  for (const auto& [cause, count] : invented) sum += count;
  return sum;
}

std::map<MissCause, std::uint64_t> Sums::missedByCause() const {
  std::map<MissCause, std::uint64_t> causes;
  for (const auto& [key, count] : missed) causes[std::get<MissCause>(key)] += count;
  return causes;
}

std::uint32_t Sums::away() const {
  return static_cast<std::uint32_t>(
      std::ranges::count_if(displacements, [](double d) { return d > kAway; }));
}

Sums sumOf(const std::vector<EpisodeComparison>& episodes) {
  Sums sums;
  sums.episodes = static_cast<std::uint32_t>(episodes.size());
  for (const std::size_t step : std::to_array<std::size_t>({1, 10, 20, 50, 100, 200, 500})) {
    sums.gaps.push_back({.step = step, .base = {}, .grip = {}});
  }
  for (const EpisodeComparison& episode : episodes) {
    addOutcome(episode, sums.outcomes);
    sums.disturbed += episode.disturbed;
    sums.steps += episode.steps;
    sums.steps_in_dynamics += episode.steps_in_dynamics;
    sums.missed_steps += episode.missed_steps;
    sums.hindered += episode.hindered;
    for (const auto& [cause, count] : episode.invented) sums.invented[cause] += count;
    for (const auto& [key, count] : episode.missed) sums.missed[key] += count;
    sums.tracking_sum += episode.tracking_sum;
    sums.tracking_worst = std::max(sums.tracking_worst, episode.tracking_worst);
    addGaps(episode, sums);
    addRests(episode, sums);
  }
  std::erase_if(sums.gaps, [](const Gap& gap) { return gap.base.empty(); });
  return sums;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace galactic::dynamics
