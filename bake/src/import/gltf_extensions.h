#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace galactic::bake {

/// The first extension that a glTF 2.0 file (JSON or GLB) requires (`extensionsRequired`) and that
/// the mesh reader would ignore although it changes shapes or images, such as Draco, meshopt and
/// KTX2 compression. None also when `file` is no glTF: the reader then says why.
[[nodiscard]] std::optional<std::string> unsupportedGltfExtension(std::span<const std::byte> file);

}  // namespace galactic::bake
