#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake_run.h"
#include "galactic/bake/render_baker.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/source_asset.h"
#include "galactic/bake/source_robot.h"

namespace galactic::bake {

/// Render meshes of one asset, or none where the user wants none.
using OptionalMeshes = std::optional<BakedRenderMeshes>;

/// Whose render meshes are made, from which file, and on how many threads.
struct RenderTask {
  const BakeCommand& command;
  const std::filesystem::path& input;
  unsigned jobs = 1;
};

/// Bakes what is drawn and adds its warnings. Errors name the input.
[[nodiscard]] Result<OptionalMeshes> renderScene(const SourceAsset& scene, const RenderTask& task,
                                                 std::vector<std::string>& warnings);
[[nodiscard]] Result<OptionalMeshes> renderObject(const SourceAsset& object, const RenderTask& task,
                                                  std::vector<std::string>& warnings);
/// `baked`: the robot in whose start pose links are lit, and to which warnings are added.
[[nodiscard]] Result<OptionalMeshes> renderRobot(const SourceRobot& robot, const RenderTask& task,
                                                 BakedRobot& baked);

/// Two lines: triangles, clusters and bytes before and after; textures. Nothing where there is
/// none.
void printRenderMeshes(const OptionalMeshes& meshes);
/// The same of many assets together.
void printRenderMeshes(const RenderBakeStatistics& figures, std::size_t textures);
[[nodiscard]] Json renderReport(const BakedRenderMeshes& meshes);

}  // namespace galactic::bake
