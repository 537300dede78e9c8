#pragma once
#include "galactic/error.h"
#include "pack_tool/figure/figure.h"
#include "pictures/image.h"

namespace galactic::pictures {

/// Draws the render meshes of a scene: from above, cut open like a floor plan (see floorPlanCut),
/// from between front, side and top, and twice from inside, at the height of a standing person's
/// eyes, where most of the room is seen. Between front, side and top, what lies in the uppermost
/// fifth is left out, and level faces above 60 % of the height. `scene` has one part, with a render
/// model. `view_size` as of drawFigure. Fails as BatchRenderer::create.
[[nodiscard]] Result<Image> drawScene(const pack_tool::Figure& scene, int view_size);

}  // namespace galactic::pictures
