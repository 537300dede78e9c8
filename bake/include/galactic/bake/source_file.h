#pragma once
#include <filesystem>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Size and XXH3-128 hash of the file at `path`, for a pack's provenance; its name is relative to
/// the folder of `main_input`. Fails with kIo where it cannot be read.
[[nodiscard]] Result<SourceFile> describeFile(const std::filesystem::path& main_input,
                                              const std::filesystem::path& path);

}  // namespace galactic::bake
