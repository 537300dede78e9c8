#pragma once
#include "bake_outcome.h"
#include "options.h"

namespace galactic::bake {

/// Prints what one bake did: triangles, columns, spans, bytes, seconds per stage, disagreement with
/// the sphere casts.
void printClosingTable(const BakeOutcome& outcome, Verbosity verbosity);

}  // namespace galactic::bake
