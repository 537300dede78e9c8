#pragma once
#include "bake_run.h"

namespace galactic::bake {

/// Bakes the inputs of a command that has no plan, each into its pack or all into one, and tells
/// the run what became of them.
void bakeInputs(BakeRun& run);

}  // namespace galactic::bake
