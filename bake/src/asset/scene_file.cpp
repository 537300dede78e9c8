#include <utility>

#include "asset/asset_parts.h"
#include "asset/scene_source.h"
#include "galactic/bake/packs.h"
#include "support/threads/stopwatch.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

Result<BakedScene> bakeParts(const ReadScene& read, const SceneJob& job, const Progress& progress,
                             StageTimes& times, const BakeContext& context) {
  auto scene = bakeScene(read.asset, job.grids, times, progress, context.threads);
  if (!scene) {
    scene.error().where = inFile(read.input, scene.error().where);
    return scene;
  }
  progress("render meshes", 0.9);
  const detail::Stopwatch timer(times.render);
  ASSIGN_OR_RETURN(auto meshes, drawScene(read, job.draw, *scene, context));
  scene->render_meshes = std::move(meshes);
  return scene;
}

}  // namespace

Result<BakedPack> bakeSceneFile(const SceneJob& job, BakeContext& context) {
  const std::string item = job.instance ? job.instance->name : job.input.filename().string();
  const auto progress = [&](std::string_view stage, double fraction) {
    context.show(item, stage, fraction);
  };
  progress("import", 0);
  SceneOutcome outcome;
  auto read = [&] {
    const detail::Stopwatch timer(outcome.times.import);
    return readScene(job, context.log, context.libraries);
  }();
  if (!read) return tl::unexpected(read.error());
  outcome.input = read->input;
  outcome.convention = read->asset.convention;
  if (!job.name.empty()) read->asset.name = job.name;
  RETURN_IF_ERROR(context.log.checkNotRead(context.output));
  ASSIGN_OR_RETURN(auto scene, bakeParts(*read, job, progress, outcome.times, context));
  outcome.scene = std::move(scene);
  if (outcome.scene.render_meshes) {
    RETURN_IF_ERROR(shareTextures(outcome.scene.render_meshes->materials, job.draw, context));
  }
  BakedPack made{.outcome = {}, .output = context.output};
  if (!context.dry_run) {
    progress("write", 1);
    const detail::Stopwatch timer(outcome.times.write);
    ASSIGN_OR_RETURN(const auto bytes,
                     writeScenePack(context.output, outcome.scene,
                                    provenanceOf(job, std::move(read->asset.read.files),
                                                 outcome.scene.warnings)));
    made.pack_bytes = bytes;
  }
  made.outcome = std::move(outcome);
  return made;
}

}  // namespace galactic::bake
