#include "view/render_surfaces.h"

#include <fmt/format.h>

#include <map>
#include <tuple>
#include <utility>

#include "galactic/schema/pack_generated.h"
#include "layout/render_layout.h"

namespace galactic {

namespace {

float coordinate(std::int32_t origin, std::uint16_t stored, float step) {
  return static_cast<float>(origin + std::int32_t{stored}) * step;
}

RenderVertex decoded(const RenderMeshes& meshes, const RenderModel& model,
                     const RenderCluster& cluster, std::size_t number) {
  const std::size_t at = cluster.first_vertex + number;
  RenderVertex vertex;
  vertex.position = {coordinate(cluster.origin_x, vertexValue(meshes, at, kVertexX), model.step),
                     coordinate(cluster.origin_y, vertexValue(meshes, at, kVertexY), model.step),
                     coordinate(cluster.origin_z, vertexValue(meshes, at, kVertexZ), model.step)};
  vertex.u =
      cluster.u_minimum + cluster.u_step * static_cast<float>(vertexValue(meshes, at, kVertexU));
  vertex.v =
      cluster.v_minimum + cluster.v_step * static_cast<float>(vertexValue(meshes, at, kVertexV));
  if (!meshes.colors.empty()) vertex.color = meshes.colors[at];
  return vertex;
}

}  // namespace

std::string partName(const PackFile& pack, std::uint32_t part) {
  const auto name_in = [part](const auto& names) {
    return part < names.size() ? names.Get(part)->str() : fmt::format("part {}", part);
  };
  if (const auto* scene = pack.root().asset_as_Scene()) return scene->name()->str();
  if (const auto* robot = pack.root().asset_as_Robot()) return name_in(*robot->link_names());
  const auto* set = pack.root().asset_as_ObjectSet();
  if (set == nullptr || part >= set->objects()->size()) return fmt::format("part {}", part);
  return set->objects()->Get(part)->name()->str();
}

std::span<const RenderCluster> clustersOf(const RenderMeshes& meshes, const RenderModel& model) {
  if (model.first_cluster > meshes.clusters.size() ||
      model.cluster_count > meshes.clusters.size() - model.first_cluster) {
    return {};
  }
  return meshes.clusters.subspan(model.first_cluster, model.cluster_count);
}

void appendCluster(const RenderMeshes& meshes, const RenderModel& model,
                   const RenderCluster& cluster, RenderSurface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (std::size_t n = 0; n < cluster.vertex_count; ++n) {
    surface.vertices.push_back(decoded(meshes, model, cluster, n));
  }
  for (std::size_t n = 0; n < cluster.triangle_count; ++n) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      surface.corners.push_back(first + triangleCorner(meshes, cluster.first_triangle + n, corner));
    }
  }
}

std::vector<RenderSurface> surfacesOf(const RenderMeshes& meshes, const RenderModel& model) {
  std::map<std::tuple<std::uint16_t, std::uint16_t, bool>, RenderSurface> by_kind;
  for (const RenderCluster& cluster : clustersOf(meshes, model)) {
    const bool two_sided = cluster.two_sided != 0;
    RenderSurface& surface = by_kind[{cluster.semantic, cluster.material, two_sided}];
    surface.material = cluster.material;
    surface.semantic = cluster.semantic;
    surface.two_sided = two_sided;
    appendCluster(meshes, model, cluster, surface);
  }
  std::vector<RenderSurface> surfaces;
  surfaces.reserve(by_kind.size());
  for (auto& [kind, surface] : by_kind) surfaces.push_back(std::move(surface));
  return surfaces;
}

}  // namespace galactic
