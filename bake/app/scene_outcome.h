#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "bake_run.h"
#include "galactic/bake/scene_baker.h"

namespace galactic::bake {

/// What became of one scene.
struct SceneOutcome {
  std::filesystem::path input;
  std::filesystem::path output;
  /// How axes and unit were read.
  std::string convention;
  BakedScene scene;
  StageTimes times;
  /// Size of the pack; 0 for a dry run.
  std::uint64_t pack_bytes = 0;
};

/// Prints what was baked: triangles, a line per grid, warnings, seconds per stage.
void printSceneTable(const SceneOutcome& outcome, Verbosity verbosity);

/// The scene's entry of the report.
[[nodiscard]] Json sceneReport(const SceneOutcome& outcome);

}  // namespace galactic::bake
