#pragma once
#include "command.h"

namespace galactic::bake {

/// Makes the packs of datasets or of a recipe and the world pack that lists them. With --dry-run,
/// only lists what would be made and which inputs are missing. Returns the exit code.
[[nodiscard]] int bakeWorld(const BakeCommand& command);

}  // namespace galactic::bake
