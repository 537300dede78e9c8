#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "bake_world.h"
#include "command.h"
#include "followers.h"
#include "galactic/bake/robot_recipe.h"
#include "outputs.h"
#include "support/console/prepare_program.h"
#include "support/console/standard_streams.h"
#include "support/exception_error.h"
#include "support/files/output_files.h"
#include "support/try.h"
#include "terminal.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Checks that all files can be written, before a bake that may take hours. Makes the folders of
/// the packs.
Result<void> tryOutputs(const BakeCommand& command, const std::vector<fs::path>& packs) {
  for (const fs::path& pack : packs) {
    if (command.run.dry_run) break;
    RETURN_IF_ERROR(makeFolders(pack.parent_path()));
    RETURN_IF_ERROR(tryFile(pack));
  }
  return tryReport(command);
}

/// Makes the packs of single files. Returns the exit code.
int bakeFiles(const BakeCommand& command) {
  const auto jobs = packsOf(command);
  if (!jobs) return refuse(jobs.error());
  OutputPacks packs;
  for (const PackJob& job : *jobs) packs.named.push_back(job.output);
  if (auto checked = checkOutputs(command, *jobs, packs); !checked) return refuse(checked.error());
  if (auto tried = tryOutputs(command, packs.named); !tried) return refuse(tried.error());
  FileFollower follower(command, *jobs);
  BakeLibraries libraries;
  const BuildOutcome outcome = build(*jobs,
                                     {.threads = command.run.threads,
                                      .keep_going = command.run.keep_going,
                                      .dry_run = command.run.dry_run},
                                     follower, libraries);
  return endWith(command, outcome, reportOf(*jobs, outcome), exitCodeOf(outcome));
}

int printSceneNames(const BakeCommand& command, DatasetJobs dataset) {
  for (const fs::path& input : command.inputs) {
    dataset.input = input;
    const auto names = sceneNames(dataset);
    if (!names) return refuse(names.error());
    for (const std::string& name : *names) fmt::print("{}\n", name);
  }
  return kExitOk;
}

int printRecipeDraft(const BakeCommand& command) {
  auto job = std::get<RobotJob>(std::get<Job>(command.what));
  job.input = command.inputs.front();
  // A draft lists links and joints, so missing meshes do not matter.
  job.allow_missing = true;
  const auto robot = readRobotFile(job);
  if (!robot) return refuse(robot.error());
  fmt::print("{}", draftRobotRecipe(*robot));
  return kExitOk;
}

int bakeCommand(const BakeCommand& command) {
  if (command.prints_recipe) return printRecipeDraft(command);
  const auto* dataset = std::get_if<DatasetCommand>(&command.what);
  if (dataset != nullptr && dataset->list) return printSceneNames(command, dataset->jobs);
  return command.makesWorld() ? bakeWorld(command) : bakeFiles(command);
}

int run(int argc, const char* const* argv) {
  const ParsedCommand parsed = parseCommandLine(argc, argv);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  return bakeCommand(std::get<BakeCommand>(parsed));
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  namespace bake = galactic::bake;
  galactic::prepareProgram();
  try {
    return galactic::flushStandardOutput("galactic-bake", bake::run(argc, argv));
  } catch (...) {
    return bake::refuse(galactic::errorOfException());
  }
}
