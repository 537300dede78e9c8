#include "episode_job.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "episode_outcome.h"
#include "galactic/bake/episode_pack.h"
#include "galactic/bake/episode_sampler.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/source_file.h"
#include "galactic/object_set.h"
#include "galactic/pack.h"
#include "galactic/robot.h"
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

/// The packs in which episodes are sampled.
struct SamplingPacks {
  std::vector<PackFile> scene_packs;
  std::vector<Scene> scenes;
  std::optional<PackFile> object_pack;
  std::optional<ObjectSet> objects;
  std::optional<PackFile> robot_pack;
  std::optional<Robot> robot;
  std::vector<SourceFile> files;
};

/// Keeps the only pack of its kind and what is in it.
template <class T>
Result<void> keepOnly(PackFile pack, std::optional<PackFile>& kept, std::optional<T>& content) {
  if (kept) {
    return fail(ErrorCode::kInvalidInput, pack.where(),
                fmt::format("is a second pack of kind {}, the first is {}; give one of them",
                            packKindName(pack.kind()), kept->where()));
  }
  kept.emplace(std::move(pack));
  auto opened = T::from(*kept);
  if (!opened) return tl::unexpected(opened.error());
  content.emplace(std::move(*opened));
  return {};
}

Result<void> add(PackFile pack, SamplingPacks& packs) {
  switch (pack.kind()) {
    case PackKind::kScene: {
      auto scene = Scene::from(pack);
      if (!scene) return tl::unexpected(scene.error());
      packs.scenes.push_back(std::move(*scene));
      packs.scene_packs.push_back(std::move(pack));
      return {};
    }
    case PackKind::kObjects:
      return keepOnly(std::move(pack), packs.object_pack, packs.objects);
    case PackKind::kRobot:
      return keepOnly(std::move(pack), packs.robot_pack, packs.robot);
    case PackKind::kTexture:
      // What scenes look like plays no part.
      return {};
    case PackKind::kEpisodes:
    case PackKind::kWorld:
      break;
  }
  return fail(ErrorCode::kInvalidInput, pack.where(),
              fmt::format("is a pack of kind {}; episodes are sampled in packs of scenes, objects "
                          "and a robot",
                          packKindName(pack.kind())));
}

Result<SamplingPacks> openPacks(const std::vector<std::filesystem::path>& inputs) {
  SamplingPacks packs;
  for (const std::filesystem::path& input : inputs) {
    auto pack = PackFile::open(input);
    if (!pack) return tl::unexpected(pack.error());
    packs.files.push_back(describeBytes(input.filename().string(), pack->bytes()));
    if (auto added = add(std::move(*pack), packs); !added) return tl::unexpected(added.error());
  }
  if (!packs.scenes.empty() && packs.objects && packs.robot) return packs;
  return fail(
      ErrorCode::kInvalidInput, "--as episodes",
      fmt::format("{} scenes, {} object packs and {} robots are given; episodes are sampled "
                  "in at least one scene, with one object pack and one robot",
                  packs.scenes.size(), packs.objects ? 1 : 0, packs.robot ? 1 : 0));
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

Result<Json> sampleEpisodePack(BakeRun& run) {
  const BakeCommand& command = run.command();
  const auto start = std::chrono::steady_clock::now();
  auto packs = openPacks(command.inputs);
  if (!packs) return tl::unexpected(packs.error());
  run.line().show("episodes", "sample", 0);
  auto episodes =
      sampleEpisodes(packs->scenes, *packs->objects, *packs->robot, command.episodes.sample);
  if (!episodes) return tl::unexpected(episodes.error());
  EpisodeOutcome outcome{.input = fmt::format("{} packs", command.inputs.size()),
                         .output = run.outputFor(command.inputs.front()),
                         .episodes = std::move(*episodes)};
  return finish(outcome, std::move(packs->files), run, start);
}

}  // namespace galactic::bake
