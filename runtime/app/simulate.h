#pragma once
#include "galactic/error.h"
#include "galactic/world.h"
#include "options.h"
#include "recording.h"
#include "run_report.h"

namespace galactic {

/// A world that is ready to be stepped.
struct OpenedWorld {
  World world;
  /// Wall clock that opening took.
  double seconds = 0;
};

/// Opens the packs of `options` as a world. Fails with the errors of World::open.
[[nodiscard]] Result<OpenedWorld> openWorld(const RunOptions& options);

/// Steps the world as `options` say and writes the recording. On a terminal a line says how it
/// goes; Ctrl-C ends the run early. `replay`: where the actions come from, nullptr when the policy
/// makes them up; the run ends at the first step that differs. Fails with the errors of
/// BatchSimulator::create and the recordings.
[[nodiscard]] Result<RunReport> simulate(const RunOptions& options, const OpenedWorld& opened,
                                         RecordingReader* replay);

/// Whether a run with these options can be a replay of the recording: kInvalidInput, naming the
/// option, when not.
[[nodiscard]] Result<void> checkReplay(const RecordingReader& recording, const RunOptions& options);

}  // namespace galactic
