#pragma once
#include <filesystem>
#include <vector>

#include "galactic/error.h"

namespace galactic::pack_tool {

/// The files `*.pack` in a folder and below, in the order of their paths; links to folders are not
/// followed, and what is hidden is left out. Fails with kIo where a folder cannot be read, and with
/// kInvalidInput when there is none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> findPacks(
    const std::filesystem::path& folder);

}  // namespace galactic::pack_tool
