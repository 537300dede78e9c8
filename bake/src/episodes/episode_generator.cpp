#include "galactic/bake/episode_generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/random.h"
#include "episodes/drawn_episode.h"
#include "episodes/episode_drawing.h"
#include "episodes/generation_options.h"
#include "episodes/scene_journal.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Why an episode was skipped, and what may help.
std::string whySkipped(const DrawnEpisode& episode, const GeneratedScene& scene,
                       const EpisodeGeneratorOptions& options) {
  const auto ended = [&](DraftEnd end) { return episode.ends[static_cast<std::size_t>(end)]; };
  return fmt::format(
      "episode {} found no place in any of {} drafts: {} ended at the target, {} at a "
      "goal {} away{}, {} at {} to {} other objects, {} at the robot's start, {} "
      "in the replay; drawn and not taken: {}; there are {} support places on {} surfaces "
      "and {} floor places: ask for fewer objects, other distances or other heights",
      episode.number, episode.drafts, ended(DraftEnd::kTarget), ended(DraftEnd::kGoal),
      textOf(DistanceRange{scene.shortened_way.value_or(options.target_to_goal.least),
                           options.target_to_goal.most}),
      options.goal_on_other_support ? " on another surface" : "", ended(DraftEnd::kOthers),
      options.objects.least - 1, options.objects.most - 1, ended(DraftEnd::kStart),
      episode.replays_failed, textOf(episode.rejections), scene.support_places, scene.surfaces,
      scene.floor_places);
}

/// Moves the scenes that turned out to be unusable from `scenes` to the list of those left out.
void takeOut(std::vector<UnusableScene> unusable, std::vector<const SceneOfPack*>& scenes,
             std::vector<UnusableScene>& left_out) {
  for (UnusableScene& scene : unusable) {
    std::erase_if(scenes, [&](const SceneOfPack* one) { return one->scene.name() == scene.name; });
    left_out.push_back(std::move(scene));
  }
}

/// The error for a set of scenes none of which is usable.
Error noScene(const std::vector<UnusableScene>& left_out) {
  const UnusableScene& first = left_out.front();
  std::string others;
  if (left_out.size() == 2) others = "; the other scene cannot be used either";
  if (left_out.size() > 2) {
    others = fmt::format("; none of the {} other scenes can be used either", left_out.size() - 1);
  }
  return {ErrorCode::kInvalidInput, first.name, first.reason + others};
}

/// The scenes of the split. Fails if there are none.
Result<std::vector<const SceneOfPack*>> scenesOf(const GenerationWorld& world,
                                                 const SceneSplit& split) {
  std::vector<const SceneOfPack*> scenes;
  scenes.reserve(world.scenes().size());
  for (const SceneOfPack& one : world.scenes()) {
    const bool for_validation = split.side != SplitSide::kAll && isHeldOut(one.scene.name(), split);
    const bool wanted =
        split.side == SplitSide::kAll || for_validation == (split.side == SplitSide::kValidation);
    if (wanted) scenes.push_back(&one);
  }
  if (!scenes.empty()) return scenes;
  return fail(ErrorCode::kInvalidInput, "episodes",
              fmt::format("none of the {} scenes is for {} when {} of them are held out with seed "
                          "{}; give more scenes, another share or another seed",
                          world.scenes().size(),
                          split.side == SplitSide::kTrain ? "training" : "validation",
                          split.held_out, split.seed));
}

/// Deals the episodes to the scenes, one after the other.
std::vector<DealtScene> dealEpisodes(std::span<const SceneOfPack* const> scenes,
                                     const EpisodeGeneratorOptions& options) {
  std::vector<DealtScene> deal(std::min<std::size_t>(scenes.size(), options.episodes));
  for (std::size_t n = 0; n < deal.size(); ++n) {
    deal[n].scene = scenes[n];
    deal[n].episodes.reserve(options.episodes / deal.size() + 1);
  }
  Random seeds(options.seed);
  for (std::size_t n = 0; n < options.episodes; ++n) {
    deal[n % deal.size()].episodes.push_back({.number = n, .seed = seeds.next()});
  }
  return deal;
}

/// Fails if more episodes were skipped than is allowed.
Result<void> checkSkipped(std::span<const DrawnScene> scenes,
                          const EpisodeGeneratorOptions& options) {
  std::size_t skipped = 0;
  const DrawnScene* worst = &scenes.front();
  for (const DrawnScene& scene : scenes) {
    skipped += scene.summary.skipped;
    if (scene.summary.skipped > worst->summary.skipped) worst = &scene;
  }
  const auto most = static_cast<double>(options.most_skipped) * options.episodes;
  if (static_cast<double>(skipped) <= most && skipped < options.episodes) return {};
  const auto first = std::ranges::find_if(worst->episodes, &DrawnEpisode::is_skipped);
  return fail(
      ErrorCode::kInvalidInput, worst->summary.name,
      fmt::format("{} of {} episodes found no place, a share of {} may be skipped; {} of them in "
                  "this scene: {}",
                  skipped, options.episodes, options.most_skipped, worst->summary.skipped,
                  whySkipped(*first, worst->summary, options)));
}

/// Removes from `scenes` those that an interrupted generation found unusable, so that no episodes
/// are dealt to them.
Result<void> takeOutKnown(const EpisodeInputs& inputs, const SceneJournal& journal,
                          std::vector<const SceneOfPack*>& scenes,
                          std::vector<UnusableScene>& left_out) {
  std::vector<const SceneOfPack*> usable;
  usable.reserve(scenes.size());
  for (const SceneOfPack* const scene : scenes) {
    const std::string_view name = scene->scene.name();
    const SceneLook* look = nullptr;
    if (journal.hasUnusable(name)) {
      ASSIGN_OR_RETURN(const SceneDetails details, detailsOf(inputs, *scene));
      look = journal.lookAt(SceneJournal::keyOf(name, details));
    }
    if (look == nullptr || look->unusable.empty()) {
      usable.push_back(scene);
    } else {
      left_out.push_back({std::string(name), look->unusable});
    }
  }
  scenes = std::move(usable);
  return {};
}

/// Deals the episodes to the scenes and draws them, and starts over without the scenes that turn
/// out to be unusable: the deal depends only on the usable ones.
Result<std::vector<DrawnScene>> drawInUsable(const EpisodeInputs& inputs,
                                             const GenerationContext& context,
                                             const EpisodeProgress& progress,
                                             std::vector<const SceneOfPack*>& scenes,
                                             std::vector<UnusableScene>& left_out) {
  const SceneJournal journal(inputs.journal, context.world.objects().size());
  RETURN_IF_ERROR(takeOutKnown(inputs, journal, scenes, left_out));
  while (!scenes.empty()) {
    EpisodeDrawing drawing(inputs, context, journal, progress);
    ASSIGN_OR_RETURN(auto outcome, drawing.run(dealEpisodes(scenes, context.options)));
    if (auto* drawn = std::get_if<std::vector<DrawnScene>>(&outcome)) {
      RETURN_IF_ERROR(checkSkipped(*drawn, context.options));
      return std::move(*drawn);
    }
    takeOut(std::get<std::vector<UnusableScene>>(std::move(outcome)), scenes, left_out);
  }
  std::ranges::sort(left_out, {}, &UnusableScene::name);
  return tl::unexpected(noScene(left_out));
}

/// The first of `drawn` is in the first of `scenes`, and so on.
GeneratedEpisodes gather(const GenerationWorld& world, std::span<const SceneOfPack* const> scenes,
                         std::span<const DrawnScene> drawn, std::uint32_t least_objects) {
  GeneratedEpisodes generated;
  generated.episodes = emptySet(world, scenes);
  std::size_t count = 0;
  generated.scenes.reserve(drawn.size());
  for (const DrawnScene& scene : drawn) {
    generated.scenes.push_back(scene.summary);
    generated.skipped += scene.summary.skipped;
    count += scene.episodes.size();
  }
  generated.episodes.episodes.reserve(count - generated.skipped);
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t scene = n % drawn.size();
    const DrawnEpisode& episode = drawn[scene].episodes[n / drawn.size()];
    generated.rejections.add(episode.rejections);
    if (episode.is_skipped) continue;
    append(episode, static_cast<std::uint32_t>(scene), generated.episodes);
    generated.with_fewer_objects += episode.placements.size() < least_objects ? 1U : 0U;
  }
  return generated;
}

/// Warns, with the option that would help, if hardly any place is flat enough or far enough from
/// another.
void adviseOn(const EpisodeGeneratorOptions& options, GeneratedEpisodes& generated) {
  // If there would be this many times as many places, the surfaces are bumpy rather than small.
  constexpr std::size_t kManyMore = 2;
  constexpr std::uint64_t kManyDrafts = 100;
  std::vector<std::string>& warnings = generated.episodes.warnings;
  for (const GeneratedScene& scene : generated.scenes) {
    if (scene.bumpy_places < kManyMore * scene.support_places) continue;
    warnings.push_back(fmt::format(
        "scene {}: objects stand at {} places on {} surfaces, which are flat to {} m; with "
        "`flatness` {}, as scans need it, there are {}",
        scene.name, scene.support_places, scene.surfaces, options.flatness, kScanFlatness,
        scene.bumpy_places));
  }
  std::uint64_t all = 0;
  for (std::size_t n = 0; n < kRejectionCount; ++n) {
    all += generated.rejections[static_cast<EpisodeRejection>(n)];
  }
  const std::uint64_t by_distance = generated.rejections[EpisodeRejection::kDistance];
  const bool is_most = by_distance > all / 3 * 2;
  // For these scenes another warning says that the distance is shorter there.
  const bool are_shortened = std::ranges::all_of(
      generated.scenes, [](const GeneratedScene& one) { return one.shortened_way.has_value(); });
  if (!is_most || are_shortened || by_distance < kManyDrafts * options.episodes) return;
  warnings.push_back(fmt::format(
      "{} of {} places drawn and not taken were goals that are not {} away from their targets: "
      "with a {} `goal-distance` episodes are drawn sooner and use more places",
      by_distance, all, textOf(options.target_to_goal),
      std::isfinite(options.target_to_goal.most) ? "wider" : "shorter"));
}

/// Warns of everything that is not as requested.
void warn(const EpisodeGeneratorOptions& options, GeneratedEpisodes& generated) {
  std::vector<std::string>& warnings = generated.episodes.warnings;
  for (const UnusableScene& scene : generated.left_out) {
    warnings.push_back(fmt::format("scene {} is left out: {}", scene.name, scene.reason));
  }
  for (const GeneratedScene& scene : generated.scenes) {
    if (scene.shortened_way) {
      warnings.push_back(
          fmt::format("scene {} is too small for goals {} m away: they are {:.2f} m away at least",
                      scene.name, options.target_to_goal.least, *scene.shortened_way));
    }
    if (scene.skipped == 0) continue;
    warnings.push_back(fmt::format("scene {}: {} of {} episodes found no place and are skipped",
                                   scene.name, scene.skipped, scene.skipped + scene.episodes));
  }
  if (generated.with_fewer_objects == 0) return;
  warnings.push_back(fmt::format("{} episodes have fewer than {} objects: no more found a place",
                                 generated.with_fewer_objects, options.objects.least));
}

}  // namespace

Result<GeneratedEpisodes> generateEpisodes(const EpisodeInputs& inputs,
                                           const EpisodeGeneratorOptions& options,
                                           const EpisodeProgress& progress) {
  RETURN_IF_ERROR(checkOptions(options));
  ASSIGN_OR_RETURN(const auto world, GenerationWorld::open(inputs.packs));
  ASSIGN_OR_RETURN(auto scenes, scenesOf(world, options.split));
  ASSIGN_OR_RETURN(const auto bodies,
                   inputs.details ? world.settlingBodies() : Result<std::vector<SettlingBody>>{});
  const ArmReach reach(world.robot());
  const GenerationContext context{world, reach, bodies, options};
  std::vector<UnusableScene> left_out;
  ASSIGN_OR_RETURN(const auto drawn, drawInUsable(inputs, context, progress, scenes, left_out));
  GeneratedEpisodes generated = gather(world, scenes, drawn, options.objects.least);
  std::ranges::sort(left_out, {}, &UnusableScene::name);
  generated.left_out = std::move(left_out);
  warn(options, generated);
  adviseOn(options, generated);
  return generated;
}

}  // namespace galactic::bake
