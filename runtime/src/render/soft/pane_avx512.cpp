// Compiled for AVX-512: instantiates no library templates, see column_grid_avx2.cpp. Vectors have
// eight lanes, as elsewhere; those of sixteen are in resolve_avx512.cpp.
#include "render/soft/pane.h"

#if !defined(__AVX2__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif
#include "render/soft/pane_kernel.inl"

namespace galactic::render {

PaneCounts drawPaneAvx512(const PaneTask& task, const PaneScratch& scratch) noexcept {
#if defined(__AVX512F__)
  return drawPane(task, scratch, resolveAvx512);
#else
  // hasAvx512() is false on this architecture; the symbol exists so that callers need no condition.
  return drawPane(task, scratch);
#endif
}

}  // namespace galactic::render
