#include "run/tracked_run.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "galactic/render_library.h"
#include "run/run_report.h"
#include "support/files/atomic_file.h"
#include "support/try.h"
#include "view/page.h"
#include "view/run_animation.h"

namespace galactic {
namespace {

/// The parts of a world that a page needs: the episodes that were played, and what is in them.
struct PlayedParts {
  std::set<std::uint32_t> episodes;
  std::set<std::string_view> scenes;
  std::set<std::string_view> objects;
};

PlayedParts partsOf(const RunTrack& track) {
  PlayedParts parts;
  for (const EnvTrack& env : track.envs()) {
    parts.episodes.insert(env.episodes.begin(), env.episodes.end());
  }
  const World& world = track.world();
  const EpisodeSet& set = world.episodes();
  for (const std::uint32_t number : parts.episodes) {
    const Episode& episode = set.episodes()[number];
    parts.scenes.insert(world.sceneOf(episode).name());
    for (const Placement& placement : set.placements(episode)) {
      parts.objects.insert(world.objectOf(placement).name);
    }
  }
  return parts;
}

bool isPlayed(const PackFile& pack, const PlayedParts& parts) {
  if (pack.kind() == PackKind::kScene) {
    const auto scene = Scene::from(pack);
    return scene && parts.scenes.contains(scene->name());
  }
  if (pack.kind() == PackKind::kObjects) {
    const auto set = ObjectSet::from(pack);
    return set && std::any_of(set->objects().begin(), set->objects().end(),
                              [&](const ObjectModel& object) {
                                return parts.objects.contains(object.name);
                              });
  }
  return pack.kind() == PackKind::kRobot || pack.kind() == PackKind::kEpisodes;
}

/// The facts about the run that do not differ from one time to the next.
std::string factsOf(const RunOptions& options) {
  JsonWriter json;
  json.begin('{');
  json.text("policy", options.replayFile().empty() ? options.policy : "replay");
  json.begin("options", '{');
  writeSimulation(json, options.simulation);
  json.end('}');
  json.end('}');
  return json.take();
}

}  // namespace

Result<std::vector<PageAsset>> pageAssetsOf(const RunTrack& track) {
  const PlayedParts parts = partsOf(track);
  SharedTextures textures;
  for (const PackFile& pack : track.world().packs()) {
    if (pack.kind() != PackKind::kTexture) continue;
    RETURN_IF_ERROR(textures.add(pack));
  }
  std::vector<PageAsset> assets;
  for (const PackFile& pack : track.world().packs()) {
    if (!isPlayed(pack, parts)) continue;
    PageAsset& asset = assets.emplace_back(PageAsset{.pack = &pack});
    if (pack.kind() == PackKind::kEpisodes) {
      asset.episodes.assign(parts.episodes.begin(), parts.episodes.end());
      continue;
    }
    auto meshes = renderMeshesOf(pack, textures);
    if (!meshes) return tl::unexpected(meshes.error());
    if (*meshes) asset.meshes = std::make_shared<const RenderMeshes>(std::move(**meshes));
  }
  return assets;
}

// An animation shows the first env.
TrackedRun::TrackedRun(const World& world, const BatchSimulator& simulator,
                       const RunOptions& options)
    : track_(world, simulator, options.view.empty() ? 1 : options.view_envs), options_(options) {}

Result<void> TrackedRun::finish() const {
  ASSIGN_OR_RETURN(const auto assets, pageAssetsOf(track_));
  const Result<void> page = options_.view.empty() ? Result<void>() : writePage(assets);
  Result<void> animation = options_.animation.empty() ? Result<void>() : writeAnimation(assets);
  RETURN_IF_ERROR(page);
  return animation;
}

Result<void> TrackedRun::writePage(std::span<const PageAsset> assets) const {
  ASSIGN_OR_RETURN(const auto page,
                   viewPage(assets, {.track = &track_, .facts = factsOf(options_)},
                            {.title = std::filesystem::path(options_.view).stem().string(),
                             .generator = "galactic-run"}));
  return writeFileAtomically(options_.view, page);
}

Result<void> TrackedRun::writeAnimation(std::span<const PageAsset> assets) const {
  auto glb = animationGlb(track_, 0, assets);
  if (!glb) {
    glb.error().where = options_.animation;
    return tl::unexpected(glb.error());
  }
  return writeFileAtomically(options_.animation, *glb);
}

}  // namespace galactic
