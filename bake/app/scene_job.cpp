#include "scene_job.h"

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/scene_pack.h"
#include "render_job.h"
#include "scene_outcome.h"

namespace galactic::bake {

Result<Json> bakeSceneFile(const std::filesystem::path& input, BakeRun& run) {
  const BakeCommand& command = run.command();
  SceneOutcome outcome;
  outcome.input = input;
  outcome.output = run.outputFor(input);
  const std::string item = input.filename().string();
  run.line().show(item, "import", 0);
  auto start = std::chrono::steady_clock::now();
  auto asset = importMesh(input, command.import);
  if (!asset) return tl::unexpected(asset.error());
  outcome.times.import = secondsSince(start);
  outcome.convention = asset->convention;
  run.noteRead(input.parent_path(), asset->files);
  if (auto checked = run.checkNotRead(outcome.output); !checked) {
    return tl::unexpected(checked.error());
  }
  auto scene = bakeScene(
      *asset, command.scene, outcome.times,
      [&](std::string_view stage, double fraction) { run.line().show(item, stage, fraction); });
  if (!scene) {
    // Errors of the geometry name no file: the bakers know none.
    if (scene.error().where.empty()) scene.error().where = input.string();
    return tl::unexpected(scene.error());
  }
  outcome.scene = std::move(*scene);
  run.line().show(item, "render meshes", 0.9);
  start = std::chrono::steady_clock::now();
  auto meshes = renderScene(*asset, {command, input, command.jobs}, outcome.scene.warnings);
  if (!meshes) return tl::unexpected(meshes.error());
  outcome.scene.render_meshes = std::move(*meshes);
  outcome.times.render = secondsSince(start);
  if (!command.dry_run) {
    run.line().show(item, "write", 1);
    start = std::chrono::steady_clock::now();
    const auto bytes =
        writeScenePack(outcome.output, outcome.scene,
                       provenanceOf(command, std::move(asset->files), outcome.scene.warnings));
    if (!bytes) return tl::unexpected(bytes.error());
    outcome.times.write = secondsSince(start);
    outcome.pack_bytes = *bytes;
  }
  run.line().clear();
  if (command.verbosity != Verbosity::kQuiet) printSceneTable(outcome, command.verbosity);
  return sceneReport(outcome);
}

}  // namespace galactic::bake
