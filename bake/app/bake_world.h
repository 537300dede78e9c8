#pragma once
#include "command.h"

namespace galactic::bake {

/// Makes the packs of datasets or of a recipe and the world that lists them, or lists what would be
/// made and what is missing for it (--dry-run). The exit code.
[[nodiscard]] int bakeWorld(const BakeCommand& command);

}  // namespace galactic::bake
