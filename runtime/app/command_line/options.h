#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/render_options.h"
#include "galactic/simulation_options.h"
#include "support/option_table.h"

namespace galactic {

/// Heading of the options that start no simulation.
inline constexpr const char* kPlainGroup = "Options";

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

/// Names each option of a run that is none of the simulation's (visitOptions), once: for the
/// command line and for reports. Calls those of the table of simulations on `v`, `whole` with 64
/// bits, too, those of visitDrawingOptions, and
///   policy(name, field, help), likeliest(name, field).
template <class Visitor>
void visitRunOptions(RunOptions& o, Visitor& v) {
  constexpr Within<std::uint32_t> kShown{1, 1024};
  v.group(kPlainGroup);
  v.flag("trusted", Switch{o.trusted, true},
         "Skip the verification of packs that this machine has verified before");
  v.flag("bench", Switch{o.bench, true}, "Measure queries on all grids of all packs");
  v.flag("quiet", Switch{o.is_quiet, true}, "Only errors");
  v.group("Simulation");
  v.whole("steps", o.steps, Within<std::uint64_t>{1, std::uint64_t{1} << 40U},
          "Steps of the whole batch");
  v.policy("policy", o.policy, "Where the actions come from");
  v.likeliest("deterministic", o.is_deterministic);
  v.whole("threads", o.simulation.threads, Within<std::uint32_t>{0, kMostThreads},
          "Threads; the results do not depend on it; 0: one per processor");
  v.flag("body-transforms", Switch{o.simulation.body_transforms, true},
         "Keep the pose of every body of the robot; rendering implies it");
  v.text("record", o.record, Shown{"FILE"}, "Write actions and digests, for replay:FILE");
  v.text("report", o.report, Shown{"FILE.json"}, "Write the closing table as JSON");
  v.text("view", o.view, Shown{"FILE.html"}, "Write a page that plays the run in a browser");
  v.whole("view-envs", o.view_envs, kShown, "How many envs the page shows");
  v.text("animation", o.animation, Shown{"FILE.glb"},
         "Write the first episode of the first env as an animated scene (glTF)");
  visitDrawingOptions(o.drawing, v);
}

/// Reads the command line into `options`; what is not typed keeps its value. Prints help, version
/// and what is wrong. Returns an exit code when there is nothing more to do.
[[nodiscard]] std::optional<int> parseCommandLine(int argc, const char* const* argv,
                                                  RunOptions& options);

/// Prints what is wrong with the command line and returns the exit code.
[[nodiscard]] int refuseCommandLine(std::string_view message);

}  // namespace galactic
