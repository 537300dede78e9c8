#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <set>

#include "bake_inputs.h"
#include "bake_run.h"
#include "options.h"
#include "plan/bake_plan.h"
#include "report.h"

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

int bakeAll(const BakeCommand& command) {
  BakeRun run(command);
  if (const auto outputs = checkOutputs(run); !outputs) {
    printError(outputs.error());
    return static_cast<int>(outputs.error().code);
  }
  bakeInputs(run);
  run.line().clear();
  if (command.report.empty()) return run.exitCode();
  auto written = run.checkNotRead(command.report);
  if (written) written = writeReport(command.report, run);
  if (written) return run.exitCode();
  printError(written.error());
  return run.exitCode() == kExitOk ? static_cast<int>(written.error().code) : run.exitCode();
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  namespace bake = galactic::bake;
  try {
    const bake::ParsedCommand parsed = bake::parseCommandLine(argc, argv);
    if (const int* code = std::get_if<int>(&parsed)) return *code;
    const auto& command = std::get<bake::BakeCommand>(parsed);
    return command.hasPlan() ? bake::bakePlan(command) : bake::bakeAll(command);
  } catch (const std::exception& error) {
    fmt::print(stderr, "galactic-bake: internal error: {}; please report it\n", error.what());
    return static_cast<int>(galactic::ErrorCode::kInternal);
  }
}
