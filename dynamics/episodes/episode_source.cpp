#include "dynamics/episodes/episode_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command_line/options.h"
#include "galactic/option_text.h"
#include "run/learned_run.h"
#include "run/recording.h"
#include "support/text/range_text.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

/// Rejects noise and delay of motions: the dynamics have their own inexactness, and would not apply
/// these.
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

class RecordedEpisodes final : public EpisodeSource {
 public:
  RecordedEpisodes(const World& world, const SimulationOptions& options,
                   std::vector<EpisodeTrace> traces)
      : world_(world), options_(options), traces_(std::move(traces)) {}

  [[nodiscard]] std::size_t count() const override { return traces_.size(); }
  [[nodiscard]] const SimulationOptions& options() const override { return options_; }
  [[nodiscard]] Result<std::unique_ptr<EpisodeLane>> makeLane() const override {
    return EpisodeLane::create(world_, options_, std::nullopt);
  }
  [[nodiscard]] Result<EpisodeTrace> trace(std::size_t n, EpisodeLane& /*lane*/) const override {
    return traces_[n];
  }
  [[nodiscard]] ActionSource actions(const EpisodeTrace& trace,
                                     EpisodeLane& /*lane*/) const override {
    return recordedActions(trace);
  }

 private:
  const World& world_;
  SimulationOptions options_;
  std::vector<EpisodeTrace> traces_;
};

/// The policy that plays: that of a pack, or else the scripted one.
struct Player {
  std::optional<OpenedPolicy> policy;
  bool is_deterministic = false;

  [[nodiscard]] ClosedLoop loop() const {
    return {.learned = policy ? &*policy : nullptr, .is_deterministic = is_deterministic};
  }
};

class PlayedEpisodes final : public EpisodeSource {
 public:
  /// `episodes`: their indices in the world.
  PlayedEpisodes(const World& world, const SimulationOptions& options, Player player,
                 std::vector<std::uint32_t> episodes)
      : world_(world),
        options_(options),
        player_(std::move(player)),
        episodes_(std::move(episodes)) {}

  [[nodiscard]] std::size_t count() const override { return episodes_.size(); }
  [[nodiscard]] const SimulationOptions& options() const override { return options_; }
  [[nodiscard]] Result<std::unique_ptr<EpisodeLane>> makeLane() const override {
    return EpisodeLane::create(world_, options_, player_.loop());
  }
  [[nodiscard]] Result<EpisodeTrace> trace(std::size_t n, EpisodeLane& lane) const override {
    return traceOf(episodes_[n], lane);
  }
  [[nodiscard]] ActionSource actions(const EpisodeTrace& /*trace*/,
                                     EpisodeLane& lane) const override {
    return policyActions(lane);
  }

 private:
  const World& world_;
  SimulationOptions options_;
  Player player_;
  std::vector<std::uint32_t> episodes_;
};

/// The options of the world's task, then those of the policy, then the user's.
Result<SimulationOptions> optionsOf(const Player& player, const LoopOptions& loop,
                                    const World& world) {
  SimulationOptions options = world.withTask({});
  if (player.policy) RETURN_IF_ERROR(applyNeeds(*player.policy, options));
  if (const auto fault = setOptions(loop.task, OptionScope::kTask, options)) {
    const OptionText& option = loop.task[fault->index];
    return fail(ErrorCode::kInvalidInput, "--set",
                fmt::format("{}={} is no option of the task, or has no such value; see the options "
                            "of galactic-run",
                            option.name, option.value));
  }
  RETURN_IF_ERROR(requireExactMotions(
      options, "the task", "add --set motion-noise=0 --set motion-bias=0 --set action-delay=0"));
  options.seed = loop.seed;
  return options;
}

/// The first `most` episodes in which the robot can start; 0: all.
Result<std::vector<std::uint32_t>> startableEpisodes(const World& world,
                                                     const SimulationOptions& options,
                                                     const Player& player, std::size_t most) {
  ASSIGN_OR_RETURN(const auto lane, EpisodeLane::create(world, options, player.loop()));
  const std::span<const std::uint32_t> skipped = lane->simulator().skippedEpisodes();
  const auto all = static_cast<std::uint32_t>(world.episodes().episodes().size());
  std::vector<std::uint32_t> episodes;
  for (std::uint32_t episode = 0; episode < all; ++episode) {
    if (most != 0 && episodes.size() == most) break;
    if (std::ranges::find(skipped, episode) == skipped.end()) episodes.push_back(episode);
  }
  return episodes;
}

}  // namespace

Result<std::unique_ptr<EpisodeSource>> recordedEpisodes(const std::filesystem::path& recording,
                                                        const World& world, std::size_t most) {
  ASSIGN_OR_RETURN(auto reader, RecordingReader::open(recording));
  ASSIGN_OR_RETURN(auto traces, tracesOf(reader, world, most));
  if (traces.empty()) {
    return fail(ErrorCode::kInvalidInput, recording.string(),
                "finishes no episode, so there is nothing to replay; record more steps");
  }
  const SimulationOptions& options = reader.subject().options;
  RETURN_IF_ERROR(requireExactMotions(options, recording.string(),
                                      "record a run without, with --motion-noise 0, "
                                      "--motion-bias 0 and --action-delay 0"));
  return std::make_unique<RecordedEpisodes>(world, options, std::move(traces));
}

Result<std::unique_ptr<EpisodeSource>> playedEpisodes(const std::filesystem::path& policy,
                                                      const LoopOptions& loop, const World& world,
                                                      std::size_t most) {
  Player player{.policy = {}, .is_deterministic = loop.is_deterministic};
  if (!policy.empty()) {
    RunOptions run;
    run.policy = policy.string();
    ASSIGN_OR_RETURN(player.policy, openPolicy(run));
  }
  ASSIGN_OR_RETURN(const auto options, optionsOf(player, loop, world));
  ASSIGN_OR_RETURN(auto episodes, startableEpisodes(world, options, player, most));
  return std::make_unique<PlayedEpisodes>(world, options, std::move(player), std::move(episodes));
}

}  // namespace galactic::dynamics
