#include "comparisons.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <span>
#include <thread>
#include <utility>

#include "dynamics/episodes/trace.h"
#include "galactic/bake/parallel_for.h"
#include "galactic/option_text.h"
#include "run/recording.h"
#include "support/range_text.h"
#include "support/standard_streams.h"
#include "support/stop_request.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

/// How far it is, on a terminal.
class Progress {
 public:
  Progress(std::size_t done, std::size_t all, bool is_quiet)
      : done_(done), all_(all), is_shown_(!is_quiet && ::isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (is_shown_) printToStderr("\r\x1b[K");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  void add() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (is_shown_) printToStderr(fmt::format("\rcompared {} of {} episodes", done_, all_));
  }

 private:
  std::size_t done_;
  std::size_t all_;
  bool is_shown_;
  std::mutex mutex_;
};

/// Lanes that threads take and give back.
class LanePool {
 public:
  static Result<std::unique_ptr<LanePool>> create(const EpisodePlan& plan, std::size_t count) {
    auto pool = std::make_unique<LanePool>();
    for (std::size_t n = 0; n < count; ++n) {
      ASSIGN_OR_RETURN(auto lane, plan.makeLane());
      pool->lanes_.push_back(std::move(lane));
    }
    return pool;
  }

  std::unique_ptr<EpisodeLane> take() {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<EpisodeLane> lane = std::move(lanes_.back());
    lanes_.pop_back();
    return lane;
  }
  void giveBack(std::unique_ptr<EpisodeLane> lane) {
    const std::lock_guard lock(mutex_);
    lanes_.push_back(std::move(lane));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<EpisodeLane>> lanes_;
};

/// What moves things here is off by itself; noise of motion would be lost, and delay.
Result<void> requireExactMotions(const SimulationOptions& options, const std::string& where,
                                 const std::string& remedy) {
  const RobotNoise& noise = options.noise;
  if (!noise.changesMotion() && !noise.delaysActions()) return {};
  return fail(
      ErrorCode::kUnsupported, where,
      fmt::format("has motion-noise {}, motion-bias {} and action-delay {}, which things with mass "
                  "do not have; {}",
                  drawnText(noise.motion), drawnText(noise.motion_bias),
                  drawnText(noise.action_delay), remedy));
}

}  // namespace

Result<std::unique_ptr<EpisodePlan>> EpisodePlan::create(const Command& command,
                                                         const World& world) {
  std::unique_ptr<EpisodePlan> plan(new EpisodePlan(world));
  plan->is_closed_ = command.isClosedLoop();
  if (plan->is_closed_) {
    RETURN_IF_ERROR(plan->openLoop(command));
  } else {
    RETURN_IF_ERROR(plan->openRecording(command));
  }
  return plan;
}

Result<void> EpisodePlan::openRecording(const Command& command) {
  ASSIGN_OR_RETURN(auto recording, RecordingReader::open(command.recording));
  ASSIGN_OR_RETURN(traces_, tracesOf(recording, world_, command.episodes));
  if (traces_.empty()) {
    return fail(ErrorCode::kInvalidInput, command.recording.string(),
                "finishes no episode, so there is nothing to replay; record more steps");
  }
  options_ = recording.subject().options;
  RETURN_IF_ERROR(requireExactMotions(options_, command.recording.string(),
                                      "record a run without, with --motion-noise 0, "
                                      "--motion-bias 0 and --action-delay 0"));
  return {};
}

Result<void> EpisodePlan::openLoop(const Command& command) {
  options_ = world_.withTask({});
  is_deterministic_ = command.loop.is_deterministic;
  if (const std::filesystem::path file = command.policyFile(); !file.empty()) {
    RunOptions run;
    run.policy = file.string();
    ASSIGN_OR_RETURN(policy_, openPolicy(run));
    RETURN_IF_ERROR(applyNeeds(*policy_, options_));
  }
  if (const auto fault = setOptions(command.loop.task, OptionScope::kTask, options_)) {
    const OptionText& option = command.loop.task[fault->index];
    return fail(ErrorCode::kInvalidInput, "--set",
                fmt::format("{}={} is no option of the task, or has no such value; see the options "
                            "of galactic-run",
                            option.name, option.value));
  }
  RETURN_IF_ERROR(requireExactMotions(
      options_, "the task", "add --set motion-noise=0 --set motion-bias=0 --set action-delay=0"));
  options_.seed = command.loop.seed;
  ASSIGN_OR_RETURN(const auto lane, makeLane());
  const std::span<const std::uint32_t> skipped = lane->simulator().skippedEpisodes();
  const auto all = static_cast<std::uint32_t>(world_.episodes().episodes().size());
  for (std::uint32_t episode = 0; episode < all; ++episode) {
    if (command.episodes != 0 && episodes_.size() == command.episodes) break;
    if (std::ranges::find(skipped, episode) == skipped.end()) episodes_.push_back(episode);
  }
  return {};
}

Result<std::unique_ptr<EpisodeLane>> EpisodePlan::makeLane() const {
  std::optional<ClosedLoop> loop;
  if (is_closed_) {
    loop = {.learned = policy_ ? &*policy_ : nullptr, .is_deterministic = is_deterministic_};
  }
  return EpisodeLane::create(world_, options_, loop);
}

Result<EpisodeTrace> EpisodePlan::trace(std::size_t n, EpisodeLane& lane) const {
  if (is_closed_) return traceOf(episodes_[n], lane);
  return traces_[n];
}

std::string EpisodePlan::describe() const {
  std::string text = fmt::format("{} episodes", count());
  for (const OptionText& option : listOptions(options_)) {
    text += fmt::format(" {}={}", option.name, option.value);
  }
  for (const PackStamp& stamp : stampsOf(world_)) {
    text += fmt::format(" {:016x}", stamp.payload_xxh64);
  }
  return text;
}

Result<std::vector<EpisodeComparison>> compareAll(const EpisodePlan& plan,
                                                  const ComparisonWorlds& worlds,
                                                  const Command& command,
                                                  ComparisonJournal* journal) {
  std::vector<std::optional<Result<EpisodeComparison>>> results(plan.count());
  std::vector<std::size_t> open;
  for (std::size_t n = 0; n < results.size(); ++n) {
    const bool is_done = journal != nullptr && journal->done().contains(n);
    if (is_done) results[n] = journal->done().at(n);
    if (!is_done) open.push_back(n);
  }
  const std::size_t wanted =
      command.threads != 0 ? command.threads : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t threads = std::min(wanted, open.size());
  // Before there are threads, which inherit it.
  const StopRequest stop("galactic-dynamics");
  ASSIGN_OR_RETURN(const auto lanes, LanePool::create(plan, threads));
  Progress progress(results.size() - open.size(), results.size(), command.is_quiet);
  // What cannot be kept is not worth the time.
  std::atomic<bool> is_lost = false;
  bake::parallelFor(static_cast<unsigned>(threads), open.size(), [&](std::size_t k) {
    if (stop.came() || is_lost) return;
    const std::size_t n = open[k];
    std::unique_ptr<EpisodeLane> lane = lanes->take();
    const auto compared = [&]() -> Result<EpisodeComparison> {
      ASSIGN_OR_RETURN(const auto trace, plan.trace(n, *lane));
      ASSIGN_OR_RETURN(auto one, compareEpisode(trace, *lane, worlds, plan.isClosedLoop()));
      if (journal != nullptr) RETURN_IF_ERROR(journal->add(n, one));
      return one;
    };
    results[n] = compared();
    if (!*results[n] && results[n]->error().code == ErrorCode::kIo) is_lost = true;
    lanes->giveBack(std::move(lane));
    progress.add();
  });
  std::vector<EpisodeComparison> all;
  for (std::optional<Result<EpisodeComparison>>& result : results) {
    if (!result) continue;
    ASSIGN_OR_RETURN(auto one, std::move(*result));
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace galactic::dynamics
