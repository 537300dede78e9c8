#pragma once
#include <cstddef>
#include <filesystem>
#include <span>

#include "galactic/error.h"

namespace galactic::bake {

/// Whether a glTF 2.0 file (.gltf or .glb, `bytes`) holds what it states: the chunks of a GLB its
/// length, buffers their bytes, buffer views their part of a buffer, accessors their elements, and
/// triangles three corners each. Buffers in files are looked for beside `path`. Fails with
/// kInvalidInput; what is no such file passes to the reader.
[[nodiscard]] Result<void> checkGltfRanges(const std::filesystem::path& path,
                                           std::span<const std::byte> bytes);

}  // namespace galactic::bake
