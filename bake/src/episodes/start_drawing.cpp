#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/random.h"
#include "episodes/drawn_episode.h"
#include "episodes/episode_batch.h"
#include "episodes/generation_world.h"
#include "episodes/home/robot_start.h"
#include "episodes/trial/episode_replay.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/bake/parallel_for.h"
#include "support/text/counted.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

/// An episode whose start is being drawn.
struct OpenStart {
  /// Index into the set.
  std::uint32_t number = 0;
  Random random;
  /// Its objects are numbered as in the world.
  DrawnEpisode drawn{};
  bool is_done = false;
};

/// The starts in one scene, and how drawing them went.
struct SceneStarts {
  std::vector<OpenStart> starts{};
  RejectionCounts rejections{};
  /// Why there are none at all; empty if there may be some.
  std::string nowhere{};
};

/// Draws the starts of episodes in one scene.
class StartDrawing {
 public:
  StartDrawing(const GenerationWorld& world, const SceneOfPack& scene)
      : world_(world),
        scene_(scene),
        floor_(scene.scene, world.robot()),
        packs_(world.commonPacks()) {
    packs_.push_back(scene.pack);
  }

  /// Fails with the errors of replayEpisodes.
  Result<void> fill(SceneStarts& scene, const std::function<bool()>& stops) const {
    if (floor_.places().empty()) {
      scene.nowhere = whyNowhere(floor_, world_.robot());
      return {};
    }
    std::vector<OpenStart*> batch;
    for (OpenStart& one : scene.starts) {
      batch.push_back(&one);
      if (batch.size() < EpisodeBatch::kMost && &one != &scene.starts.back()) continue;
      if (stops && stops()) return {};
      RETURN_IF_ERROR(fillBatch(std::move(batch), scene.rejections));
      batch.clear();
    }
    return {};
  }

 private:
  /// Draws until all episodes start and stay still in the runtime, too, or have no place.
  Result<void> fillBatch(std::vector<OpenStart*> open, RejectionCounts& rejections) const {
    // As many replays as a generated episode has drafts.
    constexpr int kReplays = 150;
    for (int n = 0; n < kReplays && !open.empty(); ++n) {
      std::erase_if(open, [&](OpenStart* one) { return !draw(*one, rejections); });
      if (open.empty()) break;
      const SceneOfPack* const scene = &scene_;
      SourceEpisodes set = emptySet(world_, {&scene, 1});
      for (const OpenStart* one : open) append(one->drawn, 0, set);
      ASSIGN_OR_RETURN(const auto ends, replayEpisodes(packs_, set));
      for (std::size_t k = 0; k < open.size(); ++k) {
        open[k]->is_done = ends[k] == ReplayEnd::kStands;
        if (open[k]->is_done) continue;
        rejections.add(ends[k] == ReplayEnd::kBlocked ? EpisodeRejection::kReplayBlocked
                                                      : EpisodeRejection::kReplayMoved);
      }
      std::erase_if(open, [](const OpenStart* one) { return one->is_done; });
    }
    return {};
  }

  bool draw(OpenStart& one, RejectionCounts& rejections) const {
    std::vector<PlacedObject> objects;
    objects.reserve(one.drawn.placements.size());
    for (const Placement& placement : one.drawn.placements) {
      objects.push_back({.model = &world_.objects()[placement.object],
                         .object = placement.object,
                         .pose = placement.pose,
                         .footprint = {}});
    }
    const auto start = drawStart(
        {scene_.scene, world_.robot(), floor_},
        {.target = objects[one.drawn.episode.target].pose.translation, .objects = objects},
        one.random, rejections);
    if (start) setStart(*start, one.drawn.episode);
    return start.has_value();
  }

  const GenerationWorld& world_;
  const SceneOfPack& scene_;
  const FloorMap floor_;
  std::vector<const PackFile*> packs_;
};

/// The number in the world of each object of the set.
Result<std::vector<std::uint32_t>> objectNumbers(const GenerationWorld& world,
                                                 const SourceEpisodes& episodes) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(episodes.objects.size());
  for (const std::string& name : episodes.objects) {
    const auto at = std::ranges::lower_bound(world.objects(), name, {}, &ObjectModel::name);
    if (at == world.objects().end() || at->name != name) {
      return fail(ErrorCode::kInvalidInput, episodes.name,
                  fmt::format("places the object {}, which none of the packs holds; give its pack, "
                              "too",
                              name));
    }
    numbers.push_back(static_cast<std::uint32_t>(at - world.objects().begin()));
  }
  return numbers;
}

Result<const SceneOfPack*> sceneNamed(const GenerationWorld& world, const std::string& name,
                                      const std::string& set) {
  const auto name_of = [](const SceneOfPack& one) { return one.scene.name(); };
  const auto at = std::ranges::lower_bound(world.scenes(), std::string_view(name), {}, name_of);
  if (at != world.scenes().end() && at->scene.name() == name) return &*at;
  return fail(ErrorCode::kInvalidInput, set,
              fmt::format("has episodes in the scene {}, which none of the packs holds; give its "
                          "pack, too, or name it with `scene-name` {}=NAME",
                          name, name));
}

/// The episodes without a start, by the number of their scene in the set. Their objects are
/// numbered as in the world, and each has its own stream of random numbers, which depends on the
/// seed and on the episode's number in the set.
std::map<std::uint32_t, SceneStarts> openStarts(const SourceEpisodes& episodes,
                                                std::span<const std::uint32_t> object_numbers,
                                                std::uint64_t seed) {
  std::map<std::uint32_t, SceneStarts> scenes;
  Random seeds(seed);
  auto next = episodes.without_start.begin();
  for (std::uint32_t n = 0; n < episodes.episodes.size(); ++n) {
    const std::uint64_t own_seed = seeds.next();
    if (next == episodes.without_start.end() || *next != n) continue;
    ++next;
    const Episode& episode = episodes.episodes[n];
    OpenStart start{.number = n, .random = Random(own_seed)};
    start.drawn.episode = episode;
    const auto placements =
        std::span(episodes.placements).subspan(episode.first_placement, episode.placement_count);
    for (const Placement& placement : placements) {
      start.drawn.placements.push_back({object_numbers[placement.object], placement.pose});
    }
    scenes[episode.scene].starts.push_back(std::move(start));
  }
  return scenes;
}

/// Removes these episodes (ascending numbers) and their placements from the set.
void takeOut(std::span<const std::uint32_t> numbers, SourceEpisodes& episodes) {
  std::vector<Episode> kept;
  std::vector<Placement> placements;
  for (std::uint32_t n = 0; n < episodes.episodes.size(); ++n) {
    if (std::ranges::binary_search(numbers, n)) continue;
    Episode& episode = kept.emplace_back(episodes.episodes[n]);
    const auto own =
        std::span(episodes.placements).subspan(episode.first_placement, episode.placement_count);
    episode.first_placement = static_cast<std::uint32_t>(placements.size());
    placements.insert(placements.end(), own.begin(), own.end());
  }
  episodes.episodes = std::move(kept);
  episodes.placements = std::move(placements);
}

/// Puts the starts that were drawn into the set. Removes episodes for which there is none, and adds
/// a warning.
Result<void> takeOver(const std::map<std::uint32_t, SceneStarts>& scenes, const Robot& robot,
                      SourceEpisodes& episodes) {
  std::vector<std::uint32_t> left_out;
  RejectionCounts rejections;
  std::string nowhere;
  for (const auto& [scene, drawn] : scenes) {
    rejections.add(drawn.rejections);
    if (nowhere.empty() && !drawn.nowhere.empty()) {
      nowhere = fmt::format("; in the scene {} {}", episodes.scenes[scene], drawn.nowhere);
    }
    for (const OpenStart& start : drawn.starts) {
      Episode& episode = episodes.episodes[start.number];
      episode.base_position = start.drawn.episode.base_position;
      episode.base_yaw = start.drawn.episode.base_yaw;
      if (!start.is_done) left_out.push_back(start.number);
    }
  }
  episodes.robot = std::string(robot.name());
  episodes.without_start.clear();
  if (left_out.empty()) return {};
  const std::size_t all = episodes.episodes.size();
  std::string why = fmt::format("no start of the robot {} was found (drawn and not taken: {}){}",
                                robot.name(), textOf(rejections), nowhere);
  if (left_out.size() == all) {
    return fail(ErrorCode::kInvalidInput, episodes.name,
                fmt::format("can be played in none of {}: {}; check that scenes, objects and "
                            "episodes belong together",
                            counted(all, "episode"), why));
  }
  std::ranges::sort(left_out);
  takeOut(left_out, episodes);
  episodes.warnings.push_back(
      fmt::format("{} of {} episodes are left out: {}", left_out.size(), all, why));
  return {};
}

}  // namespace

Result<void> drawStarts(const EpisodeInputs& inputs, std::uint64_t seed, SourceEpisodes& episodes) {
  if (episodes.without_start.empty()) return {};
  ASSIGN_OR_RETURN(const auto world, GenerationWorld::open(inputs.packs));
  ASSIGN_OR_RETURN(const auto numbers, objectNumbers(world, episodes));
  auto open = openStarts(episodes, numbers, seed);
  std::vector<std::pair<const SceneOfPack*, SceneStarts*>> work;
  work.reserve(open.size());
  for (auto& [scene, starts] : open) {
    ASSIGN_OR_RETURN(const SceneOfPack* const found,
                     sceneNamed(world, episodes.scenes[scene], episodes.name));
    work.emplace_back(found, &starts);
  }
  std::vector<Result<void>> results(work.size());
  parallelFor(std::max(1U, inputs.threads), work.size(), [&](std::size_t n) {
    if (inputs.stops && inputs.stops()) return;
    results[n] = StartDrawing(world, *work[n].first).fill(*work[n].second, inputs.stops);
  });
  for (const Result<void>& result : results) {
    if (!result) return result;
  }
  if (inputs.stops && inputs.stops()) {
    return fail(ErrorCode::kInterrupted, "episodes", "interrupted while starts were drawn");
  }
  return takeOver(open, world.robot(), episodes);
}

}  // namespace galactic::bake
