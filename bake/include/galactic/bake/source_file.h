#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Size and XXH3-128 hash of the file at `path`, for a pack's provenance. Its name is the file's
/// own: the path would tell of the machine. Fails with kIo where it cannot be read.
[[nodiscard]] Result<SourceFile> describeFile(const std::filesystem::path& path);

/// The same of a file that is in memory.
[[nodiscard]] SourceFile describeBytes(std::string name, std::span<const std::byte> bytes);

}  // namespace galactic::bake
