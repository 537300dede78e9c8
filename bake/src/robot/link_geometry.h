#pragma once
#include <array>
#include <vector>

#include "galactic/bake/source_robot.h"
#include "galactic/bake/surface.h"

namespace galactic::bake {

/// No point of a tessellated cylinder or sphere is further than this from the shape. Meters.
inline constexpr double kTessellationError = 1e-4;

/// What a link without a color of its own looks like, linear RGBA.
inline constexpr std::array<float, 4> kPlainColor{0.55F, 0.55F, 0.57F, 1.0F};

/// A box, cylinder or sphere as a surface in the link's frame; empty for a mesh.
[[nodiscard]] Surface surfaceOfPrimitive(const LinkShape& shape);

/// The shapes of one link as one colored surface in the link's frame. Boxes are exact; cylinders
/// and spheres are tessellated to within kTessellationError (beyond a radius of 0.6 m: to 256 steps
/// around), with vertices on the shape.
[[nodiscard]] Surface surfaceOfShapes(const SourceRobot& robot,
                                      const std::vector<LinkShape>& shapes);

}  // namespace galactic::bake
