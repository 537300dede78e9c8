#pragma once
#include <span>
#include <string>

#include "galactic/error.h"
#include "view/page_assets.h"
#include "view/run_track.h"

namespace galactic {

/// The first episode of an env as an animated scene for other programs (glTF 2.0, GLB): the render
/// meshes of scene, robot and objects, links as nodes under their parents, the robot's camera, and
/// keys of kStepsPerSecond for what moves. It ends with the state before the step that ends the
/// episode. `assets`: those of the track's world that have something to draw. Fails with the errors
/// of GlbFile and RenderGlbWriter.
[[nodiscard]] Result<std::string> animationGlb(const RunTrack& track, std::size_t env,
                                               std::span<const PageAsset> assets);

}  // namespace galactic
