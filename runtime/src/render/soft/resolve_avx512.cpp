// Compiled for AVX-512: instantiates no library templates, see column_grid_avx2.cpp.
#include "render/soft/pane.h"

#if defined(__AVX512F__)
// Each builds on those before it.
// clang-format off
#include "render/raster/lanes_sixteen.inl"
#include "render/raster/sample.inl"
#include "render/soft/pane_state.inl"
#include "render/soft/resolve.inl"
// clang-format on

namespace galactic::render {

void resolveAvx512(const PaneTask& task, const PaneScratch& scratch) noexcept {
  resolve(newPane(task, scratch));
}

}  // namespace galactic::render
#endif
