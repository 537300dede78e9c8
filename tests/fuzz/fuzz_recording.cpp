// Any bytes as a recording. An even first byte: the rest is the file, which has to be refused or
// replayed. An odd one: the rest is the options of a recording, as its lines, then a zero byte,
// then actions. What they do to a small home is recorded, and the recording has to replay, step by
// step.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "command_line/option_lines.h"
#include "finding.h"
#include "input.h"
#include "run/recording.h"
#include "run/simulate.h"
#include "support/homes/small_home.h"

namespace {

using namespace galactic;
using test::expectGoodError;
using test::reportFinding;

/// More of anything takes the fuzzer's time and tells nothing new.
constexpr std::uint32_t kMostEnvs = 4;
constexpr std::uint32_t kMostBeams = 32;
constexpr std::uint32_t kMostAttempts = 16;
constexpr std::uint64_t kMostSteps = 64;

bool isSmall(const SimulationOptions& options) {
  return options.envs <= kMostEnvs && options.sensors.laser.beams <= kMostBeams &&
         std::max(options.slide.attempts, options.placement.attempts) <= kMostAttempts;
}

OpenedWorld openHome() {
  const test::ScratchFolder folder;
  RunOptions options;
  options.packs = {writeWorld(folder, test::smallHomeWorld()).string()};
  Result<OpenedWorld> opened = openWorld(options);
  if (!opened) reportFinding(opened.error().message);
  return std::move(*opened);
}

const OpenedWorld& home() {
  static const OpenedWorld opened = openHome();
  return opened;
}

void checkFinite(std::span<const float> values) {
  for (const float value : values) {
    if (!std::isfinite(value)) reportFinding("a simulation that returns no number");
  }
}

/// The file, opened and played as galactic-run does; whether all of its steps came out again.
Result<bool> replay(const std::filesystem::path& path) {
  Result<RecordingReader> recording = RecordingReader::open(path);
  if (!recording) return tl::unexpected(recording.error());
  RunOptions options;
  options.simulation = recording->subject().options;
  options.simulation.threads = 1;
  options.steps = recording->steps();
  if (!isSmall(options.simulation) || options.steps > kMostSteps) return true;
  if (auto fits = checkReplay(*recording, options); !fits) return tl::unexpected(fits.error());
  const Result<RunReport> report = simulate(options, home(), {.replay = &*recording});
  if (!report) return tl::unexpected(report.error());
  return !report->first_difference && report->steps == options.steps;
}

/// Whether the options allow a run of the small home, which is then recorded.
bool record(const SimulationOptions& options, test::Input actions,
            const std::filesystem::path& path) {
  auto simulator = BatchSimulator::create(home().world, options);
  if (!simulator) {
    expectGoodError(simulator.error());
    return false;
  }
  auto writer = RecordingWriter::create(
      path,
      {options, static_cast<std::uint32_t>(simulator->actionCount()), stampsOf(home().world)});
  if (!writer) reportFinding(writer.error().message);
  std::vector<float> row(simulator->envCount() * simulator->actionCount());
  for (std::uint64_t step = 0; step == 0 || (step < kMostSteps && !actions.isEmpty()); ++step) {
    std::ranges::generate(row, [&] { return actions.action(); });
    simulator->step(row);
    checkFinite(simulator->observations());
    checkFinite(simulator->rewards());
    if (auto written = writer->append(row, digestOf(*simulator)); !written) {
      reportFinding(written.error().message);
    }
  }
  if (auto finished = writer->finish(); !finished) reportFinding(finished.error().message);
  return true;
}

void recordAndReplay(std::string_view input, const std::filesystem::path& path) {
  const std::string_view lines = input.substr(0, input.find('\0'));
  auto options = parseOptionLines(lines, "lines");
  if (!options) return expectGoodError(options.error());
  if (!isSmall(*options)) return;
  options->threads = 1;
  const std::string_view left = input.substr(std::min(lines.size() + 1, input.size()));
  const test::Input actions({reinterpret_cast<const std::uint8_t*>(left.data()), left.size()});
  if (!record(*options, actions, path)) return;
  const auto same = replay(path);
  if (!same) reportFinding("a recording that is refused: " + same.error().message);
  if (!*same) reportFinding("a recording that replays otherwise");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const test::ScratchFolder folder;
  const std::string_view input(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 2 == 1) {
    recordAndReplay(input, folder.path() / "run.rec");
  } else if (const auto replayed = replay(folder.write("run.rec", input)); !replayed) {
    expectGoodError(replayed.error());
  }
  return 0;
}
