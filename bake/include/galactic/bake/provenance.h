#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/source_asset.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Where a pack comes from: goes into the pack, so nothing in it may depend on the machine, the
/// time or the number of threads.
struct Provenance {
  std::string tool = "galactic-bake";
  std::string tool_version;
  /// Long option names and values that decide the content, in a fixed order.
  std::vector<std::pair<std::string, std::string>> options;
  std::vector<SourceFile> sources;
  std::vector<std::string> warnings;
};

/// Size and XXH3-128 hash of the file at `path`, for a pack's provenance. Its name is the file's
/// own: the path would tell of the machine. Fails with kIo where it cannot be read.
[[nodiscard]] Result<SourceFile> describeFile(const std::filesystem::path& path);

/// The same of a file that is in memory.
[[nodiscard]] SourceFile describeBytes(std::string name, std::span<const std::byte> bytes);

}  // namespace galactic::bake
