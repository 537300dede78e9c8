#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "galactic/render_library.h"
#include "render/raster/pane_task.h"

namespace galactic::render {

/// The pools of a pack, in place; surfaces, kinds of colors and semantics are left empty.
[[nodiscard]] PackTables packTables(const RenderMeshes& meshes);

/// PackTables::color_kinds of a pack; empty if it has no colors.
[[nodiscard]] std::vector<std::uint32_t> colorKinds(const RenderMeshes& meshes);

/// Identifies a texture of a library: where its texels lie, and its edge. Packs of a world share
/// textures.
using TextureKey = std::pair<const std::uint8_t*, std::uint32_t>;
[[nodiscard]] inline TextureKey keyOf(const RenderTexture& texture) {
  return {texture.texels.data(), texture.size};
}

/// SurfaceTexels::kind of a texture whose largest level has this edge, a power of two.
[[nodiscard]] std::uint32_t textureKind(std::uint32_t size, std::size_t base);

/// PackTables::surfaces of a pack. `textures`: the texels of its textures, by their numbers in the
/// pack.
[[nodiscard]] std::vector<SurfaceTexels> surfacesOf(const RenderMeshes& meshes,
                                                    const std::vector<SurfaceTexels>& textures);

/// Model `number` of a library; its pack is left null.
[[nodiscard]] ModelTables modelTables(const RenderLibrary& library, std::uint32_t number);

}  // namespace galactic::render
