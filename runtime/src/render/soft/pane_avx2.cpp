// Compiled for AVX2, so it instantiates no library templates; see column_grid_avx2.cpp.
#include "render/soft/pane.h"

#if !defined(__AVX2__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
#include "render/raster/lanes_eight.inl"
#include "render/soft/pane_kernel.inl"

namespace galactic::render {

PaneCounts drawPaneAvx2(const PaneTask& task, const PaneScratch& scratch) noexcept {
  return drawPane(task, scratch);
}

}  // namespace galactic::render
