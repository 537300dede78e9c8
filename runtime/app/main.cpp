// galactic-run: opens packs, verifies them, says what is inside and measures queries.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/scene.h"
#include "query_benchmark.h"
#include "summary.h"

namespace {

using galactic::Error;
using galactic::ErrorCode;
using galactic::Result;

constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 command line, 2 input or output, 3 invalid input, 4 internal error,\n"
    "5 unsupported.";

struct Options {
  std::vector<std::string> packs;
  bool trusted = false;
  bool bench = false;
  std::uint32_t seed = 1;
};

int report(const Error& error) {
  fmt::print(stderr, "galactic-run: {}: {}\n", galactic::printable(error.where),
             galactic::printable(error.message));
  return static_cast<int>(error.code);
}

/// Reads the command line into `options`; returns an exit code when there is nothing more to do.
std::optional<int> parse(int argc, char** argv, Options& options) {
  CLI::App app{"Opens packs, verifies them and says what is inside.", "galactic-run"};
  app.footer(kExitCodes);
  app.set_version_flag("--version", "galactic-run " GALACTIC_VERSION);
  app.add_option("--pack", options.packs, "Pack to open; may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE");
  app.add_flag("--trusted", options.trusted,
               "Skip the verification of packs that this machine has verified before");
  app.add_flag("--bench", options.bench, "Measure queries on all grids of all packs");
  app.add_option("--seed", options.seed, "Seed of the benchmark's robots and places")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == 0;  // --help, --version
    if (asked) return app.exit(error);
    fmt::print(stderr, "galactic-run: command line: {}; see --help\n",
               galactic::printable(error.what()));
    return galactic::kExitUsage;
  }
  return std::nullopt;
}

/// Opens one pack and prints its summary. Mapping and verifying are timed apart.
Result<galactic::PackFile> openAndDescribe(const std::string& path, bool trusted) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  galactic::OpenTimes times;
  const auto start = Clock::now();
  Result<galactic::PackFile> pack = galactic::PackFile::open(path, galactic::Trust::kTrusted);
  times.map = Seconds(Clock::now() - start).count();
  if (!pack) return pack;
  if (!trusted) {
    const auto mapped = Clock::now();
    const auto verified = galactic::PackFile::view(pack->bytes(), path);
    times.verify = Seconds(Clock::now() - mapped).count();
    if (!verified) return tl::unexpected<Error>(verified.error());
  }
  fmt::print("{}", galactic::summarise(*pack, times));
  return pack;
}

int run(const Options& options) {
  std::vector<galactic::PackFile> packs;
  std::vector<galactic::SceneGrids> scenes;
  for (const std::string& path : options.packs) {
    Result<galactic::PackFile> pack = openAndDescribe(path, options.trusted);
    if (!pack) return report(pack.error());
    if (const auto scene = galactic::Scene::from(*pack)) scenes.push_back(scene->grids());
    packs.push_back(std::move(*pack));
  }
  if (options.bench && scenes.empty()) {
    return report({ErrorCode::kInvalidInput, "--bench",
                   "needs a pack of a scene to query; give one with --pack"});
  }
  if (options.bench) fmt::print("{}", galactic::runQueryBenchmark(scenes, options.seed));
  if (std::fflush(stdout) != 0) {
    return report({ErrorCode::kIo, "standard output", "cannot be written; free some space"});
  }
  return galactic::kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options;
    if (const std::optional<int> exit_code = parse(argc, argv, options)) return *exit_code;
    return run(options);
  } catch (const std::system_error& failure) {  // what printing throws
    return report({ErrorCode::kIo, "standard output", failure.what()});
  } catch (const std::exception& exception) {
    return report({ErrorCode::kInternal, "internal error", exception.what()});
  }
}
