#include "galactic/bake/assets.h"

#include <utility>
#include <vector>

#include "asset/asset_parts.h"
#include "common/overload.h"
#include "galactic/bake/packs.h"
#include "support/files/output_files.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

Result<BakedPack> makeWorldPack(const WorldJob& job, const BakeContext& context) {
  context.show(context.output.filename().string(), "verify", 0);
  WorldOutcome outcome;
  ASSIGN_OR_RETURN(outcome.packs, linkPacks(job.packs, context.output.parent_path()));
  RETURN_IF_ERROR(context.log.checkNotRead(context.output));
  BakedPack made{.outcome = {}, .output = context.output};
  if (!context.dry_run) {
    std::vector<SourceFile> sources;
    sources.reserve(outcome.packs.size());
    for (const LinkedPack& pack : outcome.packs) {
      sources.push_back({pack.path, pack.bytes, pack.hash_low, pack.hash_high});
    }
    ASSIGN_OR_RETURN(made.pack_bytes,
                     writeWorldPack(context.output, outcome.packs,
                                    provenanceOf(job, std::move(sources), {}), job.task));
  }
  made.outcome = std::move(outcome);
  return made;
}

}  // namespace

void ReadLog::note(const std::filesystem::path& folder, const ReadFiles& read) {
  for (const SourceFile& file : read.files) read_.push_back({folder / file.name, file});
  for (const std::string& name : read.absent) absent_.push_back(folder / name);
  is_settled_ = is_settled_ && read.is_settled;
}

Result<void> ReadLog::checkNotRead(const std::filesystem::path& output) const {
  for (const ReadFile& source : read_) {
    if (!output.empty()) RETURN_IF_ERROR(checkNotInput(output, source.path));
  }
  return {};
}

Result<BakedPack> linkWorld(const WorldJob& job, BakeContext& context) {
  return timed<WorldOutcome>([&] { return makeWorldPack(job, context); });
}

Result<BakedPack> bake(const Job& job, BakeContext& context) {
  for (const std::filesystem::path& file : filesOf(job)) context.log.noteRead(file);
  return std::visit(
      Overload{[&](const SceneJob& one) { return bakeSceneFile(one, context); },
               [&](const ObjectJob& one) { return bakeObjectFiles(one, context); },
               [&](const RobotJob& one) { return bakeRobotFile(one, context); },
               [&](const EpisodeImportJob& one) { return bakeEpisodes(one, context); },
               [&](const EpisodeGenerationJob& one) { return bakeEpisodes(one, context); },
               [&](const WorldJob& one) { return linkWorld(one, context); }},
      job);
}

}  // namespace galactic::bake
