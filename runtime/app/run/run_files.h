#pragma once
#include "command_line/options.h"
#include "galactic/error.h"
#include "galactic/world.h"

namespace galactic {

/// Checks, before a run that may take hours, everything that it will write against everything that
/// it reads; then makes the folder of its frames and tries each file. Fails with kInvalidInput when
/// an output is a file that the run reads or another of its outputs, with kUnsupported when its
/// extension belongs to another kind of file, and with kIo when it cannot be written.
[[nodiscard]] Result<void> tryOutputs(const World& world, const RunOptions& options);

}  // namespace galactic
