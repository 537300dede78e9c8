#pragma once
#include <filesystem>

#include "galactic/bake/render_baker.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"

namespace galactic::bake {

// What the render bake makes of a scene, an object and a robot. `folder` is where the textures are
// that the materials name; `threads` and `library` are those of bakeMaterials. The asset or robot
// has to outlive the result. Fail as bakeMaterials does.

/// One part; a semantic id per name of a node. Nodes beyond 65,535 names share one.
[[nodiscard]] Result<RenderSource> sceneRenderSource(const SourceAsset& scene,
                                                     const std::filesystem::path& folder,
                                                     const TextureBakeOptions& options,
                                                     unsigned threads = 1,
                                                     TextureLibrary* library = nullptr);

/// One part with one semantic id, named after the asset.
[[nodiscard]] Result<RenderSource> objectRenderSource(const SourceAsset& object,
                                                      const std::filesystem::path& folder,
                                                      const TextureBakeOptions& options,
                                                      unsigned threads = 1,
                                                      TextureLibrary* library = nullptr);

/// A part for each link that is drawn (drawnShapes), in the link's frame: meshes with their
/// materials, and primitives. A semantic id per link. The color of the robot's file is taken for
/// primitives and for meshes that have none of their own (neither named material nor texture nor
/// vertex colors) or whose looks it hides (LinkShape::hides_looks).
[[nodiscard]] Result<RenderSource> robotRenderSource(const SourceRobot& robot,
                                                     const std::filesystem::path& folder,
                                                     const TextureBakeOptions& options,
                                                     unsigned threads = 1,
                                                     TextureLibrary* library = nullptr);

/// Lights each link as it stands in the robot's start pose. `kinematics` are those of the robot
/// that `source` was made of.
void standInStartPose(RenderSource& source, const FlatKinematics& kinematics);

}  // namespace galactic::bake
