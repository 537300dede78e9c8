#pragma once
#include <cstddef>
#include <filesystem>
#include <vector>

#include "galactic/bake/provenance.h"
#include "galactic/bake/scene_baker.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The bytes of a scene pack's FlatBuffer, without the file header. The same scene and provenance
/// give the same bytes. Fails with kUnsupported when it would reach 2 GiB, the limit of one pack.
[[nodiscard]] Result<std::vector<std::byte>> encodeScenePack(const BakedScene& scene,
                                                             const Provenance& provenance);

/// Writes header and payload atomically; returns the file's size in bytes.
[[nodiscard]] Result<std::uint64_t> writeScenePack(const std::filesystem::path& path,
                                                   const BakedScene& scene,
                                                   const Provenance& provenance);

}  // namespace galactic::bake
