#include "galactic/bake/episode_generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <utility>

#include "episodes/episode_replay.h"
#include "episodes/generation_options.h"
#include "episodes/prepared_scene.h"
#include "galactic/bake/parallel_for.h"

namespace galactic::bake {
namespace {

/// Put between the floor and the base's point on it, metres, so that rounding never leaves the
/// point under the floor; far below what the run counts as a step.
constexpr float kFloorMargin = 1e-4F;
/// Drafts of one episode before it is given up.
constexpr std::uint32_t kDrafts = 50;
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
struct Slot {
  /// Which one of all.
  std::size_t number = 0;
  /// Its own stream, so that no episode depends on another.
  Random random{0};
  DraftedEpisode episode;
  bool is_done = false;
  std::uint32_t drafts = 0;
  std::uint32_t replays_failed = 0;
  /// How many drafts ended at each part.
  std::array<std::uint32_t, kDraftEnds> ends{};
  RejectionCounts rejections;
};

/// Draws the episodes of one batch in a scene and replays them until all stand.
class Batch {
 public:
  Batch(const GenerationContext& context, const SceneOfPack& scene, const Stage& stage)
      : context_(context), scene_(scene), stage_(stage), packs_(context.world.commonPacks()) {
    packs_.push_back(scene.pack);
  }

  Result<void> fill(std::span<Slot> slots) const {
    std::vector<Slot*> open;
    open.reserve(slots.size());
    for (Slot& slot : slots) open.push_back(&slot);
    while (!open.empty()) {
      for (Slot* slot : open) {
        if (auto drawn = draw(*slot); !drawn) return drawn;
      }
      if (auto replayed = replay(open); !replayed) return replayed;
      std::erase_if(open, [](const Slot* slot) { return slot->is_done; });
    }
    return {};
  }

 private:
  /// Drafts until a draft succeeds.
  Result<void> draw(Slot& slot) const {
    while (slot.drafts < kDrafts) {
      ++slot.drafts;
      const DraftEnd end = draftEpisode(stage_, slot.random, slot.episode, slot.rejections);
      ++slot.ends[static_cast<std::size_t>(end)];
      if (end == DraftEnd::kDone) return {};
    }
    return tl::unexpected(noEpisode(slot));
  }

  Result<void> replay(std::span<Slot* const> slots) const {
    const SceneOfPack* const scene = &scene_;
    SourceEpisodes set = emptySet(context_.world, {&scene, 1});
    set.episodes.reserve(slots.size());
    for (const Slot* slot : slots) append(slot->episode, 0, set);
    const auto ends = replayEpisodes(packs_, set);
    if (!ends) return tl::unexpected(ends.error());
    for (std::size_t n = 0; n < slots.size(); ++n) {
      Slot& slot = *slots[n];
      slot.is_done = (*ends)[n] == ReplayEnd::kStands;
      if (slot.is_done) continue;
      ++slot.replays_failed;
      slot.rejections.add((*ends)[n] == ReplayEnd::kBlocked ? EpisodeRejection::kReplayBlocked
                                                            : EpisodeRejection::kReplayMoved);
    }
    return {};
  }

  [[nodiscard]] Error noEpisode(const Slot& slot) const {
    const auto ended = [&slot](DraftEnd end) { return slot.ends[static_cast<std::size_t>(end)]; };
    const EpisodeGeneratorOptions& options = context_.options;
    return {ErrorCode::kInvalidInput, std::string(scene_.scene.name()),
            fmt::format(
                "episode {} found no place in any of {} drafts: {} ended at the target, {} at a "
                "goal {} to {} m away{}, {} at {} to {} other objects, {} at the robot's start, {} "
                "in the replay; there are {} support places on {} surfaces and {} floor places: "
                "ask for fewer objects, other distances or other heights",
                slot.number, slot.drafts, ended(DraftEnd::kTarget), ended(DraftEnd::kGoal),
                options.target_to_goal.least, options.target_to_goal.most,
                options.goal_on_other_support ? " on another surface" : "",
                ended(DraftEnd::kOthers), options.objects.least - 1, options.objects.most - 1,
                ended(DraftEnd::kStart), slot.replays_failed, stage_.supports.places().size(),
                stage_.supports.surfaceCount(), stage_.floor.places().size())};
  }

  const GenerationContext& context_;
  const SceneOfPack& scene_;
  const Stage& stage_;
  std::vector<const PackFile*> packs_;
};

/// One scene, its part of the episodes and what became of them.
struct SceneTask {
  const SceneOfPack* scene = nullptr;
  std::vector<Slot> slots;
  GeneratedScene summary;
  Result<void> result;
};

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

/// Prepares the scene, draws its episodes with `jobs` threads, and forgets the scene.
Result<void> generateIn(const GenerationContext& context, SceneDetails details, unsigned jobs,
                        SceneTask& task, Counter& counter) {
  const auto prepared = PreparedScene::prepare(context, task.scene->scene, std::move(details));
  if (!prepared) return tl::unexpected(prepared.error());
  task.summary = (*prepared)->summary();
  task.summary.episodes = static_cast<std::uint32_t>(task.slots.size());
  const Stage stage = (*prepared)->stage();
  const Batch batch(context, *task.scene, stage);
  std::vector<Result<void>> results((task.slots.size() + kBatch - 1) / kBatch);
  parallelFor(jobs, results.size(), [&](std::size_t n) {
    const std::size_t first = n * kBatch;
    const auto slots =
        std::span(task.slots).subspan(first, std::min(kBatch, task.slots.size() - first));
    results[n] = batch.fill(slots);
    counter.add(slots.size());
  });
  return firstFailure(results);
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
    Slot& slot = tasks[n % tasks.size()].slots.emplace_back();
    slot.number = n;
    slot.random = Random(seeds.next());
  }
  return tasks;
}

GeneratedEpisodes gather(const GenerationWorld& world, std::span<const SceneOfPack* const> scenes,
                         std::span<const SceneTask> tasks) {
  GeneratedEpisodes generated{.episodes = emptySet(world, scenes), .rejections = {}, .scenes = {}};
  std::size_t count = 0;
  generated.scenes.reserve(tasks.size());
  for (const SceneTask& task : tasks) {
    generated.scenes.push_back(task.summary);
    count += task.slots.size();
  }
  generated.episodes.episodes.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t scene = n % tasks.size();
    const Slot& slot = tasks[scene].slots[n / tasks.size()];
    append(slot.episode, static_cast<std::uint32_t>(scene), generated.episodes);
    generated.rejections.add(slot.rejections);
  }
  return generated;
}

}  // namespace

Result<GeneratedEpisodes> generateEpisodes(const EpisodeInputs& inputs,
                                           const EpisodeGeneratorOptions& options,
                                           const EpisodeProgress& progress) {
  if (auto checked = checkOptions(options); !checked) return tl::unexpected(checked.error());
  const auto world = GenerationWorld::open(inputs.packs);
  if (!world) return tl::unexpected(world.error());
  const auto scenes = scenesOf(*world, options.split);
  if (!scenes) return tl::unexpected(scenes.error());
  const auto bodies =
      inputs.details ? world->settlingBodies() : Result<std::vector<SettlingBody>>{};
  if (!bodies) return tl::unexpected(bodies.error());
  const ArmReach reach(world->robot());
  const GenerationContext context{*world, reach, *bodies, options};
  std::vector<SceneTask> tasks = dealEpisodes(*scenes, options);
  const auto jobs_for_scenes =
      static_cast<unsigned>(std::min<std::size_t>(std::max(1U, options.jobs), tasks.size()));
  const unsigned jobs_in_scene = std::max(1U, options.jobs / jobs_for_scenes);
  Counter counter(progress);
  parallelFor(jobs_for_scenes, tasks.size(), [&](std::size_t n) {
    SceneTask& task = tasks[n];
    Result<SceneDetails> details;
    if (inputs.details) details = inputs.details(task.scene->scene.name());
    task.result = details ? generateIn(context, std::move(*details), jobs_in_scene, task, counter)
                          : tl::unexpected(details.error());
  });
  for (const SceneTask& task : tasks) {
    if (!task.result) return tl::unexpected(task.result.error());
  }
  return gather(*world, *scenes, tasks);
}

}  // namespace galactic::bake
