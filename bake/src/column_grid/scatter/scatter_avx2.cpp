#include "column_grid/scatter/scatter_kernel.h"

namespace galactic::bake {

void scatterAvx2(const ScatterTriangle& triangle, const ScatterBlock& block, float radius,
                 const ScatterTarget& target) {
  scatterBlock(triangle, block, radius, target);
}

}  // namespace galactic::bake
