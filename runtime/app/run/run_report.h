#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "command_line/options.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/option_text.h"

namespace galactic {

class JsonWriter;

/// Sums over the episodes that ended during a run.
struct EpisodeSums {
  std::uint64_t ended = 0;
  /// Sums of the rewards and of the steps of these episodes.
  double returns = 0;
  std::uint64_t steps = 0;
};

/// Wall-clock time of some of the steps.
struct StepTime {
  double seconds = 0;
  std::uint64_t steps = 0;

  void add(double more) {
    seconds += more;
    ++steps;
  }
  /// Seconds per step; 0 without steps.
  [[nodiscard]] double mean() const {
    return steps == 0 ? 0 : seconds / static_cast<double>(steps);
  }
};

/// What was measured while drawing a run.
struct RenderReport {
  /// BatchRenderer::description() and backendName().
  std::string description;
  std::string backend;
  /// Indexed by the ids in semantic images; empty if none are drawn.
  std::vector<std::string> semantic_names;
  std::uint64_t images = 0;
  /// Steps whose drawing and simulation were measured one after the other, and steps that did both
  /// at once.
  StepTime rendering;
  StepTime physics;
  StepTime overlapped;
};

/// What was measured of a policy pack.
struct LearnedReport {
  /// Name of the pack.
  std::string name;
  bool samples = true;
  /// Wall-clock time of all its decisions, including drawing the images that it sees.
  double seconds = 0;
};

/// What a run was asked to do, and its results.
struct RunReport {
  RunOptions options;
  /// The options that the world sets for the task, even where others are in force.
  std::vector<OptionText> world_task;
  std::size_t threads = 0;
  /// Steps of the whole batch; fewer than requested if the run was interrupted, by a signal or by a
  /// file that could not be written.
  std::uint64_t steps = 0;
  bool is_interrupted = false;
  /// Why one of the run's files was not written; all others were.
  std::optional<Error> fault;
  /// Wall-clock seconds for opening the packs, making the simulator, all calls of step(), and the
  /// whole loop with policy and recording.
  double open_seconds = 0;
  double create_seconds = 0;
  double step_seconds = 0;
  double loop_seconds = 0;
  /// Thread seconds of `sampled_steps` steps.
  std::vector<PhaseTime> phases;
  std::uint64_t sampled_steps = 0;
  SimulationStatistics sum;
  EpisodeSums episodes;
  /// Number of episodes in the world, and those that cannot be started.
  std::size_t world_episodes = 0;
  std::vector<std::uint32_t> skipped;
  /// Memory of all envs, and memory that they share.
  std::size_t memory_bytes = 0;
  std::size_t shared_bytes = 0;
  /// Present if something was drawn. Then step_seconds includes the drawing.
  std::optional<RenderReport> rendering;
  /// Present if a policy pack was played.
  std::optional<LearnedReport> learned;
  /// The first step in which a replay differs from its recording, counted from 0.
  std::optional<std::uint64_t> first_difference;
};

/// Whether an option of the world's task is in force, that is, has not been changed by the command
/// line or a recording.
[[nodiscard]] bool isInForce(const OptionText& option, const RunOptions& options);

/// The table at the end of a run, as lines of text.
[[nodiscard]] std::string tableOf(const RunReport& report);

/// The same as JSON, with all options, ended by a line break.
[[nodiscard]] std::string jsonOf(const RunReport& report);

/// Writes the options of a simulation into a JSON object, by name.
void writeSimulation(JsonWriter& json, const SimulationOptions& simulation);

/// The legend of semantic images as JSON: for each id, its name and its color in pictures.
[[nodiscard]] std::string semanticLegend(const std::vector<std::string>& names);

}  // namespace galactic
