#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "asset/asset_parts.h"
#include "asset/scene_source.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/read_files.h"
#include "galactic/pack.h"
#include "galactic/scene.h"
#include "support/files/journal.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Writes what the outcome holds.
Result<BakedPack> finish(EpisodeOutcome outcome, const Job& job, std::vector<SourceFile> sources,
                         const BakeContext& context) {
  RETURN_IF_ERROR(context.log.checkNotRead(context.output));
  BakedPack made{.outcome = {}, .output = context.output};
  if (!context.dry_run) {
    const auto bytes =
        writeEpisodePack(context.output, outcome.episodes,
                         provenanceOf(job, std::move(sources), outcome.episodes.warnings));
    if (!bytes) {
      const Error& error = bytes.error();
      return fail(error.code, inFile(outcome.input, error.where), error.message);
    }
    made.pack_bytes = *bytes;
  }
  made.outcome = std::move(outcome);
  return made;
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
    ASSIGN_OR_RETURN(auto pack, PackFile::open(input));
    opened.files.push_back(describeBytes(input.filename().string(), pack.bytes()));
    opened.packs.push_back(std::move(pack));
  }
  return opened;
}

/// Sees that each mesh of `geometry` is for one of the scenes, and describes it.
Result<void> addGeometry(const EpisodeGenerationJob& job, ReadLog& log, OpenPacks& opened) {
  std::set<std::string, std::less<>> names;
  for (const PackFile& pack : opened.packs) {
    if (pack.kind() != PackKind::kScene) continue;
    ASSIGN_OR_RETURN(const auto scene, Scene::from(pack));
    names.emplace(scene.name());
  }
  for (const auto& [scene, file] : job.geometry) {
    if (!names.contains(scene)) {
      return fail(ErrorCode::kInvalidInput, "geometry",
                  fmt::format("is for the scene {}, which none of the packs holds; they hold {}",
                              scene, fmt::join(names, ", ")));
    }
    if (auto added = addSources({file}, opened.files); !added) return added;
    log.noteRead(file);
  }
  return {};
}

/// Of a scene that is made in the same build, the triangles and receptacles, read again from what
/// its pack is made of: the pack holds neither, and may come from the cache. Of others, the mesh of
/// `geometry`; nothing where there is none.
Result<SceneDetails> readDetails(const EpisodeGenerationJob& job, std::string_view scene,
                                 BakeLibraries& libraries) {
  const std::string name(scene);
  if (const auto made = job.scenes.find(name); made != job.scenes.end()) {
    return readSceneDetails(made->second, libraries);
  }
  const auto file = job.geometry.find(name);
  if (file == job.geometry.end()) return SceneDetails{};
  return readSceneDetails({.input = file->second}, libraries);
}

/// `files`: sorted. What only scenes know decides, too, and stands in the records.
Result<std::unique_ptr<Journal>> openJournal(EpisodeGenerationJob job,
                                             std::span<const SourceFile> files,
                                             const BakeContext& context) {
  // What they decide comes after the drawing.
  job.solve = 0;
  job.generate.most_skipped = 0;
  return openJournal(Job(std::move(job)), files, context);
}

Result<GeneratedEpisodes> generate(const EpisodeGenerationJob& job, const EpisodeInputs& inputs,
                                   const BakeContext& context) {
  const auto show = [&](std::size_t done) {
    const std::uint32_t all = job.generate.episodes;
    context.show("episodes", fmt::format("{} of {}", done, all), static_cast<double>(done) / all);
  };
  show(0);
  return generateEpisodes(inputs, job.generate, show);
}

/// Generates them, lets a sample of them be played, and writes them.
Result<BakedPack> makeEpisodes(const EpisodeGenerationJob& job, const EpisodeInputs& inputs,
                               std::vector<SourceFile> files, const BakeContext& context) {
  ASSIGN_OR_RETURN(auto generated, generate(job, inputs, context));
  // As one that is exported and imported again is called.
  generated.episodes.name = context.output.stem().string();
  context.show("episodes", "solve", 1);
  ASSIGN_OR_RETURN(auto sample, solveSample(inputs.packs, generated.episodes,
                                            {.most_episodes = job.solve}, context.threads));
  return finish({.input = fmt::format("{} packs", job.packs.size()),
                 .episodes = std::move(generated.episodes),
                 .generation = EpisodeGeneration{generated.rejections, std::move(generated.scenes),
                                                 std::move(generated.left_out), std::move(sample),
                                                 generated.skipped, generated.with_fewer_objects}},
                job, std::move(files), context);
}

/// The options of an import, with what stands in other files.
Result<EpisodeImportOptions> importOptions(const EpisodeImportJob& job) {
  EpisodeImportOptions options = job.import;
  if (!job.only.empty()) {
    ASSIGN_OR_RETURN(auto only, readEpisodeList(job.only));
    options.only = std::move(only);
  }
  if (!job.object_pack.empty()) {
    ASSIGN_OR_RETURN(const auto pack, PackFile::open(job.object_pack));
    ASSIGN_OR_RETURN(auto centers, objectCenters(pack));
    options.object_centers = std::move(centers);
    options.centers_needed = true;
  }
  return options;
}

Result<BakedPack> importEpisodes(const EpisodeImportJob& job, const BakeContext& context) {
  context.show(job.input.filename().string(), "import", 0);
  ASSIGN_OR_RETURN(const auto options, importOptions(job));
  ASSIGN_OR_RETURN(auto episodes, readEpisodeFile(job.input, options));
  std::vector<SourceFile> sources;
  RETURN_IF_ERROR(addSources({job.input, job.only, job.object_pack}, sources));
  return finish({.input = job.input.string(), .episodes = std::move(episodes)}, job,
                std::move(sources), context);
}

Result<BakedPack> generateInPacks(const EpisodeGenerationJob& job, const BakeContext& context) {
  ASSIGN_OR_RETURN(auto opened, openPacks(job.packs));
  RETURN_IF_ERROR(addGeometry(job, context.log, opened));
  // The bytes of the pack do not depend on the order of the inputs, of which several may have one
  // name.
  std::ranges::sort(opened.files, {}, [](const SourceFile& file) {
    return std::tie(file.name, file.bytes, file.hash_high, file.hash_low);
  });
  ASSIGN_OR_RETURN(const auto journal, openJournal(job, opened.files, context));
  EpisodeInputs inputs{.threads = context.threads,
                       .journal = journal.get(),
                       .stops = context.stops,
                       .memory = context.memory};
  inputs.packs.reserve(opened.packs.size());
  for (const PackFile& pack : opened.packs) inputs.packs.push_back(&pack);
  if (!job.scenes.empty() || !job.geometry.empty()) {
    inputs.details = [&](std::string_view scene) {
      return readDetails(job, scene, context.libraries);
    };
  }
  auto made = makeEpisodes(job, inputs, std::move(opened.files), context);
  if (journal && made) journal->remove();
  return made;
}

}  // namespace

Result<BakedPack> bakeEpisodes(const EpisodeImportJob& job, BakeContext& context) {
  return timed<EpisodeOutcome>([&] { return importEpisodes(job, context); });
}

Result<BakedPack> bakeEpisodes(const EpisodeGenerationJob& job, BakeContext& context) {
  return timed<EpisodeOutcome>([&] { return generateInPacks(job, context); });
}

}  // namespace galactic::bake
