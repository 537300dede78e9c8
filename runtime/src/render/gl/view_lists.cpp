#include "render/gl/view_lists.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/gl/shader_sources.h"
#include "render/render_engine.h"

namespace galactic::render::gl {
namespace {

bool isFinite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isFinite(const RigidTransform& transform) {
  return isFinite(transform.x_axis) && isFinite(transform.y_axis) && isFinite(transform.z_axis) &&
         isFinite(transform.origin);
}

/// Calls `use` for each instance of a view that has something to show.
template <class Use>
void forInstances(const RenderView& view, std::span<const ModelClusters> models, Use use) {
  if (!canSee(view.camera)) return;
  forModels(view, [&](std::uint32_t model, const RigidTransform& world_from_model,
                      std::uint32_t semantic) {
    if (model >= models.size() || models[model].count() == 0) return;
    if (isFinite(world_from_model)) use(world_from_model, models[model], semantic);
  });
}

std::uint32_t chunksOf(std::uint32_t clusters) {
  return (clusters + kChunkClusters - 1) / kChunkClusters;
}

std::array<std::array<float, 4>, 3> rowsOf(const RigidTransform& t) {
  return {{{t.x_axis.x, t.y_axis.x, t.z_axis.x, t.origin.x},
           {t.x_axis.y, t.y_axis.y, t.z_axis.y, t.origin.y},
           {t.x_axis.z, t.y_axis.z, t.z_axis.z, t.origin.z}}};
}

}  // namespace

std::uint32_t SliceCounts::allChunks() const {
  return std::accumulate(chunks.begin(), chunks.end(), 0U);
}
std::uint32_t SliceCounts::allDraws() const {
  return std::accumulate(draws.begin(), draws.end(), 0U);
}

SliceCounts countSlice(std::span<const RenderView> views, std::span<const ModelClusters> models) {
  SliceCounts counts;
  for (const RenderView& view : views) {
    forInstances(
        view, models, [&](const RigidTransform&, const ModelClusters& model, std::uint32_t) {
          ++counts.instances;
          counts.clusters += model.count();
          for (std::size_t kind = 0; kind < kDrawClasses; ++kind) {
            const std::uint32_t clusters = model.first[kind + 1] - model.first[kind];
            counts.chunks[kind] += chunksOf(clusters);
            const std::uint32_t full = clusters / kChunkClusters;
            counts.draws[kind] += full * (kChunkClusters / 2) + (clusters % kChunkClusters + 1) / 2;
          }
        });
  }
  return counts;
}

void listSlice(std::span<const RenderView> views, std::span<const ModelClusters> models,
               float aspect, const SliceLists& lists) {
  std::array<std::uint32_t, kDrawClasses> next_chunk{};
  std::exclusive_scan(lists.counts.chunks.begin(), lists.counts.chunks.end(), next_chunk.begin(),
                      0U);
  std::uint32_t number = 0;
  for (std::size_t layer = 0; layer < views.size(); ++layer) {
    const RenderCamera& camera = views[layer].camera;
    const RigidTransform camera_from_world = inverse(camera.world_from_camera);
    const float scale_y = 1.0F / std::tan(camera.vertical_fov / 2);
    forInstances(views[layer], models,
                 [&](const RigidTransform& world_from_model, const ModelClusters& model,
                     std::uint32_t semantic) {
                   lists.instances[number] = {.rows = rowsOf(camera_from_world * world_from_model),
                                              .scale_x = scale_y / aspect,
                                              .scale_y = scale_y,
                                              .layer = static_cast<std::uint32_t>(layer),
                                              .semantic = semantic};
                   for (std::size_t kind = 0; kind < kDrawClasses; ++kind) {
                     const std::uint32_t end = model.first[kind + 1];
                     for (std::uint32_t first = model.first[kind]; first < end;
                          first += kChunkClusters) {
                       lists.chunks[next_chunk[kind]++] = {number, first,
                                                           std::min(kChunkClusters, end - first)};
                     }
                   }
                   ++number;
                 });
  }
}

}  // namespace galactic::render::gl
