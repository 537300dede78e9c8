#include "episode_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include "episode_outcome.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/bake/episode_pack.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/mesh_import.h"
#include "galactic/bake/source_file.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/pack.h"
#include "galactic/scene.h"

namespace galactic::bake {
namespace {

/// Writes what `outcome` holds, prints its table and gives its report.
Result<Json> finish(EpisodeOutcome& outcome, std::vector<SourceFile> sources, BakeRun& run,
                    std::chrono::steady_clock::time_point start) {
  const BakeCommand& command = run.command();
  if (auto checked = run.checkNotRead(outcome.output); !checked) {
    return tl::unexpected(checked.error());
  }
  if (!command.dry_run) {
    const auto bytes =
        writeEpisodePack(outcome.output, outcome.episodes,
                         provenanceOf(command, std::move(sources), outcome.episodes.warnings));
    if (!bytes) {
      const Error& error = bytes.error();
      return galactic::fail(error.code, inFile(outcome.input, error.where), error.message);
    }
    outcome.pack_bytes = *bytes;
  }
  outcome.seconds = secondsSince(start);
  run.line().clear();
  if (command.saysMore()) printEpisodeTable(outcome, command.verbosity);
  return episodeReport(outcome);
}

/// The packs in which episodes are generated.
struct OpenPacks {
  std::vector<PackFile> packs;
  std::vector<SourceFile> files;
};

Result<OpenPacks> openPacks(const std::vector<std::filesystem::path>& inputs) {
  OpenPacks opened;
  opened.packs.reserve(inputs.size());
  opened.files.reserve(inputs.size());
  for (const std::filesystem::path& input : inputs) {
    auto pack = PackFile::open(input);
    if (!pack) return tl::unexpected(pack.error());
    opened.files.push_back(describeBytes(input.filename().string(), pack->bytes()));
    opened.packs.push_back(std::move(*pack));
  }
  return opened;
}

/// Sees that each mesh of --geometry is for one of the scenes, and describes it.
Result<void> addGeometry(BakeRun& run, OpenPacks& opened) {
  std::set<std::string, std::less<>> names;
  for (const PackFile& pack : opened.packs) {
    if (pack.kind() != PackKind::kScene) continue;
    const auto scene = Scene::from(pack);
    if (!scene) return tl::unexpected(scene.error());
    names.emplace(scene->name());
  }
  for (const auto& [scene, file] : run.command().episodes.geometry) {
    if (!names.contains(scene)) {
      return fail(ErrorCode::kInvalidInput, "--geometry",
                  fmt::format("is for the scene {}, which none of the packs holds; they hold {}",
                              scene, fmt::join(names, ", ")));
    }
    auto described = describeFile(file);
    if (!described) return tl::unexpected(described.error());
    opened.files.push_back(std::move(*described));
    run.noteRead(file);
  }
  return {};
}

/// The mesh of --geometry for a scene; nothing where there is none.
Result<SceneDetails> readDetails(const EpisodeOptions& options, std::string_view scene) {
  if (options.details) return options.details(scene);
  SceneDetails details;
  const auto file = options.geometry.find(std::string(scene));
  if (file == options.geometry.end()) return details;
  const auto asset = importMesh(file->second);
  if (!asset) return tl::unexpected(asset.error());
  auto clean = placeAndClean(*asset);
  if (!clean) {
    const Error& error = clean.error();
    return fail(error.code, inFile(file->second, error.where), error.message);
  }
  details.mesh = std::move(clean->mesh);
  return details;
}

}  // namespace

Result<Json> importEpisodeFile(const std::filesystem::path& input, BakeRun& run) {
  const BakeCommand& command = run.command();
  const auto start = std::chrono::steady_clock::now();
  run.line().show(input.filename().string(), "import", 0);
  EpisodeImportOptions options = command.episodes.import;
  if (!command.episodes.only.empty()) {
    auto only = readEpisodeList(command.episodes.only);
    if (!only) return tl::unexpected(only.error());
    options.only = std::move(*only);
  }
  if (!command.episodes.object_pack.empty()) {
    const auto pack = PackFile::open(command.episodes.object_pack);
    if (!pack) return tl::unexpected(pack.error());
    auto centres = objectCentres(*pack);
    if (!centres) return tl::unexpected(centres.error());
    options.object_centres = std::move(*centres);
    options.centres_needed = true;
  }
  auto episodes = readEpisodeFile(input, options);
  if (!episodes) return tl::unexpected(episodes.error());
  std::vector<SourceFile> sources;
  for (const std::filesystem::path& path :
       {input, command.episodes.only, command.episodes.object_pack}) {
    if (path.empty()) continue;
    auto file = describeFile(path);
    if (!file) return tl::unexpected(file.error());
    sources.push_back(std::move(*file));
  }
  EpisodeOutcome outcome{
      .input = input.string(), .output = run.outputFor(input), .episodes = std::move(*episodes)};
  return finish(outcome, std::move(sources), run, start);
}

Result<Json> generateEpisodePack(BakeRun& run) {
  const BakeCommand& command = run.command();
  const EpisodeOptions& options = command.episodes;
  const auto start = std::chrono::steady_clock::now();
  auto opened = openPacks(command.inputs);
  if (!opened) return tl::unexpected(opened.error());
  if (auto added = addGeometry(run, *opened); !added) return tl::unexpected(added.error());
  // The bytes of the pack do not depend on the order of the inputs.
  std::ranges::sort(opened->files, {}, &SourceFile::name);
  EpisodeInputs inputs;
  inputs.packs.reserve(opened->packs.size());
  for (const PackFile& pack : opened->packs) inputs.packs.push_back(&pack);
  if (options.details || !options.geometry.empty()) {
    inputs.details = [&options](std::string_view scene) { return readDetails(options, scene); };
  }
  const auto show = [&](std::size_t done) {
    const std::uint32_t all = options.generate.episodes;
    run.line().show("episodes", fmt::format("{} of {}", done, all),
                    static_cast<double>(done) / all);
  };
  show(0);
  auto generated = generateEpisodes(inputs, options.generate, show);
  if (!generated) return tl::unexpected(generated.error());
  run.line().show("episodes", "solve", 1);
  auto sample = solveSample(inputs.packs, generated->episodes,
                            {.most_episodes = options.solve, .jobs = options.generate.jobs});
  if (!sample) return tl::unexpected(sample.error());
  EpisodeOutcome outcome{
      .input = fmt::format("{} packs", command.inputs.size()),
      .output = run.outputFor(command.inputs.front()),
      .episodes = std::move(generated->episodes),
      .generation = EpisodeGeneration{generated->rejections, std::move(generated->scenes),
                                      std::move(generated->left_out), *std::move(sample),
                                      generated->skipped, generated->with_fewer_objects}};
  return finish(outcome, std::move(opened->files), run, start);
}

}  // namespace galactic::bake
