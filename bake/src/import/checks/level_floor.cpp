#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>

#include "common/vec3d.h"
#include "import/affine.h"
#include "import/asset_extents.h"
#include "import/checks/asset_check.h"

namespace galactic::bake {
namespace {

/// Area by height. Floors are wide levels; if a wall is mistaken for a floor, only some of it faces
/// up at any one level.
class Levels {
 public:
  void add(double height, double area) { areas_[std::floor(height / kBin)] += area; }

  /// The area of the widest level in square meters. Sums two adjacent bins, as a floor may lie
  /// across their boundary.
  [[nodiscard]] double widest() const {
    double most = 0;
    for (auto at = areas_.begin(); at != areas_.end(); ++at) {
      const auto next = std::next(at);
      const bool is_beside = next != areas_.end() && next->first == at->first + 1;
      most = std::max(most, at->second + (is_beside ? next->second : 0));
    }
    return most;
  }

 private:
  /// Meters. Floors of scans are not flat, and rugs and thresholds are not levels of their own.
  static constexpr double kBin = 0.1;

  std::map<double, double> areas_;
};

Vec3d pointOf(const Affine& world_from_mesh, const Vec3& p) {
  const std::array<double, 3> at = transformed(world_from_mesh, p);
  return {at[0], at[1], at[2]};
}

/// The levels of an asset along two of its axes.
struct AxisLevels {
  Levels along_y;
  Levels along_z;
};

AxisLevels levelsOf(const SourceAsset& asset) {
  // Cosine of the largest tilt of a floor: 18 degrees, because scans are bumpy.
  constexpr double kLevel = 0.95;
  AxisLevels levels;
  for (const SourceInstance& instance : asset.instances) {
    const SourceMesh& mesh = asset.meshes[instance.mesh];
    const double side = determinant(instance.world_from_mesh) < 0 ? -1 : 1;
    for (const Triangle& triangle : mesh.triangles) {
      const Vec3d a = pointOf(instance.world_from_mesh, mesh.positions[triangle[0]]);
      const Vec3d b = pointOf(instance.world_from_mesh, mesh.positions[triangle[1]]);
      const Vec3d c = pointOf(instance.world_from_mesh, mesh.positions[triangle[2]]);
      const Vec3d across = cross(b - a, c - a) * side;
      const double length = norm(across);
      if (across.y > kLevel * length) levels.along_y.add((a.y + b.y + c.y) / 3, length / 2);
      if (across.z > kLevel * length) levels.along_z.add((a.z + b.z + c.z) / 3, length / 2);
    }
  }
  return levels;
}

}  // namespace

void warnAboutUp(SourceAsset& asset) {
  // Square meters: anything smaller is a door, not a room.
  constexpr double kLeastFloor = 3;
  // In an upright scene a wall may well be wider than the floor, but it is seldom wider by half,
  // and seldom in a room that would be lower on its side.
  constexpr double kClearlyMore = 1.5;
  if (!std::string_view(asset.format).starts_with("glTF")) return;
  const std::array<double, 3> size = extentsOf(asset);
  if (size[1] <= size[2]) return;
  const AxisLevels levels = levelsOf(asset);
  const double upright = levels.along_y.widest();
  const double turned = levels.along_z.widest();
  if (turned < kLeastFloor || turned < kClearlyMore * upright) return;
  asset.warnings.push_back(fmt::format(
      "the scene seems to lie on its side: its widest level has {:.3g} m2, and would have {:.3g} "
      "m2 with the file's Z axis up, as the scans of Matterport3D and HM3D have it; give `up` z, "
      "or `up` y if it is right",
      upright, turned));
}

}  // namespace galactic::bake
