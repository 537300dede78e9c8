#pragma once
#include "galactic/shapes.h"
#include "layout/render_mesh_builder.h"

namespace galactic::views {

// Closed shapes seen from outside, in colors that show their form: balls as if light
// came from above, boxes with a shade for each direction.

/// About the origin, of 320 triangles with corners on the sphere; meters. `color`: RGBA, R lowest.
[[nodiscard]] RenderSurface sphereSurface(float radius, std::uint32_t color);

[[nodiscard]] RenderSurface boxSurface(const OrientedBox& box, std::uint32_t color);

/// The twelve edges of the box as beams around them.
[[nodiscard]] RenderSurface boxFrameSurface(const OrientedBox& box, std::uint32_t color);

/// Half the thickness of the beams, meters.
inline constexpr float kBeamHalfThickness = 0.004F;

}  // namespace galactic::views
