#include "dynamics/report/moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>

#include "dynamics/report/names.h"

namespace galactic::dynamics {
namespace {

std::optional<Moment> lostIn(const EpisodeComparison& episode) {
  if (!episode.succeedsInSimulation() || episode.succeedsInDynamics() || episode.grip_gap.empty()) {
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
  if (farthest == end || *farthest <= kDisturbed) return std::nullopt;
  return Moment{.kind = MomentKind::kApart,
                .step = static_cast<std::uint32_t>(farthest - episode.grip_gap.begin()),
                .meters = *farthest};
}

std::optional<Moment> movedIn(const EpisodeComparison& episode) {
  const auto farthest = std::ranges::max_element(episode.rests, {}, &Rest::displacement);
  if (farthest == episode.rests.end() || farthest->displacement <= kDisturbed) {
    return std::nullopt;
  }
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

std::uint32_t lastFrame(const RunTrack& track) { return static_cast<std::uint32_t>(track.steps()); }

/// The frame after a step in which the robot's pose is closest to that in a frame of another track,
/// by its root, a point ahead of it, and its joints. The first frame if there are no steps.
std::uint32_t likestFrame(const RunTrack& track, const RunTrack& other, std::uint32_t frame) {
  constexpr Vec3 kAhead{0.5F, 0, 0};
  // Meters that count as much as a radian, about as far as a joint moves the hand.
  constexpr float kReach = 0.5F;
  const std::size_t positions = track.positionCount();
  const auto root_of = [](const RunTrack& one, std::size_t at) -> const Pose& {
    return one.envs().front().world_from_root[at];
  };
  const auto joints_of = [positions](const RunTrack& one, std::size_t at) {
    return std::span(one.envs().front().joints).subspan(at * positions, positions);
  };
  const auto distance = [&](std::uint32_t at) {
    const Pose& a = root_of(track, at);
    const Pose& b = root_of(other, frame);
    const Vec3 away = a.translation - b.translation;
    const Vec3 ahead = a * kAhead - b * kAhead;
    float sum = dot(away, away) + dot(ahead, ahead);
    for (std::size_t n = 0; n < positions; ++n) {
      const float turned = kReach * (joints_of(track, at)[n] - joints_of(other, frame)[n]);
      sum += turned * turned;
    }
    return sum;
  };
  std::uint32_t best = std::min(1U, lastFrame(track));
  for (std::uint32_t at = best + 1; at <= lastFrame(track); ++at) {
    if (distance(at) < distance(best)) best = at;
  }
  return best;
}

}  // namespace

std::vector<Moment> worstMoments(const std::vector<EpisodeComparison>& episodes, std::size_t most,
                                 ComparisonMode mode) {
  Ranking ranking = rank(episodes);
  if (mode == ComparisonMode::kClosedLoop) {
    ranking[static_cast<std::size_t>(MomentKind::kApart)].clear();
  }
  std::vector<Moment> worst;
  for (std::size_t place = 0; place < episodes.size() && worst.size() < most; ++place) {
    for (const std::vector<Moment>& kind : ranking) {
      if (place < kind.size() && worst.size() < most) worst.push_back(kind[place]);
    }
  }
  return worst;
}

MomentPlace placeOf(const Moment& moment, std::size_t steps, std::size_t steps_in_dynamics) {
  const bool is_simulation =
      moment.kind == MomentKind::kMissed || moment.kind == MomentKind::kMoved;
  const auto last = static_cast<std::uint32_t>(is_simulation ? steps : steps_in_dynamics);
  return {is_simulation, std::min(moment.step + 1, last)};
}

MomentSides sidesOf(const Moment& moment, const EpisodeComparison& episode,
                    const BothTracks& tracks, ComparisonMode mode) {
  const auto& [simulated, dynamic] = tracks;
  const bool is_closed = mode == ComparisonMode::kClosedLoop;
  const std::string what = fmt::format("{}, {:.3f} m", nameOf(moment.kind), moment.meters);
  MomentSides sides{.simulated = {std::min(moment.step + 1, lastFrame(simulated)), what},
                    .dynamic = {std::min(moment.step + 1, lastFrame(dynamic)), {}},
                    .rest = {}};
  if (moment.kind == MomentKind::kMoved) {
    const auto rest = std::ranges::find(episode.rests, moment.step, &Rest::step);
    sides.simulated.said = "let go";
    sides.dynamic.said = "dynamics, 2 s later, " + what;
    sides.rest = rest->world_from_object;
  } else if (is_closed && moment.kind == MomentKind::kLost) {
    sides.simulated.frame = lastFrame(simulated);
    sides.simulated.said = nameOf(episode.end);
    sides.dynamic.frame = lastFrame(dynamic);
    sides.dynamic.said = fmt::format("{}, {}", nameOf(episode.end_in_dynamics), what);
  } else if (is_closed) {
    sides.dynamic.frame = likestFrame(dynamic, simulated, sides.simulated.frame);
    sides.dynamic.said = "most like it";
  }
  const auto timed = [](std::string_view world, const MomentSide& side) {
    const std::string when = side.frame == 0 ? "start" : fmt::format("step {}", side.frame);
    return fmt::format("{}, {}{}{}", world, when, side.said.empty() ? "" : ", ", side.said);
  };
  sides.simulated.said = timed("simulation", sides.simulated);
  if (!sides.rest) sides.dynamic.said = timed("dynamics", sides.dynamic);
  return sides;
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
