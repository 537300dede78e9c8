#include "bake_inputs.h"

#include <utility>

#include "episode_job.h"
#include "object_job.h"
#include "robot_job.h"
#include "scene_job.h"
#include "world_job.h"

namespace galactic::bake {
namespace {

Result<Json> bakeFile(const std::filesystem::path& input, BakeRun& run) {
  if (run.command().kind == AssetKind::kRobot) return bakeRobotFile(input, run);
  if (run.command().kind == AssetKind::kEpisodes) return importEpisodeFile(input, run);
  return bakeSceneFile(input, run);
}

/// One pack of all inputs.
Result<Json> bakeTogether(BakeRun& run) {
  return run.command().kind == AssetKind::kWorld ? linkWorldPack(run) : generateEpisodePack(run);
}

}  // namespace

void bakeInputs(BakeRun& run) {
  const auto keep = [&run](const std::filesystem::path& input, Result<Json> entry) {
    if (entry) return run.succeed(std::move(*entry));
    run.fail(input, entry.error());
  };
  if (run.command().kind == AssetKind::kObject) return bakeObjectFiles(run);
  if (run.command().makesOnePack()) return keep(run.command().inputs.front(), bakeTogether(run));
  for (const std::filesystem::path& input : run.command().inputs) {
    if (!run.goesOn()) return;
    keep(input, bakeFile(input, run));
  }
}

}  // namespace galactic::bake
