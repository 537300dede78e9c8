#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "galactic/pack.h"
#include "galactic/render_meshes.h"
#include "layout/render_mesh_builder.h"

namespace galactic {

/// What the part of a render model is called: the scene, an object of the set, a link.
[[nodiscard]] std::string partName(const PackFile& pack, std::uint32_t part);

/// The clusters of a model; none where it points past the end.
[[nodiscard]] std::span<const RenderCluster> clustersOf(const RenderMeshes& meshes,
                                                        const RenderModel& model);

/// Appends the triangles of a cluster: vertices at step * (origin + stored), exactly as a renderer
/// sees them; colors white where the pack has none.
void appendCluster(const RenderMeshes& meshes, const RenderModel& model,
                   const RenderCluster& cluster, RenderSurface& surface);

/// The triangles of a model: one surface for each semantic, material and sides they are seen from,
/// ascending; the reverse of buildRenderMeshes().
[[nodiscard]] std::vector<RenderSurface> surfacesOf(const RenderMeshes& meshes,
                                                    const RenderModel& model);

}  // namespace galactic
