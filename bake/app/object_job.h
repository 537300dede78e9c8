#pragma once
#include "bake_run.h"

namespace galactic::bake {

/// Bakes all objects of the command into one pack and prints the closing table. With --keep-going
/// the pack holds those that succeeded.
void bakeObjectFiles(BakeRun& run);

}  // namespace galactic::bake
