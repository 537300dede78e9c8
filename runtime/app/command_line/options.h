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

/// Heading of the options that do not start a simulation.
inline constexpr const char* kPlainGroup = "Options";

/// What the command line asks for.
struct RunOptions {
  RunOptions() { simulation.envs = 1024; }

  std::vector<std::string> packs;
  bool trusted = false;
  bool bench = false;
  /// Whether to print only errors.
  bool is_quiet = false;
  /// Whether any option of a simulation was typed: then the packs are a world to step; otherwise
  /// they are summarized.
  bool simulates = false;
  SimulationOptions simulation;
  /// Why a typed simulation option has no effect alongside the others; empty if all have one.
  /// Depends on world, policy and recording, so it is only valid after they have been read.
  std::string without_effect;
  /// Steps of the whole batch.
  std::uint64_t steps = 1000;
  std::string policy = "random";
  /// Whether a learned policy takes its likeliest actions instead of sampling.
  bool is_deterministic = false;
  DrawingOptions drawing;
  /// Files to write; empty for none.
  std::string record;
  std::string report;
  /// A page that plays the run, and how many envs it shows, from the first one on.
  std::string view;
  std::uint32_t view_envs = 4;
  /// The first episode of the first env as an animated scene.
  std::string animation;

  /// The file of "replay:FILE"; empty for the other policies.
  [[nodiscard]] std::string replayFile() const;
  /// The policy pack, if `policy` is one; empty for the other policies.
  [[nodiscard]] std::string policyFile() const;
};

/// Visits each option of a run that is not one of the simulation's (visitOptions), in one place for
/// the command line and for reports. On `v` it calls the functions of the table of simulations,
/// with `whole` also for 64 bits, those of visitDrawingOptions, and
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

/// Reads the command line into `options`; options that are not typed keep their values. Prints
/// help, version and errors. Returns an exit code if nothing remains to be done.
[[nodiscard]] std::optional<int> parseCommandLine(int argc, const char* const* argv,
                                                  RunOptions& options);

/// Prints what is wrong with the command line and returns the exit code.
[[nodiscard]] int refuseCommandLine(std::string_view message);

}  // namespace galactic
