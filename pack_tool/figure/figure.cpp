#include "pack_tool/figure/figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace galactic::pack_tool {

namespace {

void include(FigureBounds& bounds, const Vec3& point, float radius = 0) {
  bounds.min = {std::min(bounds.min.x, point.x - radius), std::min(bounds.min.y, point.y - radius),
                std::min(bounds.min.z, point.z - radius)};
  bounds.max = {std::max(bounds.max.x, point.x + radius), std::max(bounds.max.y, point.y + radius),
                std::max(bounds.max.z, point.z + radius)};
}

}  // namespace

FigureBounds boundsOf(const Figure& figure) {
  constexpr float kFar = std::numeric_limits<float>::max();
  FigureBounds bounds{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const FigurePart& part : figure.parts) {
    const Pose& pose = part.world_from_part;
    // Vertices that no triangle uses are not seen.
    for (const std::uint32_t corner : part.surface.corners) {
      include(bounds, pose * part.surface.positions[corner]);
    }
    if (part.surface.empty() && part.render_model) {
      for (const Vec3& corner : renderBoxOf(figure, part)) include(bounds, corner);
    }
    for (const SetSphere& sphere : part.spheres) {
      include(bounds, pose * sphere.center, figure.radii[sphere.radius_index]);
    }
    if (!part.box) continue;
    for (const Vec3& corner : cornersOf(*part.box)) include(bounds, pose * corner);
  }
  return bounds;
}

std::array<Vec3, 8> renderBoxOf(const Figure& figure, const FigurePart& part) {
  const RenderModel& model = figure.render_meshes->models[*part.render_model];
  const Vec3 half = (model.bounds_max - model.bounds_min) * 0.5F;
  std::array<Vec3, 8> corners = cornersOf({{model.bounds_min + half, {}}, half});
  for (Vec3& corner : corners) corner = part.world_from_part * corner;
  return corners;
}

std::array<Vec3, 8> cornersOf(const OrientedBox& box) {
  std::array<Vec3, 8> corners;
  for (unsigned n = 0; n < corners.size(); ++n) {
    const Vec3& half = box.half_extents;
    corners[n] = box.pose * Vec3{(n & 1U) != 0 ? half.x : -half.x, (n & 2U) != 0 ? half.y : -half.y,
                                 (n & 4U) != 0 ? half.z : -half.z};
  }
  return corners;
}

std::array<Vec3, 4> viewPyramid(const CameraMark& camera, float length) {
  // Wide angles would make a pyramid without end.
  constexpr float kWidest = 2.6F;
  const float half = length * std::tan(0.5F * std::min(camera.vertical_fov, kWidest));
  return {
      {{length, half, -half}, {length, half, half}, {length, -half, half}, {length, -half, -half}}};
}

}  // namespace galactic::pack_tool
