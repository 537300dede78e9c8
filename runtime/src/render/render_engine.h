#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_renderer.h"
#include "render/raster/pane_task.h"

namespace galactic::render {

/// One way to draw a batch: what BatchRenderer is made of.
class RenderEngine {
 public:
  RenderEngine() = default;
  virtual ~RenderEngine() = default;
  RenderEngine(const RenderEngine&) = delete;
  RenderEngine& operator=(const RenderEngine&) = delete;

  /// Starts to draw. The spans have the right sizes.
  virtual void begin(std::span<const RenderView> views, const RenderTargets& targets) = 0;
  /// Returns when the images are there.
  virtual void end() = 0;

  /// Draws, and leaves the images on a CUDA device: see BatchRenderer::renderToDevice(). Fails with
  /// kUnsupported where it cannot.
  [[nodiscard]] virtual Result<DeviceImages> renderToDevice(std::span<const RenderView> views,
                                                            std::uintptr_t stream) = 0;

  /// kSoft, kGl or kCuda.
  [[nodiscard]] virtual RenderBackend backend() const = 0;
  [[nodiscard]] virtual std::string description() const = 0;
  [[nodiscard]] virtual RenderStatistics statistics() const = 0;
};

/// `library` must outlive the engine; the options are within range.
[[nodiscard]] Result<std::unique_ptr<RenderEngine>> makeSoftEngine(const RenderLibrary& library,
                                                                   const RenderOptions& options);
[[nodiscard]] Result<std::unique_ptr<RenderEngine>> makeGlEngine(const RenderLibrary& library,
                                                                 const RenderOptions& options);
[[nodiscard]] Result<std::unique_ptr<RenderEngine>> makeCudaEngine(const RenderLibrary& library,
                                                                   const RenderOptions& options);
/// Whether the device that the `cuda` backend would take is one whose chip has few units that draw
/// triangles; false where there is none.
[[nodiscard]] bool isForDataCenters(const RenderOptions& options);
/// Draws a small scene with triangles of every kind on that device: fails with kInternal when the
/// images are not those of the `soft` backend, and as makeCudaEngine().
[[nodiscard]] Result<void> proveCuda(const RenderOptions& options);

[[nodiscard]] inline std::size_t modelCount(const RenderView& view) noexcept {
  return view.instances.size() + view.posed.size() + view.attached.size();
}

/// Calls use(model, world_from_model, semantic) for all that a view shows, in the order of drawing.
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

/// Edge of the panes that an image is cut in, of whose edge it is given: as few as possible, of
/// like size, of whole tiles.
[[nodiscard]] std::uint32_t paneEdge(std::uint32_t pixels) noexcept;

/// The panes of an image of `width` x `height` pixels, row after row; those at its right and lower
/// edges end there.
[[nodiscard]] std::vector<PaneRectangle> cutIntoPanes(std::uint32_t width, std::uint32_t height);

/// 1/256 pixels at a distance of 1 m for each meter beside the camera's axis.
[[nodiscard]] float focalLength(const RenderOptions& options, const RenderCamera& camera) noexcept;

/// Whether a camera sees anything: its numbers are finite and its field of view within range.
[[nodiscard]] bool canSee(const RenderCamera& camera) noexcept;

}  // namespace galactic::render
