#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/render_engine.h"
#include "render/soft/pane_memory.h"
#include "render/soft/soft_scene.h"
#include "support/threads/workers.h"

namespace galactic::render {

/// Draws on the processor. Images are cut into panes, which the threads take one by one.
class SoftEngine final : public RenderEngine {
 public:
  /// `draw`: a kernel that this processor can run.
  SoftEngine(const RenderLibrary& library, const RenderOptions& options, DrawPane draw);

  void begin(std::span<const RenderView> views, const RenderTargets& targets) override;
  void end() override;
  [[nodiscard]] Result<DeviceImages> renderToDevice(std::span<const RenderView> views,
                                                    std::uintptr_t stream) override;
  [[nodiscard]] RenderBackend backend() const override { return RenderBackend::kSoft; }
  [[nodiscard]] std::string description() const override;
  [[nodiscard]] RenderStatistics statistics() const override { return statistics_; }

 private:
  /// Draws panes until none is left.
  void drawPanes(PaneMemory& memory) noexcept;
  void drawOne(PaneMemory& memory, std::size_t view, const PaneRectangle& pane) noexcept;
  std::uint32_t placeModels(const RenderView& view, PlacedModel* placed) const noexcept;

  RenderOptions options_;
  DrawPane draw_;
  SoftScene scene_;
  std::vector<PaneRectangle> panes_;
  std::vector<std::unique_ptr<PaneMemory>> memories_;
  RenderStatistics statistics_;

  /// The batch that is being drawn.
  std::span<const RenderView> views_;
  RenderTargets targets_;
  std::atomic<std::size_t> next_{0};

  /// Comes last, so that its threads end before the members that they use.
  std::unique_ptr<detail::Workers> workers_;
};

}  // namespace galactic::render
