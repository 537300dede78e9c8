#include "render/raster/lanes_eight.inl"
#include "render/soft/pane.h"
#include "render/soft/pane_kernel.inl"

namespace galactic::render {

PaneCounts drawPanePortable(const PaneTask& task, const PaneScratch& scratch) noexcept {
  return drawPane(task, scratch);
}

}  // namespace galactic::render
