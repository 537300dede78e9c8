#include "galactic/bake/episode_generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "episodes/generation_options.h"
#include "episodes/home/prepared_scene.h"
#include "episodes/trial/episode_replay.h"
#include "galactic/bake/parallel_for.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// Put between the floor and the base's point on it, meters, so that rounding never leaves the
/// point under the floor; far below what the run counts as a step.
constexpr float kFloorMargin = 1e-4F;
/// Drafts of one episode: so many with places drawn anywhere, then near places that are known to
/// hold objects, then with fewer objects; after the last of them it is skipped.
constexpr std::uint32_t kDraftsAnywhere = 50;
constexpr std::uint32_t kDraftsWithAll = 100;
constexpr std::uint32_t kDrafts = 150;
/// Episodes that are replayed together: enough for the simulator's chunks, few enough for threads
/// to share a scene's episodes.
constexpr std::size_t kBatch = 64;
constexpr std::size_t kDraftEnds = 5;

void append(const DraftedEpisode& drafted, std::uint32_t scene, SourceEpisodes& episodes) {
  Episode episode{.scene = scene,
                  .first_placement = static_cast<std::uint32_t>(episodes.placements.size()),
                  .placement_count = static_cast<std::uint32_t>(drafted.objects.size()),
                  .target = drafted.target,
                  .base_position = drafted.base_position,
                  .base_yaw = drafted.base_yaw,
                  .goal = drafted.goal.pose};
  episode.base_position.y += kFloorMargin;
  for (const PlacedObject& object : drafted.objects) {
    episodes.placements.push_back({.object = object.object, .pose = object.pose});
  }
  episodes.episodes.push_back(episode);
}

/// Names, but no episodes.
SourceEpisodes emptySet(const GenerationWorld& world, std::span<const SceneOfPack* const> scenes) {
  SourceEpisodes set;
  set.name = std::string(scenes.front()->scene.name());
  set.robot = std::string(world.robot().name());
  set.scenes.reserve(scenes.size());
  for (const SceneOfPack* one : scenes) set.scenes.emplace_back(one->scene.name());
  set.objects.reserve(world.objects().size());
  for (const ObjectModel& model : world.objects()) set.objects.emplace_back(model.name);
  return set;
}

/// An episode in the making.
struct PendingEpisode {
  /// Which one of all.
  std::size_t number = 0;
  /// Its own stream, so that no episode depends on another.
  Random random{0};
  DraftedEpisode episode;
  bool is_done = false;
  bool is_skipped = false;
  std::uint32_t drafts = 0;
  std::uint32_t replays_failed = 0;
  /// How many drafts ended at each part.
  std::array<std::uint32_t, kDraftEnds> ends{};
  RejectionCounts rejections;
};

/// Draws the episodes of one batch in a scene and replays them until all stand.
class EpisodeBatch {
 public:
  EpisodeBatch(const GenerationContext& context, const SceneOfPack& scene,
               const PreparedScene& prepared)
      : context_(context),
        scene_(scene),
        home_(prepared.draftHome()),
        packs_(context.world.commonPacks()),
        proven_(prepared.provenPairs()) {
    packs_.push_back(scene.pack);
  }

  Result<void> fill(std::span<PendingEpisode> slots) const {
    std::vector<PendingEpisode*> open;
    open.reserve(slots.size());
    for (PendingEpisode& slot : slots) open.push_back(&slot);
    while (!open.empty()) {
      for (PendingEpisode* slot : open) draw(*slot);
      std::erase_if(open, [](const PendingEpisode* slot) { return slot->is_skipped; });
      if (open.empty()) break;
      if (auto replayed = replay(open); !replayed) return replayed;
      std::erase_if(open, [](const PendingEpisode* slot) { return slot->is_done; });
    }
    return {};
  }

 private:
  /// Drafts until a draft succeeds, or the episode is skipped.
  void draw(PendingEpisode& slot) const {
    while (slot.drafts < kDrafts) {
      DraftEase ease;
      if (slot.drafts >= kDraftsAnywhere) ease.proven = proven_;
      ease.may_lack_objects = slot.drafts >= kDraftsWithAll;
      ++slot.drafts;
      const DraftEnd end = draftEpisode(home_, ease, slot.random, slot.episode, slot.rejections);
      ++slot.ends[static_cast<std::size_t>(end)];
      if (end == DraftEnd::kDone) return;
    }
    slot.is_skipped = true;
  }

  Result<void> replay(std::span<PendingEpisode* const> slots) const {
    const SceneOfPack* const scene = &scene_;
    SourceEpisodes set = emptySet(context_.world, {&scene, 1});
    set.episodes.reserve(slots.size());
    for (const PendingEpisode* slot : slots) append(slot->episode, 0, set);
    ASSIGN_OR_RETURN(const auto ends, replayEpisodes(packs_, set));
    for (std::size_t n = 0; n < slots.size(); ++n) {
      PendingEpisode& slot = *slots[n];
      slot.is_done = ends[n] == ReplayEnd::kStands;
      if (slot.is_done) continue;
      ++slot.replays_failed;
      slot.rejections.add(ends[n] == ReplayEnd::kBlocked ? EpisodeRejection::kReplayBlocked
                                                         : EpisodeRejection::kReplayMoved);
    }
    return {};
  }

  const GenerationContext& context_;
  const SceneOfPack& scene_;
  const DraftHome home_;
  std::vector<const PackFile*> packs_;
  std::span<const ProvenPair> proven_;
};

/// One scene, its part of the episodes and what became of them.
struct SceneTask {
  const SceneOfPack* scene = nullptr;
  std::vector<PendingEpisode> slots;
  GeneratedScene summary;
  /// Why there can be no episodes; empty when there can be.
  std::string unusable;
  /// What came of reading and preparing the scene, and of drawing its episodes.
  Result<void> prepared;
  Result<void> drawn;
};

/// Why an episode was skipped, and what may help.
std::string whySkipped(const PendingEpisode& slot, const SceneTask& task,
                       const EpisodeGeneratorOptions& options) {
  const auto ended = [&slot](DraftEnd end) { return slot.ends[static_cast<std::size_t>(end)]; };
  const GeneratedScene& scene = task.summary;
  return fmt::format(
      "episode {} found no place in any of {} drafts: {} ended at the target, {} at a "
      "goal {} away{}, {} at {} to {} other objects, {} at the robot's start, {} "
      "in the replay; drawn and not taken: {}; there are {} support places on {} surfaces "
      "and {} floor places: ask for fewer objects, other distances or other heights",
      slot.number, slot.drafts, ended(DraftEnd::kTarget), ended(DraftEnd::kGoal),
      textOf(DistanceRange{scene.shortened_way.value_or(options.target_to_goal.least),
                           options.target_to_goal.most}),
      options.goal_on_other_support ? " on another surface" : "", ended(DraftEnd::kOthers),
      options.objects.least - 1, options.objects.most - 1, ended(DraftEnd::kStart),
      slot.replays_failed, textOf(slot.rejections), scene.support_places, scene.surfaces,
      scene.floor_places);
}

/// Calls the user's function, one call at a time.
class Counter {
 public:
  explicit Counter(const EpisodeProgress& progress) : progress_(progress) {}

  void add(std::size_t count) {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    done_ += count;
    progress_(done_);
  }

 private:
  const EpisodeProgress& progress_;
  std::mutex mutex_;
  std::size_t done_ = 0;
};

/// The first failure in the order of `results`.
Result<void> firstFailure(std::span<const Result<void>> results) {
  for (const Result<void>& result : results) {
    if (!result) return result;
  }
  return {};
}

/// Draws episodes in the scenes that they were dealt to.
class GenerationRound {
 public:
  GenerationRound(const EpisodeInputs& inputs, const GenerationContext& context,
                  const EpisodeProgress& progress)
      : inputs_(inputs), context_(context), counter_(progress) {}

  /// Once a scene turns out to be unusable, the episodes will be dealt anew: then the others are
  /// looked at only.
  void run(std::vector<SceneTask>& tasks) {
    const unsigned jobs = std::max(1U, context_.options.jobs);
    const auto for_scenes = static_cast<unsigned>(std::min<std::size_t>(jobs, tasks.size()));
    parallelFor(for_scenes, tasks.size(),
                [&](std::size_t n) { runIn(tasks[n], std::max(1U, jobs / for_scenes)); });
  }

 private:
  /// Prepares the scene, draws its episodes with `jobs` threads, and forgets the scene.
  void runIn(SceneTask& task, unsigned jobs) {
    Result<SceneDetails> details;
    if (inputs_.details) details = inputs_.details(task.scene->scene.name());
    const auto prepared =
        details ? PreparedScene::prepare(context_, task.scene->scene, std::move(*details))
                : tl::unexpected(details.error());
    if (!prepared) {
      task.prepared = tl::unexpected(prepared.error());
      return;
    }
    task.unusable = (*prepared)->unusable();
    if (!task.unusable.empty()) only_look_ = true;
    if (only_look_) return;
    task.summary = (*prepared)->summary();
    task.summary.episodes = static_cast<std::uint32_t>(task.slots.size());
    task.drawn = draw(task, **prepared, jobs);
    for (const PendingEpisode& slot : task.slots) {
      task.summary.skipped += slot.is_skipped ? 1U : 0U;
    }
    task.summary.episodes -= task.summary.skipped;
  }

  Result<void> draw(SceneTask& task, const PreparedScene& prepared, unsigned jobs) {
    const EpisodeBatch batch(context_, *task.scene, prepared);
    std::vector<Result<void>> results((task.slots.size() + kBatch - 1) / kBatch);
    parallelFor(jobs, results.size(), [&](std::size_t n) {
      if (only_look_) return;
      const std::size_t first = n * kBatch;
      const auto slots =
          std::span(task.slots).subspan(first, std::min(kBatch, task.slots.size() - first));
      results[n] = batch.fill(slots);
      counter_.add(slots.size());
    });
    return firstFailure(results);
  }

  const EpisodeInputs& inputs_;
  const GenerationContext& context_;
  Counter counter_;
  std::atomic<bool> only_look_{false};
};

/// Takes the scenes that turned out to be unusable out of `scenes`.
void takeOutUnusable(const std::vector<SceneTask>& tasks, std::vector<const SceneOfPack*>& scenes,
                     std::vector<UnusableScene>& left_out) {
  for (const SceneTask& task : tasks) {
    if (task.unusable.empty()) continue;
    std::erase(scenes, task.scene);
    left_out.push_back({std::string(task.scene->scene.name()), task.unusable});
  }
}

/// The error for a set of scenes none of which can be used.
Error noScene(const std::vector<UnusableScene>& left_out) {
  const UnusableScene& first = left_out.front();
  std::string others;
  if (left_out.size() > 1) {
    others = fmt::format("; none of the {} other scenes can be used either", left_out.size() - 1);
  }
  return {ErrorCode::kInvalidInput, first.name, first.reason + others};
}

/// The scenes of the split. Fails when there are none.
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
std::vector<SceneTask> dealEpisodes(std::span<const SceneOfPack* const> scenes,
                                    const EpisodeGeneratorOptions& options) {
  std::vector<SceneTask> tasks(std::min<std::size_t>(scenes.size(), options.episodes));
  for (std::size_t n = 0; n < tasks.size(); ++n) {
    tasks[n].scene = scenes[n];
    tasks[n].slots.reserve(options.episodes / tasks.size() + 1);
  }
  Random seeds(options.seed);
  for (std::size_t n = 0; n < options.episodes; ++n) {
    PendingEpisode& slot = tasks[n % tasks.size()].slots.emplace_back();
    slot.number = n;
    slot.random = Random(seeds.next());
  }
  return tasks;
}

/// Sees that no more episodes were skipped than may be.
Result<void> checkSkipped(std::span<const SceneTask> tasks,
                          const EpisodeGeneratorOptions& options) {
  std::size_t skipped = 0;
  const SceneTask* worst = &tasks.front();
  for (const SceneTask& task : tasks) {
    skipped += task.summary.skipped;
    if (task.summary.skipped > worst->summary.skipped) worst = &task;
  }
  const auto most = static_cast<double>(options.most_skipped) * options.episodes;
  if (static_cast<double>(skipped) <= most && skipped < options.episodes) return {};
  const auto first = std::ranges::find_if(worst->slots, &PendingEpisode::is_skipped);
  return fail(
      ErrorCode::kInvalidInput, worst->summary.name,
      fmt::format("{} of {} episodes found no place, a share of {} may be skipped; {} of them in "
                  "this scene: {}",
                  skipped, options.episodes, options.most_skipped, worst->summary.skipped,
                  whySkipped(*first, *worst, options)));
}

/// Deals the episodes to the scenes and draws them, until no scene is left that turns out to be
/// unusable: how they are dealt depends on the usable ones only.
Result<std::vector<SceneTask>> drawInUsable(const EpisodeInputs& inputs,
                                            const GenerationContext& context,
                                            const EpisodeProgress& progress,
                                            std::vector<const SceneOfPack*>& scenes,
                                            std::vector<UnusableScene>& left_out) {
  while (!scenes.empty()) {
    std::vector<SceneTask> tasks = dealEpisodes(scenes, context.options);
    GenerationRound(inputs, context, progress).run(tasks);
    for (const SceneTask& task : tasks) {
      if (!task.prepared) return tl::unexpected(task.prepared.error());
    }
    const std::size_t before = left_out.size();
    takeOutUnusable(tasks, scenes, left_out);
    // What was drawn beside an unusable scene, and how far it came, is no matter.
    if (left_out.size() > before) continue;
    for (const SceneTask& task : tasks) {
      if (!task.drawn) return tl::unexpected(task.drawn.error());
    }
    RETURN_IF_ERROR(checkSkipped(tasks, context.options));
    return tasks;
  }
  std::ranges::sort(left_out, {}, &UnusableScene::name);
  return tl::unexpected(noScene(left_out));
}

GeneratedEpisodes gather(const GenerationWorld& world, std::span<const SceneOfPack* const> scenes,
                         std::span<const SceneTask> tasks, std::uint32_t least_objects) {
  GeneratedEpisodes generated;
  generated.episodes = emptySet(world, scenes);
  std::size_t count = 0;
  generated.scenes.reserve(tasks.size());
  for (const SceneTask& task : tasks) {
    generated.scenes.push_back(task.summary);
    generated.skipped += task.summary.skipped;
    count += task.slots.size();
  }
  generated.episodes.episodes.reserve(count - generated.skipped);
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t scene = n % tasks.size();
    const PendingEpisode& slot = tasks[scene].slots[n / tasks.size()];
    generated.rejections.add(slot.rejections);
    if (slot.is_skipped) continue;
    append(slot.episode, static_cast<std::uint32_t>(scene), generated.episodes);
    generated.with_fewer_objects += slot.episode.objects.size() < least_objects ? 1U : 0U;
  }
  return generated;
}

/// Says what is not as it was asked for.
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
  ASSIGN_OR_RETURN(const auto tasks, drawInUsable(inputs, context, progress, scenes, left_out));
  GeneratedEpisodes generated = gather(world, scenes, tasks, options.objects.least);
  std::ranges::sort(left_out, {}, &UnusableScene::name);
  generated.left_out = std::move(left_out);
  warn(options, generated);
  return generated;
}

}  // namespace galactic::bake
