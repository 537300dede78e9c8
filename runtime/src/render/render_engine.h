#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_renderer.h"
#include "render/raster/pane_task.h"

namespace galactic::render {

/// One way to draw a batch. Every BatchRenderer has one and forwards calls to it.
class RenderEngine {
 public:
  RenderEngine() = default;
  virtual ~RenderEngine() = default;
  RenderEngine(const RenderEngine&) = delete;
  RenderEngine& operator=(const RenderEngine&) = delete;

  /// Starts to draw. The caller has checked the sizes of the spans.
  virtual void begin(std::span<const RenderView> views, const RenderTargets& targets) = 0;
  /// Returns when the images are complete.
  virtual void end() = 0;

  /// Draws, and leaves the images on a CUDA device: see BatchRenderer::renderToDevice(). Fails with
  /// kUnsupported if the engine cannot do that.
  [[nodiscard]] virtual Result<DeviceImages> renderToDevice(std::span<const RenderView> views,
                                                            std::uintptr_t stream) = 0;

  /// kSoft, kGl or kCuda.
  [[nodiscard]] virtual RenderBackend backend() const = 0;
  [[nodiscard]] virtual std::string description() const = 0;
  [[nodiscard]] virtual RenderStatistics statistics() const = 0;
};

/// `library` must outlive the engine; the options must be within range.
[[nodiscard]] Result<std::unique_ptr<RenderEngine>> makeSoftEngine(const RenderLibrary& library,
                                                                   const RenderOptions& options);
[[nodiscard]] Result<std::unique_ptr<RenderEngine>> makeGlEngine(const RenderLibrary& library,
                                                                 const RenderOptions& options);
[[nodiscard]] Result<std::unique_ptr<RenderEngine>> makeCudaEngine(const RenderLibrary& library,
                                                                   const RenderOptions& options);
/// Whether the device that the `cuda` backend would take has a data center chip, which has few
/// units that draw triangles; false if there is no such device.
[[nodiscard]] bool isForDataCenters(const RenderOptions& options);
/// Draws a small scene with triangles of every kind on that device. Fails with kInternal if the
/// images differ from those of the `soft` backend, and in the cases in which makeCudaEngine()
/// fails.
[[nodiscard]] Result<void> proveCuda(const RenderOptions& options);

[[nodiscard]] inline std::size_t modelCount(const RenderView& view) noexcept {
  return view.instances.size() + view.posed.size() + view.attached.size();
}

/// Calls use(model, world_from_model, semantic) for each model of a view, in the order of drawing.
template <class Use>
void forModels(const RenderView& view, const Use& use) {
  for (const RenderInstance& instance : view.instances) {
    use(instance.model, instance.world_from_model, kSemanticsOfPack);
  }
  for (std::size_t n = 0; n < view.posed.size(); ++n) {
    const PosedModel& posed = view.posed[n];
    use(posed.model, rigidTransform(posed.world_from_model),
        view.posed_semantics.empty() ? kSemanticsOfPack : view.posed_semantics[n]);
  }
  for (const AttachedModel& attached : view.attached) {
    use(attached.model, view.bodies[attached.body] * attached.body_from_model, kSemanticsOfPack);
  }
}

/// The edge of the panes along an edge of an image that is `pixels` long: the panes are as few as
/// possible, of similar size, and made of whole tiles.
[[nodiscard]] std::uint32_t paneEdge(std::uint32_t pixels) noexcept;

/// The panes of an image of `width` x `height` pixels, row by row; those at its right and lower
/// edges are cut off there.
[[nodiscard]] std::vector<PaneRectangle> cutIntoPanes(std::uint32_t width, std::uint32_t height);

/// The focal length: how many 1/256 pixels one meter across the camera's axis covers at a distance
/// of 1 m.
[[nodiscard]] float focalLength(const RenderOptions& options, const RenderCamera& camera) noexcept;

/// Whether a camera sees anything: its numbers are finite and its field of view within range.
[[nodiscard]] bool canSee(const RenderCamera& camera) noexcept;

}  // namespace galactic::render
