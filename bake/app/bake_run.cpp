#include "bake_run.h"

#include <fmt/format.h>

#include <cstdio>

#include "galactic/printable.h"

namespace galactic::bake {

void BakeRun::noteRead(const std::filesystem::path& folder, const std::vector<SourceFile>& files) {
  for (const SourceFile& file : files) read_.push_back(folder / file.name);
}

Result<void> BakeRun::checkNotRead(const std::filesystem::path& output) const {
  for (const std::filesystem::path& source : read_) {
    std::error_code missing;
    if (output.empty() || !std::filesystem::equivalent(source, output, missing)) continue;
    return galactic::fail(ErrorCode::kInvalidInput, output.string(),
                          "is also an input; write to another file");
  }
  return {};
}

std::filesystem::path BakeRun::outputFor(const std::filesystem::path& input) const {
  std::error_code unknown;
  std::filesystem::path name = input.stem();
  if (std::filesystem::is_directory(input, unknown)) {
    // "objects/" has no file name and "." is none; a dot in a folder's name begins no extension.
    name = std::filesystem::absolute(input / "", unknown).lexically_normal().parent_path();
    name = name.has_filename() ? name.filename() : "objects";
  }
  name += ".pack";
  if (command_.output.empty()) return name;
  const bool one_pack = command_.kind == AssetKind::kObject || command_.inputs.size() == 1;
  const bool is_folder = !one_pack || std::filesystem::is_directory(command_.output, unknown);
  return is_folder ? command_.output / name : command_.output;
}

void BakeRun::fail(const std::filesystem::path& input, const Error& error) {
  line_.clear();
  printError(error);
  failures_.push_back({input, error});
}

Provenance provenanceOf(const BakeCommand& command, std::vector<SourceFile> sources,
                        std::vector<std::string> warnings) {
  Provenance provenance;
  provenance.tool_version = GALACTIC_VERSION;
  provenance.options = command.content_options;
  provenance.sources = std::move(sources);
  provenance.warnings = std::move(warnings);
  return provenance;
}

void printError(const Error& error) {
  fmt::print(stderr, "galactic-bake: {}: {}\n", printable(error.where), printable(error.message));
}

}  // namespace galactic::bake
