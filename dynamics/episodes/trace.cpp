#include "dynamics/episodes/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "support/try.h"

namespace galactic::dynamics {
namespace {

std::optional<std::size_t> heldIn(const EnvState& state) {
  if (state.held < 0) return std::nullopt;
  return static_cast<std::size_t>(state.held);
}

/// Replays a recording in the simulation. An env stays at the end of its episode until that was
/// read.
class RecordingReplay {
 public:
  RecordingReplay(RecordingReader& recording, BatchSimulator& simulator)
      : recording_(recording),
        simulator_(simulator),
        actions_(simulator.envCount() * simulator.actionCount()) {
    for (std::uint32_t env = 0; env < simulator_.envCount(); ++env) {
      current_.push_back(beginTrace(env, simulator_.envState(env)));
    }
    done_.resize(simulator_.envCount());
  }

  Result<void> step(std::uint64_t number) {
    ASSIGN_OR_RETURN(const std::uint64_t digest, recording_.next(actions_));
    const std::size_t count = simulator_.actionCount();
    std::vector<SimulationStatistics> before;
    for (std::size_t env = 0; env < current_.size(); ++env) {
      before.push_back(simulator_.statistics(env));
    }
    const std::vector<std::uint8_t> idle(simulator_.idle().begin(), simulator_.idle().end());
    simulator_.step(actions_);
    std::vector<std::int32_t> resets(current_.size(), BatchSimulator::kStays);
    for (std::size_t env = 0; env < current_.size(); ++env) {
      if (idle[env] != 0) continue;
      extendTrace(current_[env], std::span(actions_).subspan(env * count, count),
                  simulator_.envState(env), before[env], simulator_.statistics(env));
      if (simulator_.dones()[env] == 0) continue;
      current_[env].end = simulator_.endings()[env];
      resets[env] = BatchSimulator::kNextEpisode;
    }
    simulator_.reset(resets);
    for (std::size_t env = 0; env < current_.size(); ++env) {
      if (resets[env] == BatchSimulator::kStays) continue;
      done_[env].push_back(std::exchange(
          current_[env], beginTrace(static_cast<std::uint32_t>(env), simulator_.envState(env))));
      ++finished_;
    }
    if (digestOf(simulator_) == digest) return {};
    return fail(ErrorCode::kInvalidInput, recording_.where(),
                fmt::format("step {} differs from the recording; compare the versions of the "
                            "programs and the processors",
                            number));
  }

  [[nodiscard]] std::size_t finished() const { return finished_; }

  std::vector<EpisodeTrace> take() {
    std::vector<EpisodeTrace> all;
    for (auto& env : done_) {
      std::ranges::move(env, std::back_inserter(all));
    }
    return all;
  }

 private:
  RecordingReader& recording_;
  BatchSimulator& simulator_;
  std::vector<float> actions_;
  std::vector<EpisodeTrace> current_;
  std::vector<std::vector<EpisodeTrace>> done_;
  std::size_t finished_ = 0;
};

}  // namespace

EpisodeTrace beginTrace(std::uint32_t env, const EnvState& state) {
  return {.env = env,
          .scene = state.scene,
          .episode = state.episode,
          .start_root = state.world_from_root,
          .start_positions = state.joint_positions,
          .start_objects = state.objects,
          .target = state.target,
          .goal = state.goal,
          .steps = {},
          .releases = {}};
}

void extendTrace(EpisodeTrace& trace, std::span<const float> actions, const EnvState& after,
                 const SimulationStatistics& was, const SimulationStatistics& is) {
  const std::optional<std::size_t> before =
      trace.steps.empty() ? std::nullopt : trace.steps.back().held;
  const std::optional<std::size_t> held = heldIn(after);
  if (before && !held) {
    trace.releases.push_back({trace.steps.size(), *before, after.objects[*before]});
  }
  trace.steps.push_back({.actions = {actions.begin(), actions.end()},
                         .world_from_root = after.world_from_root,
                         .positions = after.joint_positions,
                         .held = held,
                         .world_from_held = held ? after.objects[*held] : Pose{},
                         .was_refused = is.refused != was.refused,
                         .has_slid = is.slid != was.slid});
}

std::vector<Pose> objectsAfter(const EpisodeTrace& trace, std::size_t step) {
  std::vector<Pose> objects = trace.start_objects;
  for (const TracedRelease& release : trace.releases) {
    if (release.step <= step) objects[release.object] = release.world_from_object;
  }
  const TracedStep& now = trace.steps[step];
  if (now.held) objects[*now.held] = now.world_from_held;
  return objects;
}

Result<std::vector<EpisodeTrace>> tracesOf(RecordingReader& recording, const World& world,
                                           std::size_t most) {
  RETURN_IF_ERROR(checkWorld(recording, world));
  SimulationOptions options = recording.subject().options;
  options.auto_reset = false;
  ASSIGN_OR_RETURN(auto simulator, BatchSimulator::create(world, options));
  if (recording.subject().actions != simulator.actionCount()) {
    return fail(ErrorCode::kInvalidInput, recording.where(),
                fmt::format("has {} actions per env, expected the robot's {}; record it again",
                            recording.subject().actions, simulator.actionCount()));
  }
  RecordingReplay replay(recording, simulator);
  for (std::uint64_t n = 0; n < recording.steps(); ++n) {
    RETURN_IF_ERROR(replay.step(n));
    if (most != 0 && replay.finished() >= most) break;
  }
  std::vector<EpisodeTrace> traces = replay.take();
  if (most != 0 && traces.size() > most) traces.resize(most);
  return traces;
}

}  // namespace galactic::dynamics
