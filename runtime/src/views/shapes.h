#pragma once
#include "galactic/shapes.h"
#include "layout/render_mesh_builder.h"

namespace galactic::views {

// Closed shapes, to be seen from outside, with colors that show their form: balls as if lit from
// above, boxes with a shade for each direction.

/// A ball around the origin, made of 320 triangles with their corners on the sphere; meters.
/// `color`: RGBA, R lowest.
[[nodiscard]] RenderSurface sphereSurface(float radius, std::uint32_t color);

[[nodiscard]] RenderSurface boxSurface(const OrientedBox& box, std::uint32_t color);

/// Beams along the twelve edges of the box.
[[nodiscard]] RenderSurface boxFrameSurface(const OrientedBox& box, std::uint32_t color);

/// Half the thickness of the beams, meters.
inline constexpr float kBeamHalfThickness = 0.004F;

}  // namespace galactic::views
