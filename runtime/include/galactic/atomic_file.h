#pragma once
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <span>

#include "galactic/error.h"

namespace galactic {

/// Writes `parts` one after the other to `path` through a temporary file beside it, fsync and
/// rename: a reader sees the old file or the new one, never half of it. On failure (kIo) the old
/// file is intact and the temporary file is gone. A symbolic link is followed; a folder, device or
/// pipe is refused.
[[nodiscard]] Result<void> writeFileAtomically(
    const std::filesystem::path& path, std::initializer_list<std::span<const std::byte>> parts);

}  // namespace galactic
