#include <optional>
#include <utility>

#include "asset/asset_parts.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/robot_recipe.h"
#include "recipe/collection_import.h"
#include "support/threads/stopwatch.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

void append(const std::vector<std::string>& more, std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

/// Reads a recipe from TOML or a published collection. The robot receives the warnings.
Result<std::optional<RobotRecipe>> readRecipe(const std::filesystem::path& path,
                                              SourceRobot& robot) {
  if (path.empty()) return std::nullopt;
  if (path.extension() != ".json") return readRobotRecipe(path);
  ASSIGN_OR_RETURN(const auto collection, readCollection(path));
  ASSIGN_OR_RETURN(auto converted, recipeFromCollection(collection, robot));
  append(collection.warnings, robot.warnings);
  append(converted.warnings, robot.warnings);
  return std::move(converted.recipe);
}

Result<std::optional<HandSpheres>> readSpheres(const std::filesystem::path& path,
                                               SourceRobot& robot) {
  if (path.empty()) return std::nullopt;
  ASSIGN_OR_RETURN(auto spheres,
                   path.extension() == ".srdf" ? readSrdfSpheres(path) : readSpherizedRobot(path));
  append(spheres.warnings, robot.warnings);
  return spheres;
}

Result<BakedRobot> bakeWithRecipe(const RobotJob& job, SourceRobot& robot, unsigned threads) {
  auto recipe = readRecipe(job.recipe, robot);
  if (!recipe) return tl::unexpected(recipe.error());
  ASSIGN_OR_RETURN(auto spheres, readSpheres(job.spheres, robot));
  RobotBakeOptions options = job.shape;
  options.hand_spheres = std::move(spheres);
  auto baked = bakeRobot(robot, *recipe ? &**recipe : nullptr, options, threads);
  if (!baked && !(*recipe && baked.error().where.starts_with((*recipe)->source))) {
    baked.error().where = inFile(job.input, baked.error().where);
  }
  return baked;
}

Result<BakedRobot> bakeParts(const RobotJob& job, SourceRobot& robot, const BakeContext& context) {
  const std::string item = job.input.filename().string();
  context.show(item, "spheres", 0.3);
  auto baked = bakeWithRecipe(job, robot, context.threads);
  if (!baked) return baked;
  context.show(item, "render meshes", 0.9);
  auto meshes = [&] {
    const detail::Stopwatch timer(baked->times.render);
    return drawRobot(robot, job.draw, job.input, *baked, context);
  }();
  if (!meshes) return tl::unexpected(meshes.error());
  baked->render_meshes = std::move(*meshes);
  return baked;
}

Result<BakedPack> makeRobotPack(const RobotJob& job, const BakeContext& context) {
  RobotOutcome outcome;
  const std::string item = job.input.filename().string();
  context.show(item, "import", 0);
  auto robot = [&] {
    const detail::Stopwatch timer(outcome.import_seconds);
    return readRobotFile(job);
  }();
  if (!robot) return tl::unexpected(robot.error());
  outcome.input = job.input;
  outcome.resolutions = robot->resolutions;
  context.log.note(job.input.parent_path(), robot->read);
  RETURN_IF_ERROR(context.log.checkNotRead(context.output));
  ASSIGN_OR_RETURN(auto baked, bakeParts(job, *robot, context));
  outcome.robot = std::move(baked);
  RETURN_IF_ERROR(addSources({job.recipe, job.spheres}, robot->read.files));
  BakedPack made{.outcome = {}, .output = context.output};
  if (!context.dry_run) {
    context.show(item, "write", 1);
    const detail::Stopwatch timer(outcome.write_seconds);
    ASSIGN_OR_RETURN(
        const auto bytes,
        writeRobotPack(context.output, outcome.robot,
                       provenanceOf(job, std::move(robot->read.files), outcome.robot.warnings)));
    made.pack_bytes = bytes;
  }
  made.outcome = std::move(outcome);
  return made;
}

}  // namespace

RobotImportOptions robotOptionsOf(const RobotJob& job) {
  RobotImportOptions import;
  import.allow_outside = job.allow_outside;
  import.packages = job.packages;
  import.search_roots = rosPackagePath();
  import.allow_missing = job.allow_missing;
  return import;
}

Result<SourceRobot> readRobotFile(const RobotJob& job) {
  return importRobot(job.input, robotOptionsOf(job));
}

Result<BakedPack> bakeRobotFile(const RobotJob& job, BakeContext& context) {
  return timed<RobotOutcome>([&] { return makeRobotPack(job, context); });
}

}  // namespace galactic::bake
