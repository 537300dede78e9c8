#pragma once
#include "command_line/options.h"
#include "galactic/error.h"
#include "galactic/world.h"
#include "run/learned_run.h"
#include "run/recording.h"
#include "run/run_report.h"

namespace galactic {

/// A world that is ready to be stepped.
struct OpenedWorld {
  World world;
  /// Wall-clock time that opening took.
  double seconds = 0;
};

/// Opens the packs of `options` as a world. Fails with the errors of World::open.
[[nodiscard]] Result<OpenedWorld> openWorld(const RunOptions& options);

/// The file that a run's actions come from; empty if the policy generates them.
struct RunSource {
  RecordingReader* replay = nullptr;
  const OpenedPolicy* policy = nullptr;
};

/// Steps the world as `options` ask, and writes the recording. On a terminal, a line shows the
/// progress; Ctrl-C ends the run early, a second Ctrl-C at once. A replay ends at the first step
/// that differs. A file that cannot be written also ends the run early, and is reported in
/// RunReport::fault; the others are written. Fails with the errors of tryOutputs,
/// BatchSimulator::create, makeLearnedPolicy and RecordingReader.
[[nodiscard]] Result<RunReport> simulate(const RunOptions& options, const OpenedWorld& opened,
                                         const RunSource& source);

/// Checks that a run with these options can replay the recording; otherwise fails with
/// kInvalidInput, naming the option.
[[nodiscard]] Result<void> checkReplay(const RecordingReader& recording, const RunOptions& options);

}  // namespace galactic
