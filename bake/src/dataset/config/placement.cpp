#include "dataset/config/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "import/affine.h"

namespace galactic::bake {
namespace {

using Triple = std::array<double, 3>;

Triple unit(const Triple& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Box {
  Triple low;
  Triple high;
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Box kNothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

void include(Box& box, const Triple& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(box.low[axis], point[axis]);
    box.high[axis] = std::max(box.high[axis], point[axis]);
  }
}

/// Around the vertices that triangles use.
Box boxOf(const SourceMesh& mesh) {
  Box box = kNothing;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      const Vec3& p = mesh.positions[corner];
      include(box, {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    }
  }
  return box;
}

void includePlaced(Box& box, const Box& mesh, const Affine& m) {
  for (unsigned corner = 0; corner < 8; ++corner) {
    const double x = (corner & 1U) != 0 ? mesh.high[0] : mesh.low[0];
    const double y = (corner & 2U) != 0 ? mesh.high[1] : mesh.low[1];
    const double z = (corner & 4U) != 0 ? mesh.high[2] : mesh.low[2];
    include(box, {m[0] * x + m[1] * y + m[2] * z + m[3], m[4] * x + m[5] * y + m[6] * z + m[7],
                  m[8] * x + m[9] * y + m[10] * z + m[11]});
  }
}

}  // namespace

Affine objectFromAsset(const TemplateAttributes& attributes, const Triple& instance_scale) {
  const Triple up = unit(attributes.up);
  const Triple right = unit(cross(attributes.front, up));
  // The front made exactly perpendicular.
  const Triple back = cross(right, up);
  const std::array<Triple, 3> rows{right, up, back};
  Affine affine{};
  for (std::size_t row = 0; row < 3; ++row) {
    const double scale = attributes.scale[row] * instance_scale[row];
    for (std::size_t column = 0; column < 3; ++column) {
      // Adding zero turns -0 into +0.
      affine[4 * row + column] = scale * rows[row][column] + 0.0;
    }
  }
  return affine;
}

Affine worldFromObject(const SceneItem& item) {
  const auto& [w, x, y, z] = item.rotation;
  const Triple& t = item.translation;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     t[0],
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     t[1],
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), t[2]};
}

Triple boxCenter(const SourceAsset& asset, const Affine& object_from_asset) {
  Box box = kNothing;
  for (const SourceInstance& instance : asset.instances) {
    const SourceMesh& mesh = asset.meshes[instance.mesh];
    if (mesh.triangles.empty()) continue;
    includePlaced(box, boxOf(mesh), compose(object_from_asset, instance.world_from_mesh));
  }
  Triple center{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box.low[axis] <= box.high[axis]) center[axis] = (box.low[axis] + box.high[axis]) / 2;
  }
  return center;
}

Affine translationBy(const Triple& offset) {
  return {1, 0, 0, offset[0], 0, 1, 0, offset[1], 0, 0, 1, offset[2]};
}

}  // namespace galactic::bake
