#pragma once
#include <filesystem>

#include "galactic/bake/render_baker.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/source_robot.h"
#include "galactic/error.h"

namespace galactic::bake {

// The input of the render bake for a scene, an object and a robot. `folder` holds the textures that
// the materials name; `threads` and `library` are those of bakeMaterials. The asset or robot must
// outlive the result. All fail like bakeMaterials.

/// One part, with a semantic id for each node name. All names beyond 65,535 share one id.
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

/// A part for each link that is drawn (drawnShapes), in the link's frame, with its meshes, their
/// materials, and primitives. Each link has its own semantic id. Primitives get the color of the
/// robot's file, and so do meshes that have no look of their own (no named material, texture or
/// vertex colors) or whose look the file overrides (LinkShape::hides_looks).
[[nodiscard]] Result<RenderSource> robotRenderSource(const SourceRobot& robot,
                                                     const std::filesystem::path& folder,
                                                     const TextureBakeOptions& options,
                                                     unsigned threads = 1,
                                                     TextureLibrary* library = nullptr);

/// Places each link for lighting as in the robot's start pose. `kinematics` belong to the robot
/// that `source` was made from.
void standInStartPose(RenderSource& source, const FlatKinematics& kinematics);

}  // namespace galactic::bake
