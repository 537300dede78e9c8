#include "column_grid/scatter/scatter.h"

#include "column_grid/column_strip.h"

namespace galactic::bake {

void spillInto(ColumnStrip& strip, std::uint32_t row, std::uint32_t column, float lo, float hi) {
  strip.spill(row, column, lo, hi);
}

ScatterFunctions fastestScatter() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return {.narrow = scatterAvx2, .wide = scatterAvx512};
  if (__builtin_cpu_supports("avx2")) return {.narrow = scatterAvx2, .wide = scatterAvx2};
#endif
  return {};
}

}  // namespace galactic::bake
