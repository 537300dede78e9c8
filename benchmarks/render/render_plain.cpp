#include "render_plain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace galactic {
namespace {

constexpr float kNear = 0.05F;

struct Corner {
  float x = 0;
  float y = 0;
  /// 1 / w.
  float z = 0;
  float u = 0;
  float v = 0;
};

struct PlainImage {
  std::uint32_t edge;
  float focal;
  std::span<std::uint8_t> color;
  std::span<float> depth;
};

/// What the triangles of a cluster are drawn with.
struct Surface {
  std::uint32_t color;
  const RenderTexture* texture;
};

std::uint32_t texelAt(const RenderTexture& texture, int x, int y) {
  const std::uint32_t mask = texture.size - 1;
  const std::size_t at = std::size_t{static_cast<std::uint32_t>(y) & mask} * texture.size +
                         (static_cast<std::uint32_t>(x) & mask);
  std::uint32_t texel = 0;
  std::memcpy(&texel, texture.texels.data() + 4 * at, 4);
  return texel;
}

std::uint32_t sample(const RenderTexture& texture, float u, float v) {
  const float x = u * static_cast<float>(texture.size) - 0.5F;
  const float y = v * static_cast<float>(texture.size) - 0.5F;
  const int left = static_cast<int>(std::floor(x));
  const int top = static_cast<int>(std::floor(y));
  const float right_share = x - static_cast<float>(left);
  const float lower_share = y - static_cast<float>(top);
  const std::array<std::uint32_t, 4> texels = {
      texelAt(texture, left, top), texelAt(texture, left + 1, top), texelAt(texture, left, top + 1),
      texelAt(texture, left + 1, top + 1)};
  const std::array<float, 4> weights = {(1 - right_share) * (1 - lower_share),
                                        right_share * (1 - lower_share),
                                        (1 - right_share) * lower_share, right_share * lower_share};
  std::uint32_t result = 0xFF000000U;
  for (std::uint32_t shift = 0; shift < 24; shift += 8) {
    float sum = 0.5F;
    for (std::size_t n = 0; n < 4; ++n) {
      sum += weights[n] * static_cast<float>((texels[n] >> shift) & 0xFFU);
    }
    result |= static_cast<std::uint32_t>(sum) << shift;
  }
  return result;
}

float edgeFunction(const Corner& a, const Corner& b, float x, float y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

void drawTriangle(const PlainImage& image, const std::array<Corner, 3>& c, const Surface& surface) {
  const float area = edgeFunction(c[0], c[1], c[2].x, c[2].y);
  if (!(area > 0)) return;
  const auto [x_low, x_high] = std::minmax({c[0].x, c[1].x, c[2].x});
  const auto [y_low, y_high] = std::minmax({c[0].y, c[1].y, c[2].y});
  const auto last = static_cast<float>(image.edge - 1);
  const int first_x = static_cast<int>(std::clamp(x_low, 0.0F, last));
  const int last_x = static_cast<int>(std::clamp(x_high, 0.0F, last));
  const int first_y = static_cast<int>(std::clamp(y_low, 0.0F, last));
  const int last_y = static_cast<int>(std::clamp(y_high, 0.0F, last));
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const float px = static_cast<float>(x) + 0.5F;
      const float py = static_cast<float>(y) + 0.5F;
      const float a = edgeFunction(c[1], c[2], px, py) / area;
      const float b = edgeFunction(c[2], c[0], px, py) / area;
      const float rest = edgeFunction(c[0], c[1], px, py) / area;
      if (a < 0 || b < 0 || rest < 0) continue;
      const float z = a * c[0].z + b * c[1].z + rest * c[2].z;
      const auto at = static_cast<std::size_t>(y) * image.edge + static_cast<std::size_t>(x);
      if (z <= image.depth[at]) continue;
      image.depth[at] = z;
      std::uint32_t color = surface.color;
      if (surface.texture != nullptr) {
        const auto share = [&](float Corner::*field) {
          return (a * c[0].*field * c[0].z + b * c[1].*field * c[1].z +
                  rest * c[2].*field * c[2].z) /
                 z;
        };
        color = sample(*surface.texture, share(&Corner::u), share(&Corner::v));
      }
      std::memcpy(image.color.data() + 4 * at, &color, 4);
    }
  }
}

/// Corner `number` of a cluster; false when it lies behind the near plane.
bool place(const PlainImage& image, const RenderMeshes& meshes, const RenderCluster& cluster,
           std::size_t number, const RigidTransform& camera_from_lattice, Corner& corner) {
  const std::size_t at = cluster.first_vertex + number;
  const std::uint16_t* block =
      meshes.vertices.data() + at / kRenderLanes * kVertexRows * kRenderLanes + at % kRenderLanes;
  const auto on_lattice = [&](std::size_t row, std::int32_t origin) {
    return static_cast<float>(origin + block[row * kRenderLanes]);
  };
  const Vec3 p =
      camera_from_lattice * Vec3{on_lattice(0, cluster.origin_x), on_lattice(1, cluster.origin_y),
                                 on_lattice(2, cluster.origin_z)};
  if (p.x < kNear) return false;
  corner.z = 1 / p.x;
  const float middle = static_cast<float>(image.edge) / 2;
  corner.x = middle + image.focal * p.z * corner.z;
  corner.y = middle - image.focal * p.y * corner.z;
  corner.u = cluster.u_minimum + cluster.u_step * static_cast<float>(block[3 * kRenderLanes]);
  corner.v = cluster.v_minimum + cluster.v_step * static_cast<float>(block[4 * kRenderLanes]);
  return true;
}

void drawCluster(const PlainImage& image, const RenderMeshes& meshes, const RenderCluster& cluster,
                 const RigidTransform& camera_from_lattice) {
  const RenderMaterial& material = meshes.materials[cluster.material];
  Surface surface{material.color, nullptr};
  if (material.texture >= 0) {
    surface.texture = &meshes.textures[static_cast<std::size_t>(material.texture)];
  }
  for (std::size_t t = 0; t < cluster.triangle_count; ++t) {
    const std::size_t at = cluster.first_triangle + t;
    const std::uint8_t* block = meshes.triangles.data() +
                                at / kRenderLanes * kTriangleRows * kRenderLanes +
                                at % kRenderLanes;
    std::array<Corner, 3> corners;
    if (place(image, meshes, cluster, block[0], camera_from_lattice, corners[0]) &&
        place(image, meshes, cluster, block[2 * kRenderLanes], camera_from_lattice, corners[1]) &&
        place(image, meshes, cluster, block[kRenderLanes], camera_from_lattice, corners[2])) {
      drawTriangle(image, corners, surface);
    }
  }
}

}  // namespace

void drawPlainly(const RenderLibrary& library, const RenderView& view, std::uint32_t edge,
                 std::span<std::uint8_t> color, std::span<float> depth) {
  const float focal = 0.5F * static_cast<float>(edge) / std::tan(view.camera.vertical_fov / 2);
  const PlainImage image{edge, focal, color, depth};
  std::ranges::fill(color, std::uint8_t{0});
  std::ranges::fill(depth, 0.0F);
  const RigidTransform camera_from_world = inverse(view.camera.world_from_camera);
  for (const RenderInstance& instance : view.instances) {
    const RenderModel& model = library.model(instance.model);
    const RenderMeshes& meshes = library.packs()[library.entry(instance.model).pack];
    RigidTransform placed = camera_from_world * instance.world_from_model;
    placed.x_axis = placed.x_axis * model.step;
    placed.y_axis = placed.y_axis * model.step;
    placed.z_axis = placed.z_axis * model.step;
    for (std::uint32_t n = 0; n < model.cluster_count; ++n) {
      drawCluster(image, meshes, meshes.clusters[model.first_cluster + n], placed);
    }
  }
  for (float& z : depth) z = z > 0 ? 1 / z : 0;
}

}  // namespace galactic
