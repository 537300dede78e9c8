// galactic-run: opens and verifies packs, describes their contents, measures queries, and steps
// worlds.
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line/options.h"
#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/scene.h"
#include "inspect/query_benchmark.h"
#include "inspect/summary.h"
#include "run/learned_run.h"
#include "run/recording.h"
#include "run/run_report.h"
#include "run/simulate.h"
#include "support/console/prepare_program.h"
#include "support/console/standard_streams.h"
#include "support/exception_error.h"
#include "support/files/atomic_file.h"
#include "support/text/printable.h"

namespace {

using galactic::Error;
using galactic::ErrorCode;
using galactic::OpenedPolicy;
using galactic::OpenedWorld;
using galactic::RecordingReader;
using galactic::Result;
using galactic::RunOptions;
using galactic::RunSource;

int report(const Error& error) {
  galactic::printToStderr(fmt::format("galactic-run: {}: {}\n", galactic::printable(error.where),
                                      galactic::printable(error.message)));
  return static_cast<int>(error.code);
}

/// Opens one pack and prints its summary. Mapping and verifying are timed separately.
Result<galactic::PackFile> openAndDescribe(const std::string& path, const RunOptions& options) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  galactic::OpenTimes times;
  const auto start = Clock::now();
  Result<galactic::PackFile> pack = galactic::PackFile::open(path, galactic::Trust::kTrusted);
  times.map = Seconds(Clock::now() - start).count();
  if (!pack) return pack;
  if (!options.trusted) {
    const auto mapped = Clock::now();
    const auto verified = galactic::PackFile::view(pack->bytes(), path);
    times.verify = Seconds(Clock::now() - mapped).count();
    if (!verified) return tl::unexpected<Error>(verified.error());
  }
  if (!options.is_quiet) fmt::print("{}", galactic::summarize(*pack, times));
  return pack;
}

int describePacks(const RunOptions& options) {
  std::vector<galactic::PackFile> packs;
  std::vector<galactic::SceneGrids> scenes;
  for (const std::string& path : options.packs) {
    Result<galactic::PackFile> pack = openAndDescribe(path, options);
    if (!pack) return report(pack.error());
    if (const auto scene = galactic::Scene::from(*pack)) scenes.push_back(scene->grids());
    packs.push_back(std::move(*pack));
  }
  if (!options.is_quiet) fmt::print("galactic-pack info FILE says what is in a pack.\n");
  if (options.bench && scenes.empty()) {
    return report({ErrorCode::kInvalidInput, "--bench",
                   "found no pack of a scene, whose grids are measured; name one, or one of those "
                   "that a world lists (galactic-pack info WORLD)"});
  }
  if (options.bench) {
    const auto seed = static_cast<std::uint32_t>(options.simulation.seed);
    fmt::print("{}", galactic::runQueryBenchmark(scenes, seed));
  }
  return galactic::kExitOk;
}

Result<void> saveReport(const galactic::RunReport& run) {
  if (run.options.report.empty()) return {};
  return galactic::writeFileAtomically(run.options.report, galactic::jsonOf(run));
}

int simulateWorld(const RunOptions& options, const OpenedWorld& world, const RunSource& source) {
  if (!options.without_effect.empty()) return galactic::refuseCommandLine(options.without_effect);
  const Result<galactic::RunReport> run = galactic::simulate(options, world, source);
  if (!run) return report(run.error());
  // Save first, because printing fails if the terminal is gone.
  const Result<void> saved = saveReport(*run);
  if (!options.is_quiet) fmt::print("{}", galactic::tableOf(*run));
  if (run->fault) return report(*run->fault);
  if (!saved) return report(saved.error());
  if (run->is_interrupted) return galactic::kExitInterrupted;
  if (!run->first_difference) return galactic::kExitOk;
  galactic::printToStderr(
      fmt::format("galactic-run: {}: step {} differs from the recording; "
                  "compare the versions of galactic-run and the processors\n",
                  galactic::printable(options.replayFile()), *run->first_difference));
  return galactic::kExitDiffers;
}

/// A replay takes its options from the recording, and typed options must not contradict them: so
/// the command line is parsed again on top of the recording's options.
int replayPacks(int argc, char** argv, const std::string& file) {
  Result<RecordingReader> recording = RecordingReader::open(file);
  if (!recording) return report(recording.error());
  RunOptions options;
  options.simulation = recording->subject().options;
  options.steps = recording->steps();
  if (const auto exit_code = galactic::parseCommandLine(argc, argv, options)) return *exit_code;
  if (const auto fits = galactic::checkReplay(*recording, options); !fits) {
    return report(fits.error());
  }
  const Result<OpenedWorld> world = galactic::openWorld(options);
  return world ? simulateWorld(options, *world, {.replay = &*recording}) : report(world.error());
}

/// The options of the task come from the world, then from a learned policy, and typed options
/// override both: so the command line is parsed again on top of them.
int simulatePacks(int argc, char** argv, const RunOptions& typed) {
  const Result<OpenedWorld> world = galactic::openWorld(typed);
  if (!world) return report(world.error());
  RunOptions options;
  options.simulation = world->world.withTask(options.simulation);
  std::optional<OpenedPolicy> policy;
  if (!typed.policyFile().empty()) {
    Result<OpenedPolicy> opened = galactic::openPolicy(typed);
    if (!opened) return report(opened.error());
    policy.emplace(std::move(*opened));
    if (const auto applied = galactic::applyNeeds(*policy, options.simulation); !applied) {
      return report(applied.error());
    }
  }
  if (const auto exit_code = galactic::parseCommandLine(argc, argv, options)) return *exit_code;
  options.simulation.body_transforms |= policy && policy->needs.image;
  return simulateWorld(options, *world, {.policy = policy ? &*policy : nullptr});
}

int run(int argc, char** argv) {
  RunOptions options;
  if (const auto exit_code = galactic::parseCommandLine(argc, argv, options)) return *exit_code;
  if (!options.simulates) return describePacks(options);
  const std::string replayed = options.replayFile();
  return replayed.empty() ? simulatePacks(argc, argv, options) : replayPacks(argc, argv, replayed);
}

}  // namespace

int main(int argc, char** argv) {
  galactic::prepareProgram();
  try {
    return galactic::flushStandardOutput("galactic-run", run(argc, argv));
  } catch (...) {
    return report(galactic::errorOfException());
  }
}
