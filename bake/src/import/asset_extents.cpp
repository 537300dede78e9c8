#include "import/asset_extents.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "import/affine.h"

namespace galactic::bake {

std::array<double, 3> extentsOf(const SourceAsset& asset) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> high{-kInfinity, -kInfinity, -kInfinity};
  for (const SourceInstance& instance : asset.instances) {
    const SourceMesh& mesh = asset.meshes[instance.mesh];
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t vertex : triangle) {
        const auto p = transformed(instance.world_from_mesh, mesh.positions[vertex]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          low[axis] = std::min(low[axis], p[axis]);
          high[axis] = std::max(high[axis], p[axis]);
        }
      }
    }
  }
  return {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
}

}  // namespace galactic::bake
