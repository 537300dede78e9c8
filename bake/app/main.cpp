#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <set>
#include <stdexcept>
#include <system_error>

#include "bake_inputs.h"
#include "bake_run.h"
#include "galactic/out_of_memory.h"
#include "galactic/part_files.h"
#include "options.h"
#include "plan/bake_plan.h"
#include "report.h"
#include "report_check.h"
#include "robot_job.h"

namespace galactic::bake {
namespace {

/// What one pack each is made of: the first input stands for all that share one.
std::vector<std::filesystem::path> packInputs(const BakeCommand& command) {
  if (command.makesOnePack()) return {command.inputs.front()};
  return command.inputs;
}

/// Two outputs must not be one file, and none may replace an input or the options' file.
Result<void> checkOutputs(const BakeRun& run) {
  const BakeCommand& command = run.command();
  std::set<std::filesystem::path> outputs;
  if (!command.report.empty()) outputs.insert(command.report.lexically_normal());
  if (auto checked = run.checkNotRead(command.report); !checked) return checked;
  const std::vector<std::filesystem::path> inputs = packInputs(command);
  for (const std::filesystem::path& input : inputs) {
    const std::filesystem::path output = run.outputFor(input);
    if (auto checked = run.checkNotRead(output); !checked) return checked;
    if (!outputs.insert(output.lexically_normal()).second) {
      return fail(ErrorCode::kInvalidInput, output.string(),
                  "would be written twice: two inputs of one name, or the report; use -o");
    }
  }
  if (inputs.size() > 1 && !command.output.empty() && !command.dry_run) {
    std::error_code problem;
    std::filesystem::create_directories(command.output, problem);
    if (problem) {
      return fail(ErrorCode::kIo, command.output.string(),
                  "cannot be made a folder: " + problem.message());
    }
  }
  return {};
}

/// Clears away what killed bakes of the same packs have left beside them.
void removeLeftovers(const BakeRun& run) {
  if (run.command().dry_run) return;
  for (const std::filesystem::path& input : packInputs(run.command())) {
    const std::filesystem::path output = run.outputFor(input);
    (void)removeStaleParts(output.parent_path(), {.target = output.filename().string()});
  }
}

/// Writes the report, if one is wanted.
Result<void> reportTo(const std::filesystem::path& path, const BakeRun& run) {
  if (path.empty()) return {};
  auto written = run.checkNotRead(path);
  return written ? writeReport(path, run) : written;
}

int bakeAll(const BakeCommand& command) {
  BakeRun run(command);
  if (const auto outputs = checkOutputs(run); !outputs) return refuse(outputs.error());
  // Before anything is baked for a golden report that is not there.
  const auto golden = goldenOf(command);
  if (!golden) return refuse(golden.error());
  removeLeftovers(run);
  bakeInputs(run);
  run.line().clear();
  if (const auto written = reportTo(command.report, run); !written) {
    const int code = refuse(written.error());
    return run.exitCode() == kExitOk ? code : run.exitCode();
  }
  const int differs = *golden ? checkReport(**golden, reportOf(run), command) : kExitOk;
  return run.exitCode() == kExitOk ? differs : run.exitCode();
}

/// A full disk behind a redirection must not look like success.
int flushed(int exit_code) {
  if (std::fflush(stdout) == 0 && std::cout.flush() && std::ferror(stdout) == 0) return exit_code;
  fmt::print(stderr, "galactic-bake: standard output: cannot be written; free some space\n");
  return exit_code == kExitOk ? static_cast<int>(ErrorCode::kIo) : exit_code;
}

int run(int argc, const char* const* argv) {
  const ParsedCommand parsed = parseCommandLine(argc, argv);
  if (const int* code = std::get_if<int>(&parsed)) return *code;
  const auto& command = std::get<BakeCommand>(parsed);
  if (command.robot.print_recipe) {
    const auto printed = printRecipeDraft(command);
    return printed ? kExitOk : refuse(printed.error());
  }
  return command.hasPlan() ? bakePlan(command) : bakeAll(command);
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  namespace bake = galactic::bake;
  // A file that grows beyond the limit of its size (ulimit -f) is an error of writing it.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return bake::flushed(bake::run(argc, argv));
  } catch (const std::bad_alloc&) {
    return bake::refuse(galactic::outOfMemory());
  } catch (const std::length_error&) {  // a vector that no memory could hold
    return bake::refuse(galactic::outOfMemory());
  } catch (const std::filesystem::filesystem_error& error) {
    return bake::refuse({galactic::ErrorCode::kIo, error.path1().string(), error.code().message()});
  } catch (const std::system_error& error) {  // what printing throws
    if (galactic::isOutOfMemory(error)) return bake::refuse(galactic::outOfMemory());
    return bake::refuse({galactic::ErrorCode::kIo, "standard output", error.what()});
  } catch (const std::exception& error) {
    fmt::print(stderr, "galactic-bake: internal error: {}; please report it\n", error.what());
    return static_cast<int>(galactic::ErrorCode::kInternal);
  }
}
