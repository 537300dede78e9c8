#pragma once
#include "command_line/options.h"
#include "galactic/error.h"
#include "galactic/world.h"

namespace galactic {

/// Before a run, which may take hours: checks all that it will write against all that it reads,
/// then makes the folder of its frames and tries each file. Fails with kInvalidInput when an output
/// is a file that the run reads or another of its outputs, with kUnsupported when its extension is
/// of another kind of file, and with kIo when it cannot be written.
[[nodiscard]] Result<void> tryOutputs(const World& world, const RunOptions& options);

}  // namespace galactic
