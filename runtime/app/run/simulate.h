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
  /// Wall clock that opening took.
  double seconds = 0;
};

/// Opens the packs of `options` as a world. Fails with the errors of World::open.
[[nodiscard]] Result<OpenedWorld> openWorld(const RunOptions& options);

/// Where a run's actions come from, when it is a file; nothing when the policy makes them up.
struct RunSource {
  RecordingReader* replay = nullptr;
  const OpenedPolicy* policy = nullptr;
};

/// Steps the world as `options` say and writes the recording. On a terminal a line says how it
/// goes; Ctrl-C ends the run early, pressed twice at once. A replay ends at the first step that
/// differs. A file that cannot be written ends it early, too, and is RunReport::fault; the others
/// are written. Fails with the errors of tryOutputs, BatchSimulator::create, makeLearnedPolicy and
/// RecordingReader.
[[nodiscard]] Result<RunReport> simulate(const RunOptions& options, const OpenedWorld& opened,
                                         const RunSource& source);

/// Whether a run with these options can be a replay of the recording: kInvalidInput, naming the
/// option, when not.
[[nodiscard]] Result<void> checkReplay(const RecordingReader& recording, const RunOptions& options);

}  // namespace galactic
