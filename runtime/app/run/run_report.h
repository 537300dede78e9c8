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

/// Sums over the episodes that ended in a run.
struct EpisodeSums {
  std::uint64_t ended = 0;
  /// Of the rewards, and of the steps, of these episodes.
  double returns = 0;
  std::uint64_t steps = 0;
};

/// Wall clock of some of the steps.
struct StepTime {
  double seconds = 0;
  std::uint64_t steps = 0;

  void add(double more) {
    seconds += more;
    ++steps;
  }
  /// Seconds per step; 0 without a step.
  [[nodiscard]] double mean() const {
    return steps == 0 ? 0 : seconds / static_cast<double>(steps);
  }
};

/// What drawing a run took.
struct RenderReport {
  /// BatchRenderer::description(), and its backendName().
  std::string description;
  std::string backend;
  /// By the ids of semantic images; empty where none are drawn.
  std::vector<std::string> semantic_names;
  std::uint64_t images = 0;
  /// Steps whose drawing and simulation were measured alone, and those of both together.
  StepTime rendering;
  StepTime physics;
  StepTime overlapped;
};

/// What a policy pack did.
struct LearnedReport {
  /// The pack's.
  std::string name;
  bool samples = true;
  /// Wall clock of all its decisions, with the drawing of what it sees.
  double seconds = 0;
};

/// What a run was and what came of it.
struct RunReport {
  RunOptions options;
  /// What the world says of the task, whether or not the options are so.
  std::vector<OptionText> world_task;
  std::size_t threads = 0;
  /// Of the whole batch; fewer than were asked for when the run was interrupted: by a signal, or by
  /// a file that could not be written.
  std::uint64_t steps = 0;
  bool is_interrupted = false;
  /// Why one of the run's files was not written; all the others were.
  std::optional<Error> fault;
  /// Wall clock in seconds: opening the packs, making the simulator, all calls of step(), and the
  /// whole loop with policy and recording.
  double open_seconds = 0;
  double create_seconds = 0;
  double step_seconds = 0;
  double loop_seconds = 0;
  /// Threads' seconds of `sampled_steps` steps.
  std::vector<PhaseTime> phases;
  std::uint64_t sampled_steps = 0;
  SimulationStatistics sum;
  EpisodeSums episodes;
  /// Episodes of the world, and which of them cannot be started.
  std::size_t world_episodes = 0;
  std::vector<std::uint32_t> skipped;
  /// Of all envs; and what they share.
  std::size_t memory_bytes = 0;
  std::size_t shared_bytes = 0;
  /// When something was drawn. Then step_seconds holds the drawing, too.
  std::optional<RenderReport> rendering;
  /// When a policy pack was played.
  std::optional<LearnedReport> learned;
  /// The first step in which a replay differs, counted from 0.
  std::optional<std::uint64_t> first_difference;
};

/// Whether an option of the world's task is in force: neither the command line nor a recording has
/// given it another value.
[[nodiscard]] bool isInForce(const OptionText& option, const RunOptions& options);

/// The closing table, lines of text.
[[nodiscard]] std::string tableOf(const RunReport& report);

/// The same as JSON, with all options and a line end.
[[nodiscard]] std::string jsonOf(const RunReport& report);

/// Writes the options of a simulation into an object of JSON, by their names.
void writeSimulation(JsonWriter& json, const SimulationOptions& simulation);

/// The legend of semantic images as JSON: id, name and the color in pictures of each.
[[nodiscard]] std::string semanticLegend(const std::vector<std::string>& names);

}  // namespace galactic
