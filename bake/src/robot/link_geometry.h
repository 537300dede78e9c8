#pragma once
#include <vector>

#include "galactic/bake/source_robot.h"
#include "galactic/bake/surface.h"

namespace galactic::bake {

/// No point of a tessellated cylinder or sphere is further than this from the shape. Metres.
inline constexpr double kTessellationError = 1e-4;

/// The shapes of one link as one coloured surface in the link's frame. Boxes are exact; cylinders
/// and spheres are tessellated to within kTessellationError (beyond a radius of 0.6 m: to 256 steps
/// around), with vertices on the shape.
[[nodiscard]] Surface surfaceOfShapes(const SourceRobot& robot,
                                      const std::vector<LinkShape>& shapes);

}  // namespace galactic::bake
