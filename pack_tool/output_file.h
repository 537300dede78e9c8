#pragma once
#include <filesystem>
#include <string_view>

#include "galactic/error.h"

namespace galactic::pack_tool {

/// Writes `bytes` to `path` through a temporary file beside it and a rename: a reader sees the old
/// file or the new one, never half of it. An existing file is replaced. Fails with kIo; then the
/// old file is intact and the temporary file is gone.
[[nodiscard]] Result<void> writeOutputFile(const std::filesystem::path& path,
                                           std::string_view bytes);

}  // namespace galactic::pack_tool
