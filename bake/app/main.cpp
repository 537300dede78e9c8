#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <set>

#include "bake_outcome.h"
#include "closing_table.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/scene_pack.h"
#include "galactic/printable.h"
#include "options.h"
#include "progress_line.h"
#include "report.h"

namespace galactic::bake {
namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Where the pack of `input` goes.
std::filesystem::path outputFor(const std::filesystem::path& input, const BakeCommand& command) {
  std::filesystem::path name = input.stem();
  name += ".pack";
  if (command.output.empty()) return name;
  std::error_code unknown;
  const bool is_folder =
      command.inputs.size() > 1 || std::filesystem::is_directory(command.output, unknown);
  return is_folder ? command.output / name : command.output;
}

/// Refuses to write `output` over a file that the user owns and the bake reads.
Result<void> checkNotRead(const std::filesystem::path& output,
                          const std::vector<std::filesystem::path>& read) {
  for (const std::filesystem::path& source : read) {
    std::error_code missing;
    if (output.empty() || !std::filesystem::equivalent(source, output, missing)) continue;
    return fail(ErrorCode::kInvalidInput, output.string(),
                "is also an input; write to another file");
  }
  return {};
}

/// Two outputs must not be one file, and none may replace an input or the options' file.
Result<void> checkOutputs(const BakeCommand& command) {
  std::vector<std::filesystem::path> read = command.inputs;
  read.push_back(command.config);
  std::set<std::filesystem::path> outputs;
  if (!command.report.empty()) outputs.insert(command.report.lexically_normal());
  if (auto checked = checkNotRead(command.report, read); !checked) return checked;
  for (const std::filesystem::path& input : command.inputs) {
    const std::filesystem::path output = outputFor(input, command);
    if (auto checked = checkNotRead(output, read); !checked) return checked;
    if (!outputs.insert(output.lexically_normal()).second) {
      return fail(ErrorCode::kInvalidInput, output.string(),
                  "would be written twice: two inputs of one name, or the report; use -o");
    }
  }
  if (command.inputs.size() > 1 && !command.output.empty() && !command.dry_run) {
    std::error_code problem;
    std::filesystem::create_directories(command.output, problem);
    if (problem) {
      return fail(ErrorCode::kIo, command.output.string(),
                  "cannot be made a folder: " + problem.message());
    }
  }
  return {};
}

Provenance provenanceOf(const BakeCommand& command, const SourceAsset& asset,
                        const BakedScene& scene) {
  Provenance provenance;
  provenance.tool_version = GALACTIC_VERSION;
  provenance.options = command.content_options;
  provenance.sources = asset.files;
  provenance.warnings = scene.warnings;
  return provenance;
}

/// Bakes one input; adds the files that it read to `read`.
Result<BakeOutcome> bakeOne(const std::filesystem::path& input, const BakeCommand& command,
                            ProgressLine& line, std::vector<std::filesystem::path>& read) {
  BakeOutcome outcome;
  outcome.input = input;
  outcome.output = outputFor(input, command);
  const std::string item = input.filename().string();
  line.show(item, "import", 0);
  auto start = std::chrono::steady_clock::now();
  auto asset = importMesh(input, command.import);
  if (!asset) return tl::unexpected(asset.error());
  outcome.times.import = secondsSince(start);
  outcome.convention = asset->convention;
  for (const SourceFile& file : asset->files) read.push_back(input.parent_path() / file.name);
  if (auto checked = checkNotRead(outcome.output, read); !checked) {
    return tl::unexpected(checked.error());
  }
  auto scene =
      bakeScene(*asset, command.scene, outcome.times,
                [&](std::string_view stage, double fraction) { line.show(item, stage, fraction); });
  if (!scene) {
    // Errors of the geometry name no file: the bakers know none.
    if (scene.error().where.empty()) scene.error().where = input.string();
    return tl::unexpected(scene.error());
  }
  outcome.scene = std::move(*scene);
  if (command.dry_run) return outcome;
  line.show(item, "write", 1);
  start = std::chrono::steady_clock::now();
  const auto bytes =
      writeScenePack(outcome.output, outcome.scene, provenanceOf(command, *asset, outcome.scene));
  if (!bytes) return tl::unexpected(bytes.error());
  outcome.times.write = secondsSince(start);
  outcome.pack_bytes = *bytes;
  return outcome;
}

int report(const Error& error) {
  fmt::print(stderr, "galactic-bake: {}: {}\n", printable(error.where), printable(error.message));
  return static_cast<int>(error.code);
}

int runBakes(const BakeCommand& command) {
  if (const auto outputs = checkOutputs(command); !outputs) return report(outputs.error());
  ProgressLine line(command.verbosity != Verbosity::kQuiet);
  std::vector<BakeOutcome> outcomes;
  std::vector<BakeFailure> failures;
  std::vector<std::filesystem::path> read;
  int exit_code = kExitOk;
  for (const std::filesystem::path& input : command.inputs) {
    auto outcome = bakeOne(input, command, line, read);
    line.clear();
    if (outcome) {
      if (command.verbosity != Verbosity::kQuiet) printClosingTable(*outcome, command.verbosity);
      // A report needs the counts, not the grids.
      for (BakedGrid& grid : outcome->scene.grids) grid.grid.cells = {};
      outcomes.push_back(std::move(*outcome));
      continue;
    }
    const int code = report(outcome.error());
    if (exit_code == kExitOk) exit_code = code;
    failures.push_back({input, outcome.error()});
    if (!command.keep_going) break;
  }
  if (command.report.empty()) return exit_code;
  auto written = checkNotRead(command.report, read);
  if (written) written = writeReport(command.report, outcomes, failures);
  const int report_code = written ? kExitOk : report(written.error());
  return exit_code == kExitOk ? report_code : exit_code;
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  namespace bake = galactic::bake;
  try {
    const bake::ParsedCommand parsed = bake::parseCommandLine(argc, argv);
    if (const int* code = std::get_if<int>(&parsed)) return *code;
    return bake::runBakes(std::get<bake::BakeCommand>(parsed));
  } catch (const std::exception& error) {
    fmt::print(stderr, "galactic-bake: internal error: {}; please report it\n", error.what());
    return static_cast<int>(galactic::ErrorCode::kInternal);
  }
}
