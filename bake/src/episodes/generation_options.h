#pragma once
#include "galactic/bake/episode_generator.h"

namespace galactic::bake {

/// Fails with kInvalidInput on options that make no sense.
[[nodiscard]] Result<void> checkOptions(const EpisodeGeneratorOptions& options);

}  // namespace galactic::bake
