#pragma once
#include <filesystem>
#include <string>

#include "galactic/pack.h"

namespace galactic::pack_tool {

/// Fails with kInvalidInput when `output` is the pack itself: writing over what is being read would
/// lose it.
[[nodiscard]] Result<void> checkOutput(const PackFile& pack, const std::filesystem::path& output);

/// Writes a text or the bytes of a file in one go, replacing an existing file. Fails with kIo, and
/// for "-".
[[nodiscard]] Result<void> writeOutput(const std::filesystem::path& output,
                                       const std::string& bytes);

}  // namespace galactic::pack_tool
