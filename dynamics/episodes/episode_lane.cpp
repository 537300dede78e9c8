#include "dynamics/episodes/episode_lane.h"

#include <array>
#include <utility>

#include "command_line/options.h"
#include "run/planned_policy.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

/// Options for one env that stays at the end of its episode.
SimulationOptions laneOptions(SimulationOptions options) {
  options.envs = 1;
  options.threads = 1;
  options.rank = 0;
  options.ranks = 1;
  options.auto_reset = false;
  options.body_transforms = true;
  options.order = EpisodeOrder::kLinear;
  return options;
}

/// SplitMix64 (Steele, Lea and Flood 2014): each episode has noise of its own.
std::uint64_t mixed(std::uint64_t seed, std::uint32_t episode) {
  std::uint64_t z = seed + (std::uint64_t{episode} + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

}  // namespace

EpisodeLane::EpisodeLane(BatchSimulator simulator)
    : simulator_(std::move(simulator)),
      seed_(simulator_.options().seed),
      actions_(simulator_.actionCount()) {}

Result<std::unique_ptr<EpisodeLane>> EpisodeLane::create(const World& world,
                                                         const SimulationOptions& options,
                                                         const std::optional<ClosedLoop>& loop) {
  const SimulationOptions own = laneOptions(options);
  ASSIGN_OR_RETURN(auto simulator, BatchSimulator::create(world, own));
  // Policies keep references into the lane, so it must not move.
  std::unique_ptr<EpisodeLane> lane(new EpisodeLane(std::move(simulator)));
  if (loop && loop->learned != nullptr) {
    RunOptions run;
    run.simulation = own;
    run.policy = loop->learned->pack.where();
    run.is_deterministic = loop->is_deterministic;
    ASSIGN_OR_RETURN(lane->policy_,
                     makeLearnedPolicy(*loop->learned, world, lane->simulator_, run));
  } else if (loop) {
    ASSIGN_OR_RETURN(lane->policy_, makePlannedPolicy(world, lane->simulator_));
  }
  return lane;
}

void EpisodeLane::begin(std::uint32_t episode, ArmDrive arm) {
  simulator_.restart(mixed(seed_, episode));
  simulator_.reset(std::array{static_cast<std::int32_t>(episode)});
  if (policy_) {
    policy_->restart(episode);
    policy_->expectLag(arm == ArmDrive::kMotors);
  }
  steps_ = 0;
}

Result<std::span<const float>> EpisodeLane::act() {
  RETURN_IF_ERROR(policy_->act(steps_++, actions_));
  return std::span<const float>(actions_);
}

void EpisodeLane::step(std::span<const float> actions) { simulator_.step(actions); }

void EpisodeLane::follow(std::span<const float> actions, const FollowedState& state) {
  simulator_.follow(actions, std::span(&state, 1));
}

FollowedState WorldReading::read(const DynamicsWorld& world, const DrivenStep& driven,
                                 std::size_t objects) {
  positions_ = world.positions();
  objects_.clear();
  for (std::size_t n = 0; n < objects; ++n) objects_.push_back(world.objectPose(n));
  const std::optional<std::size_t> held = world.held();
  return {.world_from_root = world.worldFromRoot(),
          .joint_positions = positions_,
          .objects = objects_,
          .held = held ? static_cast<std::int32_t>(*held) : -1,
          .was_hindered = driven.base_refused};
}

}  // namespace galactic::dynamics
