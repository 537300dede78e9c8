#include "render/render_engine.h"

#include <cmath>
#include <numbers>

#include "render/raster/pane_task.h"

namespace galactic::render {

bool canSee(const RenderCamera& camera) noexcept {
  const RigidTransform& t = camera.world_from_camera;
  for (const Vec3& v : {t.x_axis, t.y_axis, t.z_axis, t.origin}) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
  }
  return camera.vertical_fov > 0 && camera.vertical_fov < std::numbers::pi_v<float>;
}

float focalLength(const RenderOptions& options, const RenderCamera& camera) noexcept {
  const double half_height = 0.5 * static_cast<double>(options.height);
  const double slope = std::tan(0.5 * static_cast<double>(camera.vertical_fov));
  return static_cast<float>(half_height * kSubpixels / slope);
}

}  // namespace galactic::render
