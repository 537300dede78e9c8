#pragma once
#include "options.h"

namespace galactic::bake {

/// Bakes a dataset, or the world of a recipe: all its packs, then the world pack that lists them,
/// and the reports. The exit code.
[[nodiscard]] int bakePlan(const BakeCommand& command);

}  // namespace galactic::bake
