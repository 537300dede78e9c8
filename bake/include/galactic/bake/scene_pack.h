#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "galactic/bake/scene_baker.h"
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

/// The bytes of a scene pack's FlatBuffer, without the file header. The same scene and provenance
/// give the same bytes. Fails with kUnsupported when it would reach 2 GiB, the limit of one pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeScenePack(const BakedScene& scene,
                                                             const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeScenePack(const std::filesystem::path& path,
                                                   const BakedScene& scene,
                                                   const Provenance& provenance);

}  // namespace galactic::bake
