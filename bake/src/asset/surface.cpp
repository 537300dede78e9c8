#include <algorithm>
#include <cmath>
#include <vector>

#include "common/srgb.h"
#include "galactic/bake/triangle_mesh.h"
#include "import/affine.h"

namespace galactic::bake {
namespace {

/// The color of parts without one in a surface that has colors.
constexpr std::array<float, 4> kNeutral{0.6F, 0.6F, 0.6F, 1.0F};

std::uint32_t byteOf(double value) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

std::array<float, 4> product(const std::array<float, 4>& a, const std::array<float, 4>& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]};
}

}  // namespace

std::uint32_t surfaceColor(const std::array<float, 4>& linear) {
  std::uint32_t color = byteOf(static_cast<double>(linear[3])) << 24U;
  for (std::size_t n = 0; n < 3; ++n) {
    color |= byteOf(srgbEncoded(static_cast<double>(linear[n]))) << (8 * n);
  }
  return color;
}

Surface surfaceOf(const SourceAsset& asset, const Affine& frame_from_asset,
                  const std::array<float, 4>* color) {
  Surface surface;
  for (const SourceInstance& instance : asset.instances) {
    const SourceMesh& mesh = asset.meshes[instance.mesh];
    const Affine frame_from_mesh = compose(frame_from_asset, instance.world_from_mesh);
    const bool mirrors = determinant(frame_from_mesh) < 0;
    const auto first = static_cast<std::uint32_t>(surface.positions.size());
    const std::array<float, 4> material = mesh.material < asset.materials.size()
                                              ? asset.materials[mesh.material].base_color
                                              : kNeutral;
    for (std::size_t n = 0; n < mesh.positions.size(); ++n) {
      const auto p = transformed(frame_from_mesh, mesh.positions[n]);
      surface.positions.push_back(
          {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
      if (color != nullptr) {
        surface.colors.push_back(surfaceColor(*color));
      } else {
        surface.colors.push_back(
            surfaceColor(mesh.colors.empty() ? material : product(material, mesh.colors[n])));
      }
    }
    for (const Triangle& triangle : mesh.triangles) {
      Triangle placed{first + triangle[0], first + triangle[1], first + triangle[2]};
      if (mirrors) std::swap(placed[1], placed[2]);
      surface.triangles.push_back(placed);
    }
  }
  return surface;
}

void append(Surface& surface, const Surface& part) {
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  if (!part.colors.empty()) surface.colors.resize(surface.positions.size(), surfaceColor(kNeutral));
  surface.positions.insert(surface.positions.end(), part.positions.begin(), part.positions.end());
  surface.colors.insert(surface.colors.end(), part.colors.begin(), part.colors.end());
  const bool colored = !surface.colors.empty();
  if (colored) surface.colors.resize(surface.positions.size(), surfaceColor(kNeutral));
  for (const Triangle& triangle : part.triangles) {
    surface.triangles.push_back({first + triangle[0], first + triangle[1], first + triangle[2]});
  }
}

}  // namespace galactic::bake
