#include "view/run_track.h"

#include <algorithm>
#include <cmath>

namespace galactic {
namespace {

std::uint8_t bitOf(RunEvent event, std::uint64_t before, std::uint64_t after) {
  return after > before ? static_cast<std::uint8_t>(event) : std::uint8_t{0};
}

std::uint8_t eventsOf(const SimulationStatistics& before, const SimulationStatistics& after) {
  unsigned events = 0;
  events |= bitOf(RunEvent::kGrasp, before.grasps, after.grasps);
  events |= bitOf(RunEvent::kDrop, before.drops, after.drops);
  events |= bitOf(RunEvent::kRestore, before.restored, after.restored);
  events |= bitOf(RunEvent::kRefuse, before.refused, after.refused);
  events |= bitOf(RunEvent::kSlide, before.slid, after.slid);
  return static_cast<std::uint8_t>(events);
}

/// Among the placements of the episode; -1 for none.
std::int32_t heldPlacement(const EnvObjects& objects) {
  if (objects.held < 0) return objects.held;
  return static_cast<std::int32_t>(objects.present.first) + objects.held;
}

}  // namespace

RunTrack::RunTrack(const World& world, const BatchSimulator& simulator, std::size_t envs)
    : world_(&world),
      actions_(simulator.actionCount()),
      is_target_only_(!simulator.options().task.distractors),
      envs_(std::min(envs, simulator.envCount())),
      objects_(envs_.size()),
      statistics_(envs_.size()) {
  for (const ObservationPart& part : simulator.observationParts()) {
    const auto found = std::find(kTrackDistances.begin(), kTrackDistances.end(), part.name);
    if (found == kTrackDistances.end()) continue;
    distance_at_[static_cast<std::size_t>(found - kTrackDistances.begin())] = part.first;
  }
  for (std::size_t env = 0; env < envs_.size(); ++env) {
    addFrame(simulator, env);
    statistics_[env] = simulator.statistics(env);
  }
}

void RunTrack::add(const BatchSimulator& simulator, std::span<const float> actions) {
  for (std::size_t env = 0; env < envs_.size(); ++env) {
    EnvTrack& track = envs_[env];
    track.rewards.push_back(simulator.rewards()[env]);
    track.endings.push_back(simulator.endings()[env]);
    const SimulationStatistics now = simulator.statistics(env);
    track.events.push_back(eventsOf(statistics_[env], now));
    statistics_[env] = now;
    const auto taken = actions.subspan(env * actions_, actions_);
    track.actions.insert(track.actions.end(), taken.begin(), taken.end());
    addDistances(simulator, env);
    addFrame(simulator, env);
  }
}

void RunTrack::append(const RunTrack& other) {
  envs_.insert(envs_.end(), other.envs_.begin(), other.envs_.end());
  objects_.insert(objects_.end(), other.objects_.begin(), other.objects_.end());
  statistics_.insert(statistics_.end(), other.statistics_.begin(), other.statistics_.end());
}

std::size_t RunTrack::steps() const {
  std::size_t most = 0;
  for (const EnvTrack& env : envs_) most = std::max(most, env.rewards.size());
  return most;
}

void RunTrack::addFrame(const BatchSimulator& simulator, std::size_t env) {
  EnvTrack& track = envs_[env];
  const EnvState state = simulator.envState(env);
  addMoves(simulator, env);
  track.episodes.push_back(state.episode);
  track.world_from_root.push_back(state.world_from_root);
  track.held.push_back(heldPlacement(simulator.envObjects(env)));
  track.idle.push_back(simulator.idle()[env]);
  track.joints.insert(track.joints.end(), state.joint_positions.begin(),
                      state.joint_positions.end());
}

void RunTrack::addMoves(const BatchSimulator& simulator, std::size_t env) {
  EnvTrack& track = envs_[env];
  const EnvObjects now = simulator.envObjects(env);
  std::vector<Pose>& objects = objects_[env];
  const auto ended = !track.endings.empty() && track.endings.back() != EpisodeEnd::kNone;
  if (track.episodes.empty() || ended || track.episodes.back() != now.episode) {
    objects.clear();
    for (const Placement& placement : now.present.placements) objects.push_back(placement.pose);
  }
  const auto frame = static_cast<std::uint32_t>(track.episodes.size());
  for (std::size_t n = 0; n < now.objects.size(); ++n) {
    const bool is_held = now.held == static_cast<std::int32_t>(n);
    const Pose& pose = is_held ? now.world_from_held : now.objects[n];
    if (pose == objects[n]) continue;
    objects[n] = pose;
    track.moves.push_back({frame, now.present.first + static_cast<std::uint32_t>(n), pose});
  }
}

void RunTrack::addDistances(const BatchSimulator& simulator, std::size_t env) {
  // Where the step ended an episode, the observation may be of the next one.
  const bool is_next = simulator.dones()[env] != 0 && simulator.options().auto_reset;
  const auto all = is_next ? simulator.finalObservations() : simulator.observations();
  const auto row = all.subspan(env * simulator.observationSize(), simulator.observationSize());
  for (const std::size_t at : distance_at_) {
    envs_[env].distances.push_back(std::hypot(row[at], row[at + 1], row[at + 2]));
  }
}

}  // namespace galactic
