#include "galactic/batch_simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "galactic/option_text.h"
#include "simulation/phases/action_delay.h"
#include "simulation/phases/chunk.h"
#include "simulation/phases/episode_start.h"
#include "simulation/phases/step.h"
#include "simulation/simulator/chosen_state.h"
#include "simulation/simulator/follow.h"
#include "simulation/simulator/model_making.h"
#include "simulation/simulator/saved_state.h"
#include "simulation/state/batch_state.h"
#include "simulation/state/env_moment.h"
#include "simulation/state/env_state.h"
#include "simulation/state/episode_draws.h"
#include "simulation/state/grip_frame.h"
#include "simulation/state/model.h"
#include "support/call_check.h"
#include "support/out_of_memory.h"
#include "support/threads/workers.h"
#include "support/try.h"

namespace galactic {

using simulation::BatchState;
using simulation::Chunk;
using simulation::kChunk;
using simulation::Model;
using simulation::SavedEnv;
using simulation::SavedState;

namespace {

std::vector<std::uint32_t> allEnvs(std::size_t count) {
  std::vector<std::uint32_t> envs(count);
  std::iota(envs.begin(), envs.end(), 0U);
  return envs;
}

/// Fails if an env is named twice: each can go on from one state only.
Result<void> requireDistinct(std::span<const std::uint32_t> envs) {
  std::vector<std::uint32_t> named(envs.begin(), envs.end());
  std::erase(named, BatchSimulator::kNoEnv);
  std::ranges::sort(named);
  const auto twice = std::ranges::adjacent_find(named);
  if (twice == named.end()) return {};
  return fail(ErrorCode::kInvalidInput, "envs",
              fmt::format("has env {} twice, expected each once", *twice));
}

}  // namespace

ActionLayout ActionLayout::of(const Robot& robot) {
  const std::optional<RobotBase>& base = robot.base();
  return {robot.controlledJoints().size(), base && base->sideways_step > 0};
}

/// The batch, and the threads that step it.
class BatchSimulator::Impl {
 public:
  Impl(Model model, std::size_t threads)
      : model_(std::move(model)), state_(model_, model_.options.envs) {
    const std::size_t chunks = state_.paddedCount() / kChunk;
    threads_ = std::min(threads, chunks);
    desks_.reserve(detail::Workers::countFor(threads_));
    for (std::size_t n = 0; n < detail::Workers::countFor(threads_); ++n) {
      desks_.push_back({Chunk(model_), {}, {}});
      if (model_.options.continuous_collision) desks_.back().between.emplace(model_);
    }
    beginFirstEpisodes();
    workers_ = std::make_unique<detail::Workers>(
        threads_, chunks, [this](std::size_t thread, std::size_t n) { run(thread, n); });
    threads_ = std::min(threads_, workers_->count());
  }

  void begin(std::span<const float> actions, std::span<const std::int32_t> resets) {
    prepare("BatchSimulator::beginStep", actions, resets);
    is_stepping_ = true;
    workers_->begin();
  }

  void end() {
    if (!is_stepping_) {
      detail::refuseCall("BatchSimulator::endStep", "found no step that has begun");
    }
    workers_->end();
    is_stepping_ = false;
    ++steps_;
  }

  void step(std::span<const float> actions, std::span<const std::int32_t> resets) {
    prepare("BatchSimulator::step", actions, resets);
    run();
  }

  void run() {
    if (threads_ > 1) {
      workers_->run();
    } else {
      for (std::size_t n = 0; n < state_.paddedCount() / kChunk; ++n) run(0, n);
    }
    ++steps_;
  }

  void follow(std::span<const float> actions, std::span<const FollowedState> states) {
    constexpr const char* kCall = "BatchSimulator::follow";
    requireIdle(kCall);
    detail::checkLength(kCall, "states", states.size(), envCount());
    for (std::size_t env = 0; env < states.size(); ++env) checkFollowed(kCall, env, states[env]);
    prepare(kCall, actions, {});
    states_ = states;
    run();
    states_ = {};
  }

  void reset(std::span<const std::int32_t> episodes, EpisodeChoice choice) {
    constexpr const char* kCall = "BatchSimulator::reset";
    requireIdle(kCall);
    detail::checkLength(kCall, "episodes", episodes.size(), envCount());
    for (std::size_t env = 0; env < episodes.size(); ++env) {
      const bool is_next = episodes[env] == kNextEpisode;
      const OptionalIndex start = model_.startOf(episodes[env]);
      if (!is_next && !start) continue;
      if (is_next) {
        simulation::beginNextEpisode(model_, state_, env);
      } else {
        simulation::beginEpisode(model_, state_, env, *start, choice);
      }
    }
  }

  void restart(std::uint64_t seed) {
    requireIdle("BatchSimulator::restart");
    model_.options.seed = seed;
    for (std::size_t env = 0; env < state_.paddedCount(); ++env) {
      state_.env(env) = {};
      state_.counters(env) = {};
      state_.moves(env) = {};
      state_.clearOutcome(env);
    }
    beginFirstEpisodes();
    steps_ = 0;
  }

  std::vector<std::byte> save(std::span<const std::uint32_t> envs) const {
    constexpr const char* kCall = "BatchSimulator::saveState";
    requireIdle(kCall);
    for (const std::uint32_t env : envs) detail::checkIndex(kCall, "env", env, envCount());
    return simulation::saveEnvs(model_, state_, envs, steps_);
  }

  Result<void> restore(std::span<const std::byte> bytes) {
    requireIdle("BatchSimulator::restoreState");
    ASSIGN_OR_RETURN(SavedState saved, simulation::readState(model_, bytes));
    const std::vector<std::uint32_t> all = allEnvs(envCount());
    if (Result<void> fits = checkCount(saved, all); !fits) return fits;
    addBodies(saved);
    model_.options.seed = saved.seed;
    steps_ = saved.steps;
    put(saved, all);
    return {};
  }

  Result<void> restore(std::span<const std::byte> bytes, std::span<const std::uint32_t> envs) {
    constexpr const char* kCall = "BatchSimulator::restoreState";
    requireIdle(kCall);
    for (const std::uint32_t env : envs) {
      if (env != kNoEnv) detail::checkIndex(kCall, "env", env, envCount());
    }
    RETURN_IF_ERROR(requireDistinct(envs));
    ASSIGN_OR_RETURN(SavedState saved, simulation::readState(model_, bytes));
    if (Result<void> fits = checkCount(saved, envs); !fits) return fits;
    if (saved.seed != model_.options.seed) {
      return fail(ErrorCode::kInvalidInput, "saved state",
                  fmt::format("was saved with seed {}, and the simulator has {}; restart it with "
                              "that seed",
                              saved.seed, model_.options.seed));
    }
    addBodies(saved);
    put(saved, envs);
    return {};
  }

  Result<void> checkStates(std::span<const EnvState> states) const {
    for (std::size_t n = 0; n < states.size(); ++n) {
      const std::string fault = simulation::faultOf(model_, states[n]);
      if (fault.empty()) continue;
      return fail(ErrorCode::kInvalidInput, "states", fmt::format("state {} {}", n, fault));
    }
    return {};
  }

  /// A copy of the state of one env.
  EnvState envState(std::size_t env) const {
    constexpr const char* kCall = "BatchSimulator::envState";
    requireIdle(kCall);
    detail::checkIndex(kCall, "env", env, envCount());
    return simulation::envStateOf(model_, state_, env);
  }

  Result<std::vector<std::uint8_t>> setStates(std::span<const std::uint32_t> envs,
                                              std::span<const EnvState> states,
                                              EpisodeChoice choice) {
    constexpr const char* kCall = "BatchSimulator::setStates";
    requireIdle(kCall);
    detail::checkLength(kCall, "states", states.size(), envs.size());
    for (const std::uint32_t env : envs) detail::checkIndex(kCall, "env", env, envCount());
    RETURN_IF_ERROR(requireDistinct(envs));
    RETURN_IF_ERROR(checkStates(states));
    simulation::StateChooser& chooser = this->chooser();
    std::vector<std::uint8_t> were_set(envs.size());
    // Everything that allocates comes before the first env changes.
    std::vector<std::optional<SavedEnv>> chosen(envs.size());
    for (std::size_t n = 0; n < envs.size(); ++n) {
      chosen[n] = chooser.choose(states[n]);
      if (chosen[n]) keepRecord(envs[n], choice, *chosen[n]);
    }
    for (std::size_t n = 0; n < envs.size(); ++n) {
      if (!chosen[n]) continue;
      simulation::restoreEnv(model_, state_, envs[n], *chosen[n]);
      were_set[n] = 1;
    }
    return were_set;
  }

  const Model& model() const { return model_; }
  BatchState& state() { return state_; }
  const BatchState& state() const { return state_; }
  bool isStepping() const { return is_stepping_; }
  void requireIdle(const char* call) const {
    if (!is_stepping_) return;
    detail::refuseCall(call, "found a step that has begun; end it first, with endStep()");
  }
  std::size_t threads() const { return threads_; }
  std::uint64_t steps() const { return steps_; }
  void sample(std::uint32_t every) {
    requireIdle("BatchSimulator::samplePhases");
    sample_every_ = every;
  }

  std::vector<PhaseTime> phaseTimes() const {
    requireIdle("BatchSimulator::phaseTimes");
    std::vector<PhaseTime> times;
    times.reserve(simulation::kPhaseNames.size());
    for (std::size_t n = 0; n < simulation::kPhaseNames.size(); ++n) {
      double seconds = 0;
      for (const Desk& desk : desks_) seconds += desk.seconds[n];
      times.push_back({simulation::kPhaseNames[n], seconds});
    }
    return times;
  }

 private:
  /// The scratch space of a thread.
  struct Desk {
    Chunk chunk;
    /// Only with options.continuous_collision.
    std::optional<Chunk> between;
    simulation::PhaseSeconds seconds{};
  };

  std::size_t envCount() const { return model_.options.envs; }

  void prepare(const char* call, std::span<const float> actions,
               std::span<const std::int32_t> resets) {
    requireIdle(call);
    detail::checkLength(call, "actions", actions.size(), envCount() * model_.actionCount());
    if (!resets.empty()) detail::checkLength(call, "resets", resets.size(), envCount());
    input_ = {actions, resets};
    measures_ = sample_every_ != 0 && steps_ % sample_every_ == 0;
  }

  void checkFollowed(const char* call, std::size_t env, const FollowedState& state) const {
    const std::size_t objects = state_.env(env).objects;
    detail::checkLength(call, "states[].joint_positions", state.joint_positions.size(),
                        model_.world->robot().positionCount());
    detail::checkLength(call, "states[].objects", state.objects.size(), objects);
    if (state.held < -1 || state.held >= static_cast<std::int64_t>(objects)) {
      detail::refuseCall(call, fmt::format("found states[{}].held {}, expected -1 or an index "
                                           "below {}",
                                           env, state.held, objects));
    }
    if (const std::string fault = simulation::faultOfNumbers(state); !fault.empty()) {
      detail::refuseCall(call, fmt::format("found states[{}], which {}", env, fault));
    }
  }

  static Result<void> checkCount(const SavedState& saved, std::span<const std::uint32_t> envs) {
    if (saved.envs.size() == envs.size() || saved.envs.size() == 1) return {};
    return fail(ErrorCode::kInvalidInput, "saved state",
                fmt::format("has {} envs, expected {}, or one that becomes all of them",
                            saved.envs.size(), envs.size()));
  }

  simulation::StateChooser& chooser() {
    if (!chooser_) chooser_ = std::make_unique<simulation::StateChooser>(model_);
    return *chooser_;
  }

  /// Adds bodies to envs that were saved without them, if this run wants bodies.
  void addBodies(SavedState& saved) {
    if (model_.bodyCount() == 0) return;
    for (SavedEnv& env : saved.envs) {
      if (env.bodies.empty()) chooser().addBodies(env);
    }
  }

  /// Copies the env's counters, and what its last step returned, into a chosen state.
  void keepRecord(std::size_t env, EpisodeChoice choice, SavedEnv& chosen) const {
    chosen.counters = state_.counters(env);
    ++chosen.counters.begun;
    chosen.counters.is_named = choice == EpisodeChoice::kNamed;
    chosen.moves = state_.moves(env);
    chosen.env.reward_sum = state_.env(env).reward_sum;
    chosen.reward = state_.rewards()[env];
    chosen.ending = state_.endings()[env];
    chosen.had_picked = state_.picks()[env] != 0;
    if (chosen.ending == EpisodeEnd::kNone) return;
    const std::span<const float> last = state_.finalObservation(env);
    chosen.final_observation.assign(last.begin(), last.end());
  }

  /// Restores the saved envs into `envs`, in that order; a single one into each of them.
  void put(const SavedState& saved, std::span<const std::uint32_t> envs) {
    const bool is_single = saved.envs.size() == 1;
    for (std::size_t n = 0; n < envs.size(); ++n) {
      if (envs[n] == kNoEnv) continue;
      simulation::restoreEnv(model_, state_, envs[n], saved.envs[is_single ? 0 : n]);
    }
  }

  void beginFirstEpisodes() {
    for (std::size_t env = 0; env < state_.paddedCount(); ++env) {
      simulation::beginNextEpisode(model_, state_, env);
    }
  }

  /// Runs a step of the n-th chunk.
  void run(std::size_t thread, std::size_t n) noexcept {
    Desk& desk = desks_[thread];
    const simulation::ChunkStep step{model_, state_, desk.chunk, n * kChunk,
                                     desk.between ? &*desk.between : nullptr};
    if (!states_.empty()) {
      simulation::followChunk(step, input_.actions, states_);
    } else if (measures_) {
      simulation::stepChunkMeasured(step, input_, desk.seconds);
    } else {
      simulation::stepChunk(step, input_);
    }
  }

  Model model_;
  BatchState state_;
  std::size_t threads_ = 1;
  std::vector<Desk> desks_;
  simulation::StepInput input_;
  /// The states of a step that was made elsewhere.
  std::span<const FollowedState> states_;
  std::uint64_t steps_ = 0;
  std::uint32_t sample_every_ = 0;
  bool measures_ = false;
  bool is_stepping_ = false;
  /// Made when a caller first sets a state, or restores one without bodies.
  std::unique_ptr<simulation::StateChooser> chooser_;
  std::unique_ptr<detail::Workers> workers_;
};

Result<BatchSimulator> BatchSimulator::create(const World& world,
                                              const SimulationOptions& options) {
  RETURN_IF_ERROR(checkOptions(options));
  ASSIGN_OR_RETURN(Model model, simulation::makeModel(world, options));
  const auto bytes = static_cast<double>(simulation::stateBytes(model, options.envs));
  RETURN_IF_ERROR(
      checkMemory(bytes, fmt::format("{} envs", options.envs), "simulate fewer at once (--envs)"));
  return BatchSimulator(
      std::make_unique<Impl>(std::move(model), detail::threadCount(options.threads)));
}

BatchSimulator::BatchSimulator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BatchSimulator::~BatchSimulator() = default;
BatchSimulator::BatchSimulator(BatchSimulator&&) noexcept = default;
BatchSimulator& BatchSimulator::operator=(BatchSimulator&&) noexcept = default;

const World& BatchSimulator::world() const { return *impl_->model().world; }
const SimulationOptions& BatchSimulator::options() const { return impl_->model().options; }
std::size_t BatchSimulator::envCount() const { return impl_->model().options.envs; }
std::size_t BatchSimulator::actionCount() const { return impl_->model().actionCount(); }
ActionLayout BatchSimulator::actionLayout() const { return impl_->model().actionLayout(); }
std::size_t BatchSimulator::observationSize() const { return impl_->model().observation_size; }
std::size_t BatchSimulator::threadCount() const { return impl_->threads(); }
const std::vector<ObservationPart>& BatchSimulator::observationParts() const {
  return impl_->model().observation;
}

void BatchSimulator::step(std::span<const float> actions, std::span<const std::int32_t> resets) {
  impl_->step(actions, resets);
}
void BatchSimulator::beginStep(std::span<const float> actions,
                               std::span<const std::int32_t> resets) {
  impl_->begin(actions, resets);
}
void BatchSimulator::endStep() { impl_->end(); }
bool BatchSimulator::isStepping() const { return impl_->isStepping(); }
void BatchSimulator::follow(std::span<const float> actions, std::span<const FollowedState> states) {
  impl_->follow(actions, states);
}
void BatchSimulator::reset(std::span<const std::int32_t> episodes, EpisodeChoice choice) {
  impl_->reset(episodes, choice);
}
void BatchSimulator::restart(std::uint64_t seed) { impl_->restart(seed); }

Result<std::vector<std::uint8_t>> BatchSimulator::setStates(std::span<const std::uint32_t> envs,
                                                            std::span<const EnvState> states,
                                                            EpisodeChoice choice) {
  return impl_->setStates(envs, states, choice);
}

Result<void> BatchSimulator::checkStates(std::span<const EnvState> states) const {
  return impl_->checkStates(states);
}

std::vector<std::byte> BatchSimulator::saveState() const { return saveState(allEnvs(envCount())); }
std::vector<std::byte> BatchSimulator::saveState(std::span<const std::uint32_t> envs) const {
  return impl_->save(envs);
}
Result<void> BatchSimulator::restoreState(std::span<const std::byte> state) {
  return impl_->restore(state);
}
Result<void> BatchSimulator::restoreState(std::span<const std::byte> state,
                                          std::span<const std::uint32_t> envs) {
  return impl_->restore(state, envs);
}

std::span<const float> BatchSimulator::observations() const {
  return impl_->state().observations();
}
std::span<const float> BatchSimulator::finalObservations() const {
  return impl_->state().finalObservations();
}
std::span<const float> BatchSimulator::rewards() const {
  return impl_->state().rewards().first(envCount());
}
std::span<const std::uint8_t> BatchSimulator::dones() const {
  return impl_->state().dones().first(envCount());
}
std::span<const std::uint8_t> BatchSimulator::successes() const {
  return impl_->state().successes().first(envCount());
}
std::span<const EpisodeEnd> BatchSimulator::endings() const {
  return impl_->state().endings().first(envCount());
}
std::span<const std::uint8_t> BatchSimulator::picks() const {
  return impl_->state().picks().first(envCount());
}

std::span<const std::uint8_t> BatchSimulator::idle() const {
  return impl_->state().idle().first(envCount());
}

SimulationStatistics BatchSimulator::statistics() const {
  SimulationStatistics sum;
  for (std::size_t n = 0; n < envCount(); ++n) {
    const SimulationStatistics env = statistics(n);
    visitStatistics([&](const char*, auto member) { sum.*member += env.*member; });
  }
  return sum;
}
SimulationStatistics BatchSimulator::statistics(std::size_t env) const {
  constexpr const char* kCall = "BatchSimulator::statistics";
  impl_->requireIdle(kCall);
  detail::checkIndex(kCall, "env", env, envCount());
  const simulation::EnvCounters& counters = impl_->state().counters(env);
  const simulation::MoveCounters& moves = impl_->state().moves(env);
  // An env from a longer run may have been idle for more steps than this run has had.
  return {.steps = impl_->steps() - std::min(impl_->steps(), counters.idle_steps),
          .refused = moves.refused,
          .slid = moves.slid,
          .grasps = counters.grasps,
          .drops = counters.drops,
          .restored = counters.restored,
          .episodes = counters.episodes,
          .successes = counters.successes,
          .failures = counters.failures,
          .picks = counters.picks,
          .nan_actions = counters.nan_actions,
          .reward = impl_->state().env(env).reward_sum};
}

std::span<const std::uint32_t> BatchSimulator::skippedEpisodes() const {
  return impl_->model().skipped;
}

EnvState BatchSimulator::envState(std::size_t env) const { return impl_->envState(env); }

EnvObjects BatchSimulator::envObjects(std::size_t env) const noexcept {
  return simulation::envObjectsOf(impl_->model(), impl_->state(), env);
}

EnvMoment BatchSimulator::envMoment(std::size_t env) const noexcept {
  return simulation::momentOf(impl_->model(), impl_->state(), env);
}

EpisodeNoise BatchSimulator::episodeNoise(std::size_t env) const {
  constexpr const char* kCall = "BatchSimulator::episodeNoise";
  impl_->requireIdle(kCall);
  detail::checkIndex(kCall, "env", env, envCount());
  return simulation::episodeNoiseIn(impl_->model(), envMoment(env));
}

std::vector<float> BatchSimulator::actionsUnderWay(std::size_t env) const {
  constexpr const char* kCall = "BatchSimulator::actionsUnderWay";
  impl_->requireIdle(kCall);
  detail::checkIndex(kCall, "env", env, envCount());
  return simulation::actionsUnderWay(impl_->model(), impl_->state(), env);
}

std::size_t BatchSimulator::bodyCount() const { return impl_->model().motion.nodes.size() + 1; }

LinkOnBody BatchSimulator::linkOnBody(std::size_t link) const {
  const std::vector<simulation::FixedFrame>& links = impl_->model().motion.links;
  detail::checkIndex("BatchSimulator::linkOnBody", "link", link, links.size());
  const simulation::FixedFrame& frame = links[link];
  return {static_cast<std::size_t>(frame.node + 1),
          {frame.x_axis, frame.y_axis, frame.z_axis, frame.origin}};
}

std::span<const RigidTransform> BatchSimulator::bodyTransforms() const {
  return impl_->state().bodyTransforms();
}

void BatchSimulator::samplePhases(std::uint32_t every) { impl_->sample(every); }
std::vector<PhaseTime> BatchSimulator::phaseTimes() const { return impl_->phaseTimes(); }
std::size_t BatchSimulator::memoryBytes() const { return impl_->state().bytes(); }
std::size_t BatchSimulator::sharedBytes() const { return impl_->model().bytes(); }

}  // namespace galactic
