#pragma once
#include "bake_run.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Lists the packs of the command in one world pack, after seeing that together they make a world,
/// and prints the closing table; the entry of the report.
[[nodiscard]] Result<Json> linkWorldPack(BakeRun& run);

}  // namespace galactic::bake
