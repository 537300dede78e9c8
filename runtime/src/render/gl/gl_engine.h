#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>

#include "render/gl/cuda_mapping.h"
#include "render/gl/egl_context.h"
#include "render/gl/gl_renderer.h"
#include "render/render_engine.h"

namespace galactic::render::gl {

/// The `gl` backend: a context, what is loaded on it, and the slices that are being drawn.
class GlEngine final : public RenderEngine {
 public:
  /// Like makeGlEngine(), with the settings that only tests and benchmarks choose.
  [[nodiscard]] static Result<std::unique_ptr<GlEngine>> make(const RenderLibrary& library,
                                                              const RenderOptions& options,
                                                              const GlTuning& tuning,
                                                              const LibraryLoads& loads);
  GlEngine(EglContext context, std::unique_ptr<GlRenderer> renderer)
      : context_(std::move(context)), renderer_(std::move(renderer)) {}
  ~GlEngine() override;
  GlEngine(const GlEngine&) = delete;
  GlEngine& operator=(const GlEngine&) = delete;

  void begin(std::span<const RenderView> views, const RenderTargets& targets) override;
  void end() override;
  [[nodiscard]] Result<DeviceImages> renderToDevice(std::span<const RenderView> views,
                                                    std::uintptr_t stream) override;
  /// The first part of renderToDevice(): draws into renderer().deviceImages(), and waits.
  [[nodiscard]] Result<ImageLayout> drawToDevice(std::span<const RenderView> views);
  [[nodiscard]] const EglContext& context() const { return context_; }
  [[nodiscard]] const GlRenderer& renderer() const { return *renderer_; }
  [[nodiscard]] RenderBackend backend() const override { return RenderBackend::kGl; }
  [[nodiscard]] std::string description() const override;
  [[nodiscard]] RenderStatistics statistics() const override { return renderer_->statistics(); }
  [[nodiscard]] const GlTimings& timings() const { return renderer_->timings(); }

 private:
  /// Starts slices until no view waits or no slice is idle.
  void submitNext();
  /// Waits for all slices that are being drawn.
  void finishSlices();

  EglContext context_;
  std::unique_ptr<GlRenderer> renderer_;
  std::unique_ptr<CudaMapping> cuda_ = std::make_unique<CudaMapping>();
  /// Two, so that one is drawn while the other is read.
  std::array<ViewSlice, 2> slices_;
  std::span<const RenderView> views_;
  RenderTargets targets_;
  std::size_t submitted_views_ = 0;
  std::size_t submitted_slices_ = 0;
  std::size_t collected_slices_ = 0;
};

}  // namespace galactic::render::gl
