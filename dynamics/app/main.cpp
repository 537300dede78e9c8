// galactic-dynamics: replays runs of the simulation where things have mass.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>
#include <span>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "command_line.h"
#include "dynamics/replay.h"
#include "dynamics/report.h"
#include "dynamics/sources.h"
#include "dynamics/trace.h"
#include "galactic/bake/assets.h"
#include "galactic/bake/parallel_for.h"
#include "run/recording.h"
#include "support/atomic_file.h"
#include "support/out_of_memory.h"
#include "support/printable.h"
#include "support/try.h"

namespace galactic::dynamics {
namespace {

int refuse(const Error& error) {
  fmt::print(stderr, "galactic-dynamics: {}: {}\n", printable(error.where),
             printable(error.message));
  return static_cast<int>(error.code);
}

/// How far it is, on a terminal.
class Progress {
 public:
  explicit Progress(std::size_t all) : all_(all), is_shown_(::isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (is_shown_) fmt::print(stderr, "\r\x1b[K");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;

  void add() {
    if (!is_shown_) return;
    const std::lock_guard lock(mutex_);
    fmt::print(stderr, "\rreplayed {} of {} episodes", ++done_, all_);
  }

 private:
  std::size_t all_;
  bool is_shown_;
  std::mutex mutex_;
  std::size_t done_ = 0;
};

std::vector<EpisodeReplay> replayAll(const std::vector<EpisodeTrace>& traces, const World& world,
                                     const SimulationOptions& simulation, const Sources& sources,
                                     const Command& command) {
  std::vector<EpisodeReplay> replays(traces.size());
  const unsigned threads =
      command.threads != 0 ? command.threads : std::max(1U, std::thread::hardware_concurrency());
  Progress progress(traces.size());
  bake::parallelFor(threads, traces.size(), [&](std::size_t n) {
    replays[n] = replay(traces[n], world, simulation, sources, command.world);
    progress.add();
  });
  return replays;
}

/// The report must not replace what is read.
Result<void> checkReport(const Command& command) {
  bake::ReadLog log;
  log.noteRead(command.recipe);
  log.noteRead(command.recording);
  for (const std::filesystem::path& pack : command.packs) log.noteRead(pack);
  return log.checkNotRead(command.report);
}

Result<void> run(const Command& command) {
  RETURN_IF_ERROR(checkReport(command));
  ASSIGN_OR_RETURN(auto recording, RecordingReader::open(command.recording));
  ASSIGN_OR_RETURN(const auto world, World::open(command.packs));
  ASSIGN_OR_RETURN(const auto traces, tracesOf(recording, world, command.episodes));
  if (traces.empty()) {
    return fail(ErrorCode::kInvalidInput, command.recording.string(),
                "finishes no episode, so there is nothing to replay; record more steps");
  }
  ASSIGN_OR_RETURN(const auto sources,
                   readSources({.recipe = command.recipe, .data = command.data}, world));
  for (const std::string& warning : sources.warnings) {
    fmt::print(stderr, "galactic-dynamics: warning: {}\n", printable(warning));
  }
  const auto replays = replayAll(traces, world, recording.subject().options, sources, command);
  fmt::print("{}", reportTable(replays, world));
  if (std::fflush(stdout) != 0) {
    return fail(ErrorCode::kIo, "standard output", "cannot be written; free some space");
  }
  if (command.report.empty()) return {};
  const std::string json = reportJson(replays, world,
                                      {.recording = command.recording.filename().string(),
                                       .arm = command.world.arm,
                                       .warnings = sources.warnings});
  return writeFileAtomically(command.report, {std::as_bytes(std::span(json))});
}

int start(int argc, const char* const* argv) {
  Command command;
  if (const auto code = parseCommandLine(argc, argv, command)) return *code;
  const Result<void> done = run(command);
  return done ? kExitOk : refuse(done.error());
}

}  // namespace
}  // namespace galactic::dynamics

int main(int argc, char** argv) {
  namespace dynamics = galactic::dynamics;
  try {
    return dynamics::start(argc, argv);
  } catch (const std::bad_alloc&) {
    return dynamics::refuse(galactic::outOfMemory());
  } catch (const std::length_error&) {  // a vector that no memory could hold
    return dynamics::refuse(galactic::outOfMemory());
  } catch (const std::system_error& error) {  // what printing throws
    if (galactic::isOutOfMemory(error)) return dynamics::refuse(galactic::outOfMemory());
    return dynamics::refuse({galactic::ErrorCode::kIo, "standard output", error.what()});
  } catch (const std::exception& error) {
    return dynamics::refuse({galactic::ErrorCode::kInternal, "internal error", error.what()});
  }
}
