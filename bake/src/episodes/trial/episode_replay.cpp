#include "episodes/trial/episode_replay.h"

#include <algorithm>
#include <cmath>

#include "episodes/trial/memory_world.h"
#include "galactic/batch_simulator.h"

namespace galactic::bake {
namespace {

/// The robot follows the floor and finds its height again to within rounding; a push moves it by
/// more. Meters and radians.
constexpr float kStill = 1e-4F;

bool isNear(const Vec3& a, const Vec3& b) {
  const Vec3 way = a - b;
  return dot(way, way) <= kStill * kStill;
}

bool samePlace(const EnvState& a, const EnvState& b) {
  const auto near = [](float p, float q) { return std::abs(p - q) <= kStill; };
  return a.episode == b.episode && a.objects == b.objects &&
         isNear(a.world_from_root.translation, b.world_from_root.translation) &&
         std::ranges::equal(a.joint_positions, b.joint_positions, near);
}

/// Whether the simulator leaves the robot where the episode puts it, and has not pushed it clear of
/// anything.
bool standsWhereWanted(const EnvState& state, const Episode& episode) {
  Vec3 wanted = episode.base_position;
  wanted.y = state.world_from_root.translation.y;
  return isNear(state.world_from_root.translation, wanted);
}

/// Takes the step and judges each of the simulator's envs. They are at the start of the episodes
/// that the simulator did not skip.
void judgeStep(BatchSimulator& simulator, const SourceEpisodes& episodes,
               std::vector<ReplayEnd>& ends) {
  std::vector<EnvState> before;
  before.reserve(simulator.envCount());
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    before.push_back(simulator.envState(env));
  }
  const std::vector<float> actions(simulator.envCount() * simulator.actionCount(), 0.0F);
  simulator.step(actions);
  for (std::size_t env = 0; env < before.size(); ++env) {
    const EnvState& start = before[env];
    if (!standsWhereWanted(start, episodes.episodes[start.episode])) continue;
    const bool stands = samePlace(start, simulator.envState(env));
    ends[start.episode] = stands ? ReplayEnd::kStands : ReplayEnd::kMoved;
  }
}

}  // namespace

Result<std::vector<ReplayEnd>> replayEpisodes(std::span<const PackFile* const> packs,
                                              const SourceEpisodes& episodes) {
  const auto world = MemoryWorld::open(packs, episodes);
  if (!world) return tl::unexpected(world.error());
  std::vector<ReplayEnd> ends(episodes.episodes.size(), ReplayEnd::kBlocked);
  SimulationOptions options;
  options.envs = static_cast<std::uint32_t>(ends.size());
  options.threads = 1;
  options.order = EpisodeOrder::kLinear;
  options.task.kind = TaskKind::kNone;
  auto simulator = BatchSimulator::create(**world, options);
  if (!simulator) {
    if (simulator.error().name == kNoEpisodeStarts) return ends;
    return tl::unexpected(simulator.error());
  }
  judgeStep(*simulator, episodes, ends);
  return ends;
}

}  // namespace galactic::bake
