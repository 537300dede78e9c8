#include "scene_job.h"

#include <utility>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/scene_pack.h"
#include "render_job.h"
#include "scene_outcome.h"
#include "texture_job.h"

namespace galactic::bake {
namespace {

/// A scene that was read, ready to be baked.
struct ReadScene {
  /// For messages; names of textures are relative to its folder.
  std::filesystem::path input;
  /// What is shown on the progress line.
  std::string item;
  SourceAsset asset{};
  double import_seconds = 0;
};

Result<std::uint64_t> writePack(const SceneOutcome& outcome, std::vector<SourceFile> files,
                                const BakeRun& run) {
  if (run.command().dry_run) return 0;
  return writeScenePack(outcome.output, outcome.scene,
                        provenanceOf(run.command(), std::move(files), outcome.scene.warnings));
}

Result<Json> bakeRead(ReadScene read, BakeRun& run) {
  const BakeCommand& command = run.command();
  SceneOutcome outcome;
  outcome.input = read.input;
  outcome.output = run.outputFor(read.input);
  outcome.times.import = read.import_seconds;
  outcome.convention = read.asset.convention;
  if (!command.asset_name.empty()) read.asset.name = command.asset_name;
  run.noteRead(read.input.parent_path(), read.asset.files);
  if (auto checked = run.checkNotRead(outcome.output); !checked) {
    return tl::unexpected(checked.error());
  }
  auto scene = bakeScene(read.asset, command.scene, outcome.times,
                         [&](std::string_view stage, double fraction) {
                           run.line().show(read.item, stage, fraction);
                         });
  if (!scene) {
    // Errors of the geometry name no file: the bakers know none.
    if (scene.error().where.empty()) scene.error().where = read.input.string();
    return tl::unexpected(scene.error());
  }
  outcome.scene = std::move(*scene);
  run.line().show(read.item, "render meshes", 0.9);
  auto start = std::chrono::steady_clock::now();
  auto meshes =
      renderScene(read.asset, {command, read.input, command.jobs}, outcome.scene.warnings);
  if (!meshes) return tl::unexpected(meshes.error());
  outcome.scene.render_meshes = std::move(*meshes);
  if (outcome.scene.render_meshes) {
    auto shared = shareTextures(outcome.scene.render_meshes->materials, command);
    if (!shared) return tl::unexpected(shared.error());
  }
  outcome.times.render = secondsSince(start);
  run.line().show(read.item, "write", 1);
  start = std::chrono::steady_clock::now();
  const auto bytes = writePack(outcome, std::move(read.asset.files), run);
  if (!bytes) return tl::unexpected(bytes.error());
  outcome.times.write = secondsSince(start);
  outcome.pack_bytes = *bytes;
  run.line().clear();
  if (command.saysMore()) printSceneTable(outcome, command.verbosity);
  return sceneReport(outcome);
}

}  // namespace

Result<Json> bakeSceneFile(const std::filesystem::path& input, BakeRun& run) {
  ReadScene read{.input = input, .item = input.filename().string()};
  run.line().show(read.item, "import", 0);
  const auto start = std::chrono::steady_clock::now();
  auto asset = importMesh(input, run.command().import);
  if (!asset) return tl::unexpected(asset.error());
  read.asset = std::move(*asset);
  read.import_seconds = secondsSince(start);
  return bakeRead(std::move(read), run);
}

Result<Json> bakeInstancedScene(const InstancedScene& scene, BakeRun& run) {
  const std::filesystem::path& folder = scene.dataset->folder();
  const auto start = std::chrono::steady_clock::now();
  auto composed = scene.dataset->compose(scene.name, *scene.meshes);
  if (!composed) return tl::unexpected(composed.error());
  for (const std::string& file : composed->absent_files) run.noteAbsent(folder / file);
  std::vector<std::string>& warnings = composed->scene.warnings;
  warnings.insert(warnings.end(), composed->missing.begin(), composed->missing.end());
  ReadScene read{.input = folder / scene.name, .item = scene.name};
  read.asset = std::move(composed->scene);
  read.import_seconds = secondsSince(start);
  return bakeRead(std::move(read), run);
}

}  // namespace galactic::bake
