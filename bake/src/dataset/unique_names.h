#pragma once
#include <string>
#include <vector>

namespace galactic::bake {

/// A name for each of `paths`, which are folders and a last part: that part, with as few folders
/// before it, joined by '_', as make it unique. Those that no folder tells apart get a number. No
/// name has a '/' that no part has. Deterministic.
[[nodiscard]] std::vector<std::string> uniqueNames(
    const std::vector<std::vector<std::string>>& paths);

}  // namespace galactic::bake
