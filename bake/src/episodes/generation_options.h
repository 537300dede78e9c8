#pragma once
#include <string>

#include "galactic/bake/episode_generator.h"

namespace galactic::bake {

/// Fails with kInvalidInput on options that make no sense.
[[nodiscard]] Result<void> checkOptions(const EpisodeGeneratorOptions& options);

/// "1 to 2 m", or "1 m or more".
[[nodiscard]] std::string textOf(const DistanceRange& range);

}  // namespace galactic::bake
