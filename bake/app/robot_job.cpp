#include "robot_job.h"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string_view>

#include "galactic/bake/collection_import.h"
#include "galactic/bake/robot_baker.h"
#include "galactic/bake/robot_pack.h"
#include "galactic/bake/robot_recipe.h"
#include "galactic/bake/source_file.h"
#include "galactic/bake/urdf_import.h"
#include "render_job.h"
#include "robot_outcome.h"

namespace galactic::bake {
namespace {

/// The folders of ROS_PACKAGE_PATH, separated by colons.
std::vector<std::filesystem::path> rosPackagePath() {
  std::vector<std::filesystem::path> folders;
  const char* text = std::getenv("ROS_PACKAGE_PATH");
  std::string_view rest = text == nullptr ? "" : text;
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    if (colon != 0) folders.emplace_back(rest.substr(0, colon));
    rest.remove_prefix(colon == std::string_view::npos ? rest.size() : colon + 1);
  }
  return folders;
}

void append(const std::vector<std::string>& more, std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

/// The recipe of the command, from TOML or a published collection; its warnings go to the robot.
Result<std::optional<RobotRecipe>> readRecipe(const std::filesystem::path& path,
                                              SourceRobot& robot) {
  if (path.empty()) return std::nullopt;
  if (path.extension() != ".json") return readRobotRecipe(path);
  const auto collection = readCollection(path);
  if (!collection) return tl::unexpected(collection.error());
  auto converted = recipeFromCollection(*collection, robot);
  if (!converted) return tl::unexpected(converted.error());
  append(collection->warnings, robot.warnings);
  append(converted->warnings, robot.warnings);
  return std::move(converted->recipe);
}

Result<SourceRobot> readRobot(const std::filesystem::path& input, const BakeCommand& command) {
  UrdfImportOptions import;
  import.allow_outside = command.allow_outside;
  import.packages = command.robot.packages;
  import.search_roots = rosPackagePath();
  import.allow_missing = command.robot.allow_missing;
  return importUrdf(input, import);
}

Result<std::optional<HandSpheres>> readSpheres(const std::filesystem::path& path,
                                               SourceRobot& robot) {
  if (path.empty()) return std::nullopt;
  auto spheres = path.extension() == ".srdf" ? readSrdfSpheres(path) : readSpherizedUrdf(path);
  if (!spheres) return tl::unexpected(spheres.error());
  append(spheres->warnings, robot.warnings);
  return std::move(*spheres);
}

Result<BakedRobot> bakeWith(const std::filesystem::path& input, const BakeCommand& command,
                            SourceRobot& robot) {
  auto recipe = readRecipe(command.robot.recipe, robot);
  if (!recipe) return tl::unexpected(recipe.error());
  auto spheres = readSpheres(command.robot.spheres, robot);
  if (!spheres) return tl::unexpected(spheres.error());
  RobotBakeOptions options;
  options.radii = command.object.spheres.radii;
  options.jobs = command.jobs;
  options.max_spheres = command.max_spheres;
  options.hand_spheres = std::move(*spheres);
  if (command.tolerances_given) {
    options.eps = command.object.spheres.eps;
    options.tau = command.object.spheres.tau;
  }
  auto baked = bakeRobot(robot, *recipe ? &**recipe : nullptr, options);
  if (!baked && !(*recipe && baked.error().where.starts_with((*recipe)->source))) {
    baked.error().where = inFile(input, baked.error().where);
  }
  return baked;
}

/// What a robot is made from besides the URDF and its meshes.
Result<void> addSources(const RobotOptions& options, std::vector<SourceFile>& files) {
  for (const std::filesystem::path& path : {options.recipe, options.spheres}) {
    if (path.empty()) continue;
    auto file = describeFile(path);
    if (!file) return tl::unexpected(file.error());
    files.push_back(std::move(*file));
  }
  return {};
}

}  // namespace

Result<Json> bakeRobotFile(const std::filesystem::path& input, BakeRun& run) {
  const BakeCommand& command = run.command();
  const auto start = std::chrono::steady_clock::now();
  RobotOutcome outcome;
  outcome.input = input;
  outcome.output = run.outputFor(input);
  const std::string item = input.filename().string();
  run.line().show(item, "import", 0);
  auto robot = readRobot(input, command);
  if (!robot) return tl::unexpected(robot.error());
  outcome.import_seconds = secondsSince(start);
  outcome.resolutions = robot->resolutions;
  run.noteRead(input.parent_path(), robot->files);
  if (auto checked = run.checkNotRead(outcome.output); !checked) {
    return tl::unexpected(checked.error());
  }
  run.line().show(item, "spheres", 0.3);
  auto baked = bakeWith(input, command, *robot);
  if (!baked) return tl::unexpected(baked.error());
  if (auto added = addSources(command.robot, robot->files); !added) {
    return tl::unexpected(added.error());
  }
  outcome.robot = std::move(*baked);
  run.line().show(item, "render meshes", 0.9);
  const auto render_start = std::chrono::steady_clock::now();
  auto meshes = renderRobot(*robot, {command, input, command.jobs}, outcome.robot);
  if (!meshes) return tl::unexpected(meshes.error());
  outcome.robot.render_meshes = std::move(*meshes);
  outcome.robot.times.render = secondsSince(render_start);
  if (!command.dry_run) {
    run.line().show(item, "write", 1);
    const auto bytes =
        writeRobotPack(outcome.output, outcome.robot,
                       provenanceOf(command, std::move(robot->files), outcome.robot.warnings));
    if (!bytes) return tl::unexpected(bytes.error());
    outcome.pack_bytes = *bytes;
  }
  outcome.seconds = secondsSince(start);
  run.line().clear();
  if (command.saysMore()) printRobotTable(outcome, command.verbosity);
  return robotReport(outcome);
}

Result<void> printRecipeDraft(const BakeCommand& command) {
  const auto robot = readRobot(command.inputs.front(), command);
  if (!robot) return tl::unexpected(robot.error());
  fmt::print("{}", draftRobotRecipe(*robot));
  return {};
}

}  // namespace galactic::bake
