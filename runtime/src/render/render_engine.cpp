#include "render/render_engine.h"

#include <cmath>
#include <numbers>

namespace galactic::render {

bool canSee(const RenderCamera& camera) noexcept {
  const RigidTransform& t = camera.world_from_camera;
  for (const Vec3& v : {t.x_axis, t.y_axis, t.z_axis, t.origin}) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
  }
  return camera.vertical_fov > 0 && camera.vertical_fov < std::numbers::pi_v<float>;
}

}  // namespace galactic::render
