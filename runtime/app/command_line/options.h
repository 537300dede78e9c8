#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/render_options.h"
#include "galactic/simulation_options.h"

namespace galactic {

/// What the command line asks for.
struct RunOptions {
  RunOptions() { simulation.envs = 1024; }

  std::vector<std::string> packs;
  bool trusted = false;
  bool bench = false;
  /// Whether errors alone are printed.
  bool is_quiet = false;
  /// Whether any option of a simulation was typed: then the packs are a world and step, else they
  /// are summarized.
  bool simulates = false;
  SimulationOptions simulation;
  /// Why an option of the simulation that was typed does nothing beside all the others; empty when
  /// none. World, policy and recording have a say in it: it counts when they have been read.
  std::string without_effect;
  /// Of the whole batch.
  std::uint64_t steps = 1000;
  std::string policy = "random";
  /// Whether a learned policy takes its likeliest actions, instead of drawing them.
  bool is_deterministic = false;
  DrawingOptions drawing;
  /// Files to write; empty for none.
  std::string record;
  std::string report;
  /// The page that plays the run, and how many of the first envs it shows.
  std::string view;
  std::uint32_t view_envs = 4;
  /// The first episode of the first env as an animated scene.
  std::string animation;

  /// The file of "replay:FILE"; empty for the other policies.
  [[nodiscard]] std::string replayFile() const;
  /// The policy pack, where the policy is one; empty for the other policies.
  [[nodiscard]] std::string policyFile() const;
};

/// Reads the command line into `options`; what is not typed keeps its value. Prints help, version
/// and what is wrong. Returns an exit code when there is nothing more to do.
[[nodiscard]] std::optional<int> parseCommandLine(int argc, const char* const* argv,
                                                  RunOptions& options);

/// Prints what is wrong with the command line and returns the exit code.
[[nodiscard]] int refuseCommandLine(std::string_view message);

}  // namespace galactic
