#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "galactic/render_library.h"
#include "render/raster/pane_task.h"

namespace galactic::render {

/// The pools of a pack where they lie, without surfaces, kinds of colors and semantics.
[[nodiscard]] PackTables packTables(const RenderMeshes& meshes);

/// PackTables::color_kinds of a pack; none where it has no colors.
[[nodiscard]] std::vector<std::uint32_t> colorKinds(const RenderMeshes& meshes);

/// What tells textures of a library apart: where their texels lie, and their edge. Packs of a world
/// share textures.
using TextureKey = std::pair<const std::uint8_t*, std::uint32_t>;
[[nodiscard]] inline TextureKey keyOf(const RenderTexture& texture) {
  return {texture.texels.data(), texture.size};
}

/// SurfaceTexels::kind of a texture whose largest level has this edge, a power of two.
[[nodiscard]] std::uint32_t textureKind(std::uint32_t size, std::size_t base);

/// PackTables::surfaces of a pack. `textures`: how its textures look, by their numbers there.
[[nodiscard]] std::vector<SurfaceTexels> surfacesOf(const RenderMeshes& meshes,
                                                    const std::vector<SurfaceTexels>& textures);

/// Model `number` of a library, without its pack.
[[nodiscard]] ModelTables modelTables(const RenderLibrary& library, std::uint32_t number);

}  // namespace galactic::render
