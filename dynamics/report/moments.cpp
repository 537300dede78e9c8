#include "dynamics/report/moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "dynamics/report/names.h"

namespace galactic::dynamics {
namespace {

std::optional<Moment> lostIn(const EpisodeComparison& episode) {
  if (!episode.succeedsHere() || episode.succeedsThere() || episode.grip_gap.empty()) {
    return std::nullopt;
  }
  const auto last = static_cast<std::uint32_t>(episode.grip_gap.size()) - 1;
  const std::uint32_t step = episode.parted.value_or(last);
  return Moment{.kind = MomentKind::kLost, .step = step, .meters = episode.grip_gap[step]};
}

std::optional<Moment> missedIn(const EpisodeComparison& episode) {
  if (!episode.deepest) return std::nullopt;
  return Moment{
      .kind = MomentKind::kMissed, .step = episode.deepest->step, .meters = episode.deepest->depth};
}

std::optional<Moment> apartIn(const EpisodeComparison& episode) {
  const auto end =
      episode.grip_gap.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(
                                     episode.parted.value_or(UINT32_MAX), episode.grip_gap.size()));
  const auto farthest = std::max_element(episode.grip_gap.begin(), end);
  if (farthest == end || *farthest == 0) return std::nullopt;
  return Moment{.kind = MomentKind::kApart,
                .step = static_cast<std::uint32_t>(farthest - episode.grip_gap.begin()),
                .meters = *farthest};
}

std::optional<Moment> movedIn(const EpisodeComparison& episode) {
  const auto farthest = std::ranges::max_element(episode.rests, {}, &Rest::displacement);
  if (farthest == episode.rests.end()) return std::nullopt;
  return Moment{
      .kind = MomentKind::kMoved, .step = farthest->step, .meters = farthest->displacement};
}

/// The moments of each kind, the worst first.
using Ranking = std::array<std::vector<Moment>, kMomentNames.size()>;

Ranking rank(const std::vector<EpisodeComparison>& episodes) {
  Ranking ranking;
  for (std::size_t n = 0; n < episodes.size(); ++n) {
    for (const auto find : {lostIn, missedIn, apartIn, movedIn}) {
      std::optional<Moment> moment = find(episodes[n]);
      if (!moment) continue;
      moment->comparison = n;
      ranking[static_cast<std::size_t>(moment->kind)].push_back(*moment);
    }
  }
  for (std::vector<Moment>& kind : ranking) {
    std::ranges::stable_sort(kind, std::ranges::greater(), &Moment::meters);
  }
  return ranking;
}

}  // namespace

std::vector<Moment> worstMoments(const std::vector<EpisodeComparison>& episodes, std::size_t most,
                                 bool is_replay) {
  Ranking ranking = rank(episodes);
  if (!is_replay) ranking[static_cast<std::size_t>(MomentKind::kApart)].clear();
  std::vector<Moment> worst;
  for (std::size_t place = 0; place < episodes.size() && worst.size() < most; ++place) {
    for (const std::vector<Moment>& kind : ranking) {
      if (place < kind.size() && worst.size() < most) worst.push_back(kind[place]);
    }
  }
  return worst;
}

MomentPlace placeOf(const Moment& moment, std::size_t steps_here, std::size_t steps_there) {
  const bool is_simulation =
      moment.kind == MomentKind::kMissed || moment.kind == MomentKind::kMoved;
  const auto last = static_cast<std::uint32_t>(is_simulation ? steps_here : steps_there);
  return {is_simulation, std::min(moment.step + 1, last)};
}

std::string describe(const Moment& moment, const EpisodeComparison& episode, const World& world) {
  std::string text = fmt::format("episode {}, step {}: {}, {:.3f} m", episode.episode,
                                 moment.step + 1, nameOf(moment.kind), moment.meters);
  if (moment.kind == MomentKind::kMissed) {
    const auto& [link, thing, cause] = episode.deepest->key;
    text += fmt::format(" ({} in {})", world.robot().linkName(link), nameOf(thing));
  }
  return text;
}

}  // namespace galactic::dynamics
