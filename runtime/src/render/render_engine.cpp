#include "render/render_engine.h"

#include <algorithm>
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

std::uint32_t paneEdge(std::uint32_t pixels) noexcept {
  const std::uint32_t count = (pixels + kPaneEdge - 1) / kPaneEdge;
  const std::uint32_t edge = (pixels + count - 1) / count;
  return (edge + kTileEdge - 1) / kTileEdge * kTileEdge;
}

std::vector<PaneRectangle> cutIntoPanes(std::uint32_t width, std::uint32_t height) {
  const std::uint32_t wide = paneEdge(width);
  const std::uint32_t high = paneEdge(height);
  std::vector<PaneRectangle> panes;
  for (std::uint32_t y = 0; y < height; y += high) {
    for (std::uint32_t x = 0; x < width; x += wide) {
      panes.push_back({x, y, std::min(wide, width - x), std::min(high, height - y)});
    }
  }
  return panes;
}

float focalLength(const RenderOptions& options, const RenderCamera& camera) noexcept {
  const double half_height = 0.5 * static_cast<double>(options.height);
  const double slope = std::tan(0.5 * static_cast<double>(camera.vertical_fov));
  return static_cast<float>(half_height * kSubpixels / slope);
}

}  // namespace galactic::render
