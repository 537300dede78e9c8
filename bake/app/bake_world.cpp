#include "bake_world.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "followers.h"
#include "outputs.h"
#include "support/files/output_files.h"
#include "support/threads/stopwatch.h"
#include "support/try.h"
#include "terminal.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

Result<void> checkOutputs(const BakeCommand& command, const WorldPlan& plan) {
  OutputPacks packs{.named = {plan.world.output}};
  for (const PackJob& pack : plan.assets) packs.inside.push_back(pack.output);
  if (plan.episodes) packs.inside.push_back(plan.episodes->output);
  return checkOutputs(command, plan.assets, packs);
}

/// The folder of the cache; none if the command wants no cache.
std::optional<fs::path> cacheOf(const BakeCommand& command, const WorldPlan& plan) {
  if (command.many.no_cache) return std::nullopt;
  return command.many.cache.empty() ? plan.folder / ".cache" : command.many.cache;
}

Result<void> tryCache(const fs::path& folder) {
  auto tried = makeFolders(folder);
  if (tried) tried = tryFile(folder / "entry");
  if (!tried) tried.error().message += "; give another `cache`";
  return tried;
}

/// Checks that all files can be written, before a bake that may take hours. Makes the folders of
/// the packs and of the cache.
Result<void> tryOutputs(const BakeCommand& command, const WorldPlan& plan) {
  const auto cache = cacheOf(command, plan);
  // Tries a cache elsewhere first, so that no empty folder of packs is left if it is refused.
  const bool is_elsewhere = !command.many.cache.empty();
  if (cache && is_elsewhere) RETURN_IF_ERROR(tryCache(*cache));
  RETURN_IF_ERROR(makeFolders(plan.folder));
  RETURN_IF_ERROR(tryFile(plan.world.output));
  if (cache && !is_elsewhere) RETURN_IF_ERROR(tryCache(*cache));
  return tryReport(command);
}

/// Three quarters of the machine's memory, in bytes.
std::uint64_t mostOfMemory() {
  const auto pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  const auto page_bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return pages / 4 * 3 * page_bytes;
}

BuildOutcome buildPlanned(const BakeCommand& command, const WorldPlan& plan,
                          BakeLibraries& libraries) {
  const ManyPacksOptions& many = command.many;
  const WorldBuildOptions options{.threads = command.run.threads,
                                  .keep_going = command.run.keep_going,
                                  .cache = cacheOf(command, plan),
                                  .shard = many.shard,
                                  .memory = many.memory > 0 ? many.memory : mostOfMemory()};
  const BuildOutcome planned = plannedOutcome(plan, many.shard);
  WorldFollower follower(command, planned.packs.size() - planned.count(PackState::kElsewhere));
  return build(plan, options, follower, libraries);
}

/// What is missing for the packs that would be baked and for the scenes that would be left out.
std::vector<LeftOut> whatIsMissing(const WorldPlan& plan, unsigned threads,
                                   BakeLibraries& libraries) {
  std::vector<LeftOut> missing = findMissing(plan, threads, libraries);
  missing.insert(missing.begin(), plan.left_out.begin(), plan.left_out.end());
  for (const BrokenScene& scene : plan.broken) {
    const Error& error = scene.failure.error;
    missing.push_back({scene.name, {error.text()}});
  }
  return missing;
}

/// The error that ends an incomplete dry run, so that a script notices before it bakes.
Error incomplete(const WorldPlan& plan, const std::vector<LeftOut>& missing) {
  const LeftOut& first = missing.front();
  return {ErrorCode::kInvalidInput, plan.world.output.string(),
          fmt::format("something is missing in {} of {}: {}: {}; add it, or bake without it",
                      missing.size(), plan.assets.size() + plan.left_out.size(), first.name,
                      first.reasons.front())};
}

/// Makes the world. `seconds`: how long planning took.
int buildWorld(const BakeCommand& command, const WorldPlan& plan, BakeLibraries& libraries,
               double seconds) {
  // These errors were found before anything was baked.
  if (!plan.broken.empty() && !command.run.keep_going) {
    return refuse(plan.broken.front().failure.error);
  }
  if (auto checked = checkOutputs(command, plan); !checked) return refuse(checked.error());
  if (auto tried = tryOutputs(command, plan); !tried) return refuse(tried.error());
  BuildOutcome outcome = buildPlanned(command, plan, libraries);
  if (outcome.world && !outcome.world->isThere()) {
    printFailures(*outcome.world);
    return exitCodeOf(outcome);
  }
  outcome.seconds += seconds;
  if (command.saysMore()) {
    printWorldTable(plan, outcome, command.run.verbosity);
    if (outcome.stopped) {
      fmt::print("stopped; the same command {}\n", cacheOf(command, plan)
                                                       ? "goes on from here"
                                                       : "begins anew, as there is no cache");
    }
  }
  return endWith(command, outcome, reportOf(plan, outcome), exitCodeOf(outcome));
}

/// Prints what would be made, and what is missing for it.
int listWorld(const BakeCommand& command, const WorldPlan& plan, BakeLibraries& libraries,
              double seconds) {
  if (auto checked = checkOutputs(command, plan); !checked) return refuse(checked.error());
  if (auto tried = tryReport(command); !tried) return refuse(tried.error());
  BuildOutcome outcome = plannedOutcome(plan, command.many.shard);
  for (const PackOutcome& pack : outcome.packs) printFailures(pack);
  std::vector<LeftOut> missing;
  {
    const detail::Stopwatch timer(outcome.seconds);
    missing = whatIsMissing(plan, command.run.threads, libraries);
  }
  outcome.seconds += seconds;
  if (command.saysMore()) {
    printWorldTable(plan, outcome, command.run.verbosity);
    printMissing(missing);
  }
  Json report = reportOf(plan, outcome);
  report["missing"] = missingReport(missing);
  const int exit_code = missing.empty() ? kExitOk : refuse(incomplete(plan, missing));
  return endWith(command, outcome, report, exit_code);
}

}  // namespace

int bakeWorld(const BakeCommand& command) {
  // Timed, because reading recipe and dataset takes longer than a small build.
  double seconds = 0;
  BakeLibraries libraries;
  const auto plan = [&] {
    const detail::Stopwatch timer(seconds);
    return planOf(command, libraries);
  }();
  if (!plan) return refuse(plan.error());
  return command.run.dry_run ? listWorld(command, *plan, libraries, seconds)
                             : buildWorld(command, *plan, libraries, seconds);
}

}  // namespace galactic::bake
