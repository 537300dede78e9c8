// Compiled for AVX-512, so it instantiates no library templates; see column_grid_avx2.cpp.
#include "render/soft/pane.h"

#if defined(__AVX512F__)
#include "render/raster/lanes_sixteen.inl"
#include "render/soft/pane_kernel.inl"
#endif

namespace galactic::render {

PaneCounts drawPaneAvx512(const PaneTask& task, const PaneScratch& scratch) noexcept {
#if defined(__AVX512F__)
  return drawPane(task, scratch);
#else
  // hasAvx512() is false on this architecture; the symbol exists so that callers need no condition.
  return drawPanePortable(task, scratch);
#endif
}

}  // namespace galactic::render
