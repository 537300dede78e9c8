#include "bake_run.h"

#include <fmt/format.h>

#include <cstdio>

#include "galactic/printable.h"

namespace galactic::bake {

void BakeRun::noteRead(const std::filesystem::path& folder, const std::vector<SourceFile>& files) {
  for (const SourceFile& file : files) read_.push_back({folder / file.name, file});
}

Result<void> BakeRun::checkNotRead(const std::filesystem::path& output) const {
  for (const ReadFile& source : read_) {
    std::error_code missing;
    if (output.empty() || !std::filesystem::equivalent(source.path, output, missing)) continue;
    return galactic::fail(ErrorCode::kInvalidInput, output.string(),
                          "is also an input; write to another file");
  }
  return {};
}

namespace {

/// The name of the pack that is made of `input`, without its extension.
std::filesystem::path packNameOf(const BakeCommand& command, const std::filesystem::path& input) {
  if (command.kind == AssetKind::kWorld) return "world";
  if (command.kind == AssetKind::kEpisodes && command.episodes.sampled) return "episodes";
  if (command.kind == AssetKind::kEpisodes) return episodeSetName(input);
  std::error_code unknown;
  if (!std::filesystem::is_directory(input, unknown)) return input.stem();
  // "objects/" has no file name and "." is none; a dot in a folder's name begins no extension.
  const auto folder =
      std::filesystem::absolute(input / "", unknown).lexically_normal().parent_path();
  return folder.has_filename() ? folder.filename() : "objects";
}

}  // namespace

std::filesystem::path BakeRun::outputFor(const std::filesystem::path& input) const {
  std::error_code unknown;
  std::filesystem::path name = packNameOf(command_, input);
  name += ".pack";
  if (command_.output.empty()) return name;
  const bool one_pack = command_.makesOnePack() || command_.inputs.size() == 1;
  const bool is_folder = !one_pack || std::filesystem::is_directory(command_.output, unknown);
  return is_folder ? command_.output / name : command_.output;
}

void BakeRun::fail(const std::filesystem::path& input, const Error& error) {
  line_.clear();
  if (command_.verbosity != Verbosity::kSilent) printError(error);
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

int refuse(const Error& error) {
  printError(error);
  return static_cast<int>(error.code);
}

}  // namespace galactic::bake
