#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "command.h"
#include "followers.h"
#include "galactic/bake/robot_recipe.h"
#include "report.h"
#include "support/exception_error.h"
#include "support/output_files.h"
#include "support/standard_streams.h"
#include "support/try.h"
#include "terminal.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

/// What the command and its jobs name: whatever else they read is known when they have.
ReadLog namedFiles(const BakeCommand& command, const JobList& list) {
  ReadLog named;
  for (const fs::path& input : command.inputs) named.noteRead(input);
  named.noteRead(command.config);
  for (const PackJob& pack : list.assets) {
    for (const fs::path& file : filesOf(pack.job)) named.noteRead(file);
  }
  return named;
}

/// The packs that `out` stands for: the world, or one for each input or for all.
std::vector<fs::path> packsOfOut(const JobList& list) {
  if (list.world) return {list.world->output};
  std::vector<fs::path> packs;
  for (const PackJob& pack : list.assets) packs.push_back(pack.output);
  return packs;
}

/// Whatever name it goes by, the report is none of the packs, those in a world's folder among them.
Result<void> checkReport(const fs::path& report, const JobList& list) {
  if (report.empty()) return {};
  std::vector<fs::path> packs = packsOfOut(list);
  for (const PackJob& pack : list.assets) packs.push_back(pack.output);
  if (list.episodes) packs.push_back(list.episodes->output);
  const auto is_report = [&](const fs::path& pack) { return isSameFile(pack, report); };
  if (std::ranges::none_of(packs, is_report)) return {};
  return fail(ErrorCode::kInvalidInput, report.string(),
              "is also a pack that is written; give `report` another name");
}

/// Two outputs must not be one file, none may replace an input or the options' file, and a pack's
/// name says that it is one.
Result<void> checkOutputs(const BakeCommand& command, const JobList& list) {
  const ReadLog named = namedFiles(command, list);
  std::set<fs::path> outputs;
  RETURN_IF_ERROR(named.checkNotRead(command.run.report));
  RETURN_IF_ERROR(checkReport(command.run.report, list));
  for (const fs::path& pack : packsOfOut(list)) {
    RETURN_IF_ERROR(named.checkNotRead(pack));
    if (pack.extension() != ".pack") {
      return fail(ErrorCode::kInvalidInput, "out",
                  fmt::format("is \"{}\", expected NAME.pack, an existing folder or FOLDER/",
                              command.run.out.string()));
    }
    if (outputs.insert(pack.lexically_normal()).second) continue;
    return fail(ErrorCode::kInvalidInput, pack.string(),
                "would be written twice: two inputs have one name; use -o");
  }
  return {};
}

/// Where bakes that were done before are; none where nothing is remembered.
std::optional<fs::path> cacheOf(const BakeCommand& command, const JobList& list) {
  if (!list.world || command.many.no_cache) return std::nullopt;
  return command.many.cache.empty() ? list.folder / ".cache" : command.many.cache;
}

Result<void> tryCache(const fs::path& folder) {
  auto tried = makeFolders(folder);
  if (tried) tried = tryFile(folder / "entry");
  if (!tried) tried.error().message += "; give another `cache`";
  return tried;
}

/// A bake may take hours: files that cannot be written are found out before it. Makes the folders
/// of the packs and of the cache.
Result<void> tryOutputs(const BakeCommand& command, const JobList& list) {
  if (!command.run.dry_run) {
    const auto cache = cacheOf(command, list);
    // A cache elsewhere first: if it is refused, no empty folder of packs is left.
    const bool is_elsewhere = !command.many.cache.empty();
    if (cache && is_elsewhere) RETURN_IF_ERROR(tryCache(*cache));
    for (const fs::path& pack : packsOfOut(list)) {
      RETURN_IF_ERROR(makeFolders(list.world ? list.folder : pack.parent_path()));
      RETURN_IF_ERROR(tryFile(pack));
    }
    if (cache && !is_elsewhere) RETURN_IF_ERROR(tryCache(*cache));
  }
  return command.run.report.empty() ? Result<void>() : tryFile(command.run.report);
}

/// Three quarters of what the machine has.
std::uint64_t mostOfMemory() {
  const auto pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  const auto page_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return pages / 4 * 3 * page_bytes;
}

BuildOptions buildOptions(const BakeCommand& command, const JobList& list) {
  BuildOptions options{.jobs = command.run.jobs, .keep_going = command.run.keep_going};
  if (!list.world) {
    // One file after the other, each on all threads, as they are named.
    options.at_once = 1;
    options.mode = command.run.dry_run ? BuildMode::kTry : BuildMode::kBake;
    return options;
  }
  const ManyPacksOptions& many = command.many;
  options.mode = command.run.dry_run ? BuildMode::kList : BuildMode::kBake;
  options.shard = many.shard;
  options.memory = many.memory > 0 ? many.memory : mostOfMemory();
  options.cache = cacheOf(command, list);
  return options;
}

/// The packs that a build with these options makes.
std::size_t countOf(const JobList& list, const BuildOptions& options) {
  const Shard& shard = options.shard;
  const std::size_t assets =
      (list.assets.size() + shard.count - 1 - std::min(shard.index, list.assets.size())) /
      shard.count;
  return assets + list.broken.size() + (list.episodes && shard.count == 1 ? 1 : 0);
}

BuildOutcome buildAll(const BakeCommand& command, const JobList& list) {
  const BuildOptions options = buildOptions(command, list);
  std::unique_ptr<BuildObserver> follower;
  if (list.world) {
    follower = std::make_unique<WorldFollower>(command, countOf(list, options));
  } else {
    follower = std::make_unique<FileFollower>(command);
  }
  return build(list, options, *follower);
}

/// Writes the report, where one is wanted and nothing that was read would be lost.
Result<void> saveReport(const BakeCommand& command, const BuildOutcome& outcome,
                        const Json& report) {
  if (command.run.report.empty()) return {};
  for (const PackOutcome& pack : outcome.packs) {
    if (auto checked = pack.log.checkNotRead(command.run.report); !checked) return checked;
  }
  return writeReport(command.run.report, report);
}

int exitCodeOf(const BuildOutcome& outcome) {
  if (outcome.stopped) return kExitInterrupted;
  const Error* error = outcome.firstError();
  return error == nullptr ? kExitOk : static_cast<int>(error->code);
}

/// Of the packs that would be baked and of the scenes that would be left out.
std::vector<LeftOut> whatIsMissing(const JobList& list, unsigned threads) {
  std::vector<LeftOut> missing = findMissing(list, threads);
  missing.insert(missing.begin(), list.left_out.begin(), list.left_out.end());
  for (const BrokenScene& scene : list.broken) {
    const Error& error = scene.failure.error;
    missing.push_back({scene.name, {error.text()}});
  }
  return missing;
}

/// What a dry run ends with, so that a script knows before it bakes.
Error incomplete(const JobList& list, const std::vector<LeftOut>& missing) {
  const LeftOut& first = missing.front();
  return {ErrorCode::kInvalidInput, list.world->output.string(),
          fmt::format("something is missing in {} of {}: {}: {}; add it, or bake without it",
                      missing.size(), list.assets.size() + list.left_out.size(), first.name,
                      first.reasons.front())};
}

int bakeList(const BakeCommand& command, const JobList& list, Clock::time_point start) {
  const bool looks_only = list.world && command.run.dry_run;
  // Found before anything was begun.
  if (!list.broken.empty() && !command.run.keep_going && !looks_only) {
    return refuse(list.broken.front().failure.error);
  }
  if (auto checked = checkOutputs(command, list); !checked) return refuse(checked.error());
  if (auto tried = tryOutputs(command, list); !tried) return refuse(tried.error());
  BuildOutcome outcome = buildAll(command, list);
  int exit_code = exitCodeOf(outcome);
  if (outcome.world && !outcome.world->isThere()) return exit_code;
  std::vector<LeftOut> missing;
  if (looks_only) missing = whatIsMissing(list, command.run.jobs);
  // Reading recipe and dataset, and looking for what is missing, take longer than a small build.
  outcome.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (list.world && command.saysMore()) printWorldTable(list, outcome, command.run.verbosity);
  Json report = reportOf(list, outcome);
  if (looks_only) {
    if (command.saysMore()) printMissing(missing);
    report["missing"] = missingReport(missing);
    if (!missing.empty()) exit_code = refuse(incomplete(list, missing));
  }
  if (const auto written = saveReport(command, outcome, report); !written) {
    const int code = refuse(written.error());
    return exit_code == kExitOk ? code : exit_code;
  }
  return exit_code;
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
  // A draft is of links and joints, whether or not their meshes are there.
  job.allow_missing = true;
  const auto robot = readRobotFile(job);
  if (!robot) return refuse(robot.error());
  fmt::print("{}", draftRobotRecipe(*robot));
  return kExitOk;
}

int bakeCommand(const BakeCommand& command) {
  const auto start = Clock::now();
  if (command.prints_recipe) return printRecipeDraft(command);
  const auto* dataset = std::get_if<DatasetCommand>(&command.what);
  if (dataset != nullptr && dataset->list) return printSceneNames(command, dataset->jobs);
  const auto list = jobsOf(command);
  return list ? bakeList(command, *list, start) : refuse(list.error());
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
  galactic::prepareStandardStreams();
  try {
    return galactic::flushStandardOutput("galactic-bake", bake::run(argc, argv));
  } catch (...) {
    return bake::refuse(galactic::errorOfException());
  }
}
