#pragma once
#include "galactic/error.h"
#include "options.h"
#include "recording.h"
#include "run_report.h"

namespace galactic {

/// Opens the packs of `options` as a world, steps it as they say and writes the recording. On a
/// terminal a line says how it goes; Ctrl-C ends the run early. `replay`: where the actions come
/// from, nullptr when the policy makes them up; the run ends at the first step that differs. Fails
/// with the errors of World::open, BatchSimulator::create and the recordings.
[[nodiscard]] Result<RunReport> simulate(const RunOptions& options, RecordingReader* replay);

/// Whether a run with these options can be a replay of the recording: kInvalidInput, naming the
/// option, when not.
[[nodiscard]] Result<void> checkReplay(const RecordingReader& recording, const RunOptions& options);

}  // namespace galactic
