#include "render/soft/soft_engine.h"

#include <algorithm>

#include "render/raster/placed_model.h"
#include "support/processor.h"
#include "support/text/counted.h"

namespace galactic::render {

SoftEngine::SoftEngine(const RenderLibrary& library, const RenderOptions& options, DrawPane draw)
    : options_(options),
      draw_(draw),
      scene_(library),
      panes_(cutIntoPanes(options.width, options.height)) {
  options_.threads = detail::threadCount(options.threads);
  memories_.reserve(options_.threads);
  for (std::uint32_t n = 0; n < options_.threads; ++n) {
    memories_.push_back(
        std::make_unique<PaneMemory>(paneEdge(options_.width), paneEdge(options_.height)));
  }
  workers_ = std::make_unique<detail::Workers>(
      options_.threads, [this](std::size_t part) { drawPanes(*memories_[part]); });
  options_.threads =
      static_cast<std::uint32_t>(std::min<std::size_t>(options_.threads, workers_->count()));
}

void SoftEngine::begin(std::span<const RenderView> views, const RenderTargets& targets) {
  std::size_t most_models = 0;
  std::size_t most_clusters = 0;
  statistics_ = {};
  for (const RenderView& view : views) {
    std::size_t clusters = 0;
    forModels(view, [&](std::uint32_t model, const RigidTransform&, std::uint32_t) {
      clusters += scene_.models()[model].cluster_count;
    });
    most_models = std::max(most_models, modelCount(view));
    most_clusters = std::max(most_clusters, clusters);
    statistics_.instances += modelCount(view);
    statistics_.clusters += clusters;
  }
  for (const auto& memory : memories_) {
    memory->reserve(most_models, most_clusters);
    memory->counts = {};
  }
  views_ = views;
  targets_ = targets;
  next_.store(0, std::memory_order_relaxed);
  workers_->begin();
}

void SoftEngine::end() {
  workers_->end();
  for (const auto& memory : memories_) {
    statistics_.clusters_drawn += memory->counts.clusters_drawn;
    statistics_.triangles_drawn += memory->counts.triangles_drawn;
  }
}

Result<DeviceImages> SoftEngine::renderToDevice(std::span<const RenderView>, std::uintptr_t) {
  return fail(
      ErrorCode::kUnsupported, "device images",
      "the soft backend draws into memory of the processor; use the cuda or the gl backend");
}

std::string SoftEngine::description() const {
  const char* instructions = draw_ == drawPaneAvx512 ? "AVX-512"
                             : draw_ == drawPaneAvx2 ? "AVX2"
                                                     : "portable";
  return std::string("soft, ") + instructions + ", " + counted(options_.threads, "thread");
}

void SoftEngine::drawPanes(PaneMemory& memory) noexcept {
  const std::size_t count = views_.size() * panes_.size();
  for (std::size_t n = next_.fetch_add(1, std::memory_order_relaxed); n < count;
       n = next_.fetch_add(1, std::memory_order_relaxed)) {
    drawOne(memory, n / panes_.size(), panes_[n % panes_.size()]);
  }
}

void SoftEngine::drawOne(PaneMemory& memory, std::size_t view, const PaneRectangle& pane) noexcept {
  const std::size_t first_pixel = view * options_.width * options_.height;
  PaneTask task;
  task.models = memory.models();
  task.model_count = placeModels(views_[view], memory.models());
  task.texel_bases = scene_.texelBases();
  task.image_width = options_.width;
  task.image_height = options_.height;
  task.left = pane.left;
  task.top = pane.top;
  task.width = pane.width;
  task.height = pane.height;
  task.near = options_.near;
  task.background = options_.background;
  task.culling = options_.culling;
  task.channels = static_cast<std::uint32_t>(options_.color);
  if (task.channels != 0) task.color = targets_.color.data() + first_pixel * task.channels;
  if (options_.depth) task.depth = targets_.depth.data() + first_pixel;
  if (options_.semantics) task.semantics = targets_.semantics.data() + first_pixel;
  const PaneCounts counts = draw_(task, memory.scratch());
  memory.counts.clusters_drawn += counts.clusters_drawn;
  memory.counts.triangles_drawn += counts.triangles_drawn;
}

std::uint32_t SoftEngine::placeModels(const RenderView& view, PlacedModel* placed) const noexcept {
  if (!canSee(view.camera)) return 0;
  const float focal = focalLength(options_, view.camera);
  const RigidTransform camera_from_world = inverse(view.camera.world_from_camera);
  std::uint32_t count = 0;
  forModels(view, [&](std::uint32_t number, const RigidTransform& world_from_model,
                      std::uint32_t semantic) {
    const ModelTables& model = scene_.models()[number];
    if (model.cluster_count == 0) return;
    PlacedModel& next = placed[count];
    next.model = &model;
    next.semantic = semantic;
    if (placeModel(camera_from_world, focal, world_from_model, next)) ++count;
  });
  return count;
}

Result<std::unique_ptr<RenderEngine>> makeSoftEngine(const RenderLibrary& library,
                                                     const RenderOptions& options) {
  const DrawPane draw = detail::hasAvx512() ? drawPaneAvx512
                        : detail::hasAvx2() ? drawPaneAvx2
                                            : drawPanePortable;
  return std::make_unique<SoftEngine>(library, options, draw);
}

}  // namespace galactic::render
