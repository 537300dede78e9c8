#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <map>
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
#include "galactic/pack_reference.h"
#include "galactic/scene.h"
#include "support/files/journal.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Writes the episodes of the outcome.
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

/// Checks that each mesh of `geometry` belongs to one of the scenes, and adds it to the sources.
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

/// For a scene that is made in the same build, the triangles and receptacles, which are read again
/// from the sources of its pack: the pack holds neither, and may come from the cache. For others,
/// the mesh of `geometry`, or nothing if there is none.
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

/// `files` must be sorted. The result also depends on what is only known per scene; the journal's
/// records hold that.
Result<std::unique_ptr<Journal>> openJournal(EpisodeGenerationJob job,
                                             std::span<const SourceFile> files,
                                             const BakeContext& context) {
  // These options only take effect after the episodes are drawn.
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

/// Generates episodes, lets a sample of them be solved, and writes them.
Result<BakedPack> makeEpisodes(const EpisodeGenerationJob& job, const EpisodeInputs& inputs,
                               std::vector<SourceFile> files, const BakeContext& context) {
  ASSIGN_OR_RETURN(auto generated, generate(job, inputs, context));
  // The same name that an exported set gets when it is imported again.
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

/// Opens the packs in `inputs`, with each world replaced by the packs of these kinds that it lists.
Result<OpenPacks> openListed(const std::vector<std::filesystem::path>& inputs,
                             std::initializer_list<PackKind> kinds, ReadLog& log) {
  ASSIGN_OR_RETURN(auto given, openPacks(inputs));
  OpenPacks opened;
  opened.files = std::move(given.files);
  for (PackFile& pack : given.packs) {
    if (pack.kind() != PackKind::kWorld) {
      opened.packs.push_back(std::move(pack));
      continue;
    }
    ASSIGN_OR_RETURN(const auto references, packReferences(pack));
    for (const PackReference& reference : references) {
      if (std::ranges::find(kinds, reference.kind) == kinds.end()) continue;
      ASSIGN_OR_RETURN(auto listed, openReference(pack, reference));
      log.noteRead(listed.where());
      opened.files.push_back(describeBytes(std::string(reference.path), listed.bytes()));
      opened.packs.push_back(std::move(listed));
    }
  }
  return opened;
}

/// The centers of the objects in all packs.
Result<std::map<std::string, Vec3>> centersIn(const std::vector<PackFile>& packs) {
  std::map<std::string, Vec3> all;
  for (const PackFile& pack : packs) {
    ASSIGN_OR_RETURN(auto centers, objectCenters(pack));
    all.merge(centers);
    if (centers.empty()) continue;
    return fail(ErrorCode::kInvalidInput, pack.where(),
                fmt::format("holds the object {}, as another of the object packs does; give one "
                            "of them",
                            centers.begin()->first));
  }
  return all;
}

/// Carries out one import of episodes.
class EpisodeImport {
 public:
  EpisodeImport(const EpisodeImportJob& job, const BakeContext& context)
      : job_(job), context_(context) {}

  Result<BakedPack> run() {
    context_.show(job_.input.filename().string(), "import", 0);
    RETURN_IF_ERROR(addSources({job_.input, job_.only}, sources_));
    ASSIGN_OR_RETURN(objects_, openListed(job_.object_packs, {PackKind::kObjects}, context_.log));
    sources_.insert(sources_.end(), objects_.files.begin(), objects_.files.end());
    ASSIGN_OR_RETURN(const auto options, importOptions());
    ASSIGN_OR_RETURN(auto episodes, readEpisodeFile(job_.input, options));
    if (!episodes.without_start.empty()) RETURN_IF_ERROR(giveStarts(episodes));
    return finish({.input = job_.input.string(), .episodes = std::move(episodes)}, job_,
                  std::move(sources_), context_);
  }

 private:
  /// The job's import options, completed with the content of other files.
  [[nodiscard]] Result<EpisodeImportOptions> importOptions() const {
    EpisodeImportOptions options = job_.import;
    if (!job_.only.empty()) {
      ASSIGN_OR_RETURN(auto only, readEpisodeList(job_.only));
      options.only = std::move(only);
    }
    if (!job_.object_packs.empty()) {
      ASSIGN_OR_RETURN(auto centers, centersIn(objects_.packs));
      options.object_centers = std::move(centers);
      options.centers_needed = true;
    }
    return options;
  }

  /// Draws the missing starts in the packs, or warns if there are no packs.
  Result<void> giveStarts(SourceEpisodes& episodes) {
    if (job_.packs.empty()) {
      episodes.warnings.push_back(
          fmt::format("{} of {} episodes give no start and cannot be played, as the robot stands "
                      "at the origin: give the packs of their scenes, of their objects and of the "
                      "robot, too, and starts are drawn (in a recipe: give it [[objects]] and a "
                      "[robot])",
                      episodes.without_start.size(), episodes.episodes.size()));
      return {};
    }
    context_.show(job_.input.filename().string(), "starts", 0);
    ASSIGN_OR_RETURN(
        const auto opened,
        openListed(job_.packs, {PackKind::kScene, PackKind::kObjects, PackKind::kRobot},
                   context_.log));
    sources_.insert(sources_.end(), opened.files.begin(), opened.files.end());
    EpisodeInputs inputs{.threads = context_.threads, .stops = context_.stops};
    for (const PackFile& pack : opened.packs) inputs.packs.push_back(&pack);
    if (std::ranges::find(opened.packs, PackKind::kObjects, &PackFile::kind) ==
        opened.packs.end()) {
      for (const PackFile& pack : objects_.packs) inputs.packs.push_back(&pack);
    }
    return drawStarts(inputs, job_.seed.value_or(EpisodeGeneratorOptions().seed), episodes);
  }

  const EpisodeImportJob& job_;
  const BakeContext& context_;
  OpenPacks objects_;
  std::vector<SourceFile> sources_;
};

Result<BakedPack> generateInPacks(const EpisodeGenerationJob& job, const BakeContext& context) {
  ASSIGN_OR_RETURN(auto opened, openPacks(job.packs));
  RETURN_IF_ERROR(addGeometry(job, context.log, opened));
  // Sorted by content, too, because several inputs may have the same name, and the pack's bytes
  // must not depend on the order of the inputs.
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
  return timed<EpisodeOutcome>([&] { return EpisodeImport(job, context).run(); });
}

Result<BakedPack> bakeEpisodes(const EpisodeGenerationJob& job, BakeContext& context) {
  return timed<EpisodeOutcome>([&] { return generateInPacks(job, context); });
}

}  // namespace galactic::bake
