#include "run/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "command_line/option_lines.h"
#include "drawing/drawn_steps.h"
#include "galactic/batch_simulator.h"
#include "galactic/world.h"
#include "run/live_line.h"
#include "run/planned_policy.h"
#include "run/policy.h"
#include "run/run_files.h"
#include "run/tracked_run.h"
#include "support/console/stop_request.h"
#include "support/option_rules.h"
#include "support/text/counted.h"
#include "support/try.h"

namespace galactic {
namespace {

using Clock = std::chrono::steady_clock;

double secondsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// Replays the actions of a recording.
class ReplayPolicy final : public Policy {
 public:
  explicit ReplayPolicy(RecordingReader& recording) : recording_(recording) {}

  Result<void> act(std::uint64_t, std::span<float> actions) override {
    ASSIGN_OR_RETURN(const std::uint64_t digest, recording_.next(actions));
    digest_ = digest;
    return {};
  }

  /// Digest of what the step returned when it was recorded.
  [[nodiscard]] std::uint64_t digest() const { return digest_; }

 private:
  RecordingReader& recording_;
  std::uint64_t digest_ = 0;
};

/// Adds up the rewards of each env's episode until it ends.
class ReturnTally {
 public:
  explicit ReturnTally(std::size_t envs) : returns_(envs), steps_(envs) {}

  void add(const BatchSimulator& simulator, EpisodeSums& sums) {
    const std::span<const float> rewards = simulator.rewards();
    const std::span<const std::uint8_t> dones = simulator.dones();
    for (std::size_t env = 0; env < returns_.size(); ++env) {
      returns_[env] += static_cast<double>(rewards[env]);
      ++steps_[env];
      if (dones[env] == 0) continue;
      ++sums.ended;
      sums.returns += std::exchange(returns_[env], 0.0);
      sums.steps += std::exchange(steps_[env], 0U);
    }
  }

 private:
  std::vector<double> returns_;
  std::vector<std::uint32_t> steps_;
};

/// One run: the source of its actions, and its outputs.
class Run {
 public:
  Run(const RunOptions& options, BatchSimulator& simulator, RunReport& report)
      : options_(options),
        simulator_(simulator),
        report_(report),
        tally_(simulator.envCount()),
        actions_(simulator.envCount() * simulator.actionCount()) {}

  /// Call it before go().
  void replay(RecordingReader& recording) {
    auto policy = std::make_unique<ReplayPolicy>(recording);
    replay_ = policy.get();
    policy_ = std::move(policy);
  }

  /// Call it before go().
  Result<void> plan(const World& world) {
    ASSIGN_OR_RETURN(std::unique_ptr<Policy> policy, makePlannedPolicy(world, simulator_));
    policy_ = std::move(policy);
    return {};
  }

  /// Call it before go().
  Result<void> play(const OpenedPolicy& policy, const World& world) {
    ASSIGN_OR_RETURN(std::unique_ptr<Policy> made,
                     makeLearnedPolicy(policy, world, simulator_, options_));
    policy_ = std::move(made);
    report_.learned.emplace(
        LearnedReport{.name = policy.needs.name, .samples = !options_.is_deterministic});
    return {};
  }

  /// Call it before go().
  Result<void> draw(const World& world) {
    ASSIGN_OR_RETURN(DrawnSteps drawn, DrawnSteps::create(world, simulator_, options_));
    drawn_.emplace(std::move(drawn));
    const BatchRenderer& renderer = drawn_->renderer();
    report_.rendering.emplace();
    report_.rendering->description = renderer.description();
    report_.rendering->backend = backendName(renderer.backend());
    if (options_.drawing.hasSemantics())
      report_.rendering->semantic_names = drawn_->semanticNames();
    return {};
  }

  /// Call it before go().
  void track(const World& world) { tracked_.emplace(world, simulator_, options_); }

  /// Call it before go().
  Result<void> record(const World& world) {
    const RecordingSubject subject{
        options_.simulation, static_cast<std::uint32_t>(simulator_.actionCount()), stampsOf(world)};
    ASSIGN_OR_RETURN(RecordingWriter writer, RecordingWriter::create(options_.record, subject));
    writer_.emplace(std::move(writer));
    return {};
  }

  /// Steps until all steps are done, or until an output cannot be written (RunReport::fault). Fails
  /// only if no action is available, because a recording is damaged.
  Result<void> go(const StopRequest& stop) {
    if (!policy_) {
      const SimulationOptions& simulation = options_.simulation;
      policy_ = makeGeneratedPolicy(options_.policy, {.actions = simulator_.actionLayout(),
                                                      .seed = simulation.seed,
                                                      .first_env = firstEnvOf(simulation)});
    }
    LiveLine line(options_.steps, simulator_.envCount());
    const bool shows_progress = line.isEnabled() && !options_.is_quiet;
    constexpr auto kLookEvery = std::chrono::milliseconds(250);
    const Clock::time_point start = Clock::now();
    Clock::time_point next_look = start + kLookEvery;
    while (report_.steps < options_.steps && !report_.first_difference && !report_.fault &&
           !hasPlayedAll()) {
      report_.is_interrupted = stop.came();
      if (report_.is_interrupted) break;
      if (Result<void> acted = act(); !acted) return acted;
      step();
      if (!shows_progress || Clock::now() < next_look) continue;
      next_look = Clock::now() + kLookEvery;
      line.show(report_.steps, simulator_.statistics());
    }
    report_.is_interrupted |= report_.fault && report_.steps < options_.steps;
    report_.loop_seconds = secondsBetween(start, Clock::now());
    finish();
    return {};
  }

 private:
  /// Completes the outputs. One that cannot be written does not keep the others from being written;
  /// the recording comes first, because everything else can be made from it.
  void finish() {
    if (writer_) note(writer_->finish());
    writer_.reset();
    if (drawn_) note(drawn_->finish(simulator_, report_));
    if (tracked_) note(tracked_->finish());
  }

  /// Keeps only the first of several faults.
  void note(Result<void> written) {
    if (!written && !report_.fault) report_.fault = std::move(written.error());
  }

  /// Whether every env has had its share of the episodes.
  [[nodiscard]] bool hasPlayedAll() const {
    return std::ranges::all_of(simulator_.idle(), [](std::uint8_t idle) { return idle != 0; });
  }

  Result<void> act() {
    const Clock::time_point before = Clock::now();
    Result<void> acted = policy_->act(report_.steps, actions_);
    if (report_.learned) report_.learned->seconds += secondsBetween(before, Clock::now());
    return acted;
  }

  void step() {
    if (drawn_) {
      note(drawn_->step(simulator_, actions_, report_));
    } else {
      const Clock::time_point before = Clock::now();
      simulator_.step(actions_);
      report_.step_seconds += secondsBetween(before, Clock::now());
    }
    tally_.add(simulator_, report_.episodes);
    if (tracked_) tracked_->add(simulator_, actions_);
    if (writer_ || replay_ != nullptr) keepDigest();
    ++report_.steps;
  }

  void keepDigest() {
    const std::uint64_t digest = digestOf(simulator_);
    if (writer_) {
      Result<void> written = writer_->append(actions_, digest);
      // Part of a recording is useless; discarding it makes room for the other files on a full
      // disk.
      if (!written) writer_.reset();
      note(std::move(written));
    }
    if (replay_ != nullptr && replay_->digest() != digest) {
      report_.first_difference = report_.steps;
    }
  }

  const RunOptions& options_;
  BatchSimulator& simulator_;
  RunReport& report_;
  ReturnTally tally_;
  std::vector<float> actions_;
  std::unique_ptr<Policy> policy_;
  /// The policy, if it replays a recording.
  const ReplayPolicy* replay_ = nullptr;
  std::optional<RecordingWriter> writer_;
  std::optional<DrawnSteps> drawn_;
  std::optional<TrackedRun> tracked_;
};

/// Whether the recording is of this world and robot.
Result<void> checkSubject(const RecordingReader* replay, const World& world,
                          const BatchSimulator& simulator) {
  if (replay == nullptr) return {};
  if (Result<void> same = checkWorld(*replay, world); !same) return same;
  if (replay->subject().actions == simulator.actionCount()) return {};
  return fail(ErrorCode::kInvalidInput, replay->where(),
              fmt::format("has {} actions per env, expected the robot's {}; record it again",
                          replay->subject().actions, simulator.actionCount()));
}

}  // namespace

Result<OpenedWorld> openWorld(const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  const std::vector<std::filesystem::path> paths(options.packs.begin(), options.packs.end());
  ASSIGN_OR_RETURN(World world,
                   World::open(paths, options.trusted ? Trust::kTrusted : Trust::kVerify));
  return OpenedWorld{std::move(world), secondsBetween(start, Clock::now())};
}

Result<RunReport> simulate(const RunOptions& options, const OpenedWorld& opened,
                           const RunSource& source) {
  const StopRequest stop("galactic-run");
  const World& world = opened.world;
  RETURN_IF_ERROR(tryOutputs(world, options));
  RunReport report;
  report.options = options;
  report.world_task = world.taskOptions();
  report.open_seconds = opened.seconds;
  const Clock::time_point start = Clock::now();
  ASSIGN_OR_RETURN(BatchSimulator simulator, BatchSimulator::create(world, options.simulation));
  report.create_seconds = secondsBetween(start, Clock::now());
  RETURN_IF_ERROR(checkSubject(source.replay, world, simulator));
  constexpr std::uint32_t kSampleEvery = 16;
  simulator.samplePhases(kSampleEvery);
  Run run(options, simulator, report);
  if (source.replay != nullptr) run.replay(*source.replay);
  if (source.policy != nullptr) {
    RETURN_IF_ERROR(run.play(*source.policy, world));
  }
  if (source.replay == nullptr && options.policy == kScriptedPolicy) {
    RETURN_IF_ERROR(run.plan(world));
  }
  if (options.drawing.draws()) {
    RETURN_IF_ERROR(run.draw(world));
  }
  if (!options.view.empty() || !options.animation.empty()) run.track(world);
  if (!options.record.empty()) {
    RETURN_IF_ERROR(run.record(world));
  }
  RETURN_IF_ERROR(run.go(stop));
  report.threads = simulator.threadCount();
  report.phases = simulator.phaseTimes();
  report.sampled_steps = (report.steps + kSampleEvery - 1) / kSampleEvery;
  report.sum = simulator.statistics();
  report.world_episodes = world.episodes().episodes().size();
  report.skipped.assign(simulator.skippedEpisodes().begin(), simulator.skippedEpisodes().end());
  report.memory_bytes = simulator.memoryBytes();
  report.shared_bytes = simulator.sharedBytes();
  return report;
}

Result<void> checkReplay(const RecordingReader& recording, const RunOptions& options) {
  if (recording.steps() == 0) {
    return fail(ErrorCode::kInvalidInput, recording.where(),
                "holds no steps, so there is nothing to replay; record it again");
  }
  if (options.steps > recording.steps()) {
    return fail(ErrorCode::kInvalidInput, recording.where(),
                fmt::format("holds {}, and --steps asks for {}; ask for fewer",
                            counted(recording.steps(), "step"), options.steps));
  }
  const auto other = firstDifference(recording.subject().options, options.simulation);
  if (!other) return {};
  return fail(ErrorCode::kInvalidInput, recording.where(),
              fmt::format("was recorded with {} {}, and the command line asks for another; leave "
                          "the option out",
                          other->name, other->value));
}

}  // namespace galactic
