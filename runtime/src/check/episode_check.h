#pragma once
#include <string>

#include "galactic/error.h"

namespace galactic::schema {
struct EpisodeSet;
}

namespace galactic::detail {

/// Checks every value of an episode set whose structure has been verified. That the names in it
/// mean something is checked where scenes, objects and robot are known: by World.
[[nodiscard]] Result<void> checkEpisodeSet(const schema::EpisodeSet& set, const std::string& where);

}  // namespace galactic::detail
