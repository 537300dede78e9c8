#include "galactic/bake/episode_sampler.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "episodes/episode_draft.h"

namespace galactic::bake {
namespace {

/// Put between the floor and the base's point on it, metres, so that rounding never leaves the
/// point under the floor; far below what the run counts as a step.
constexpr float kFloorMargin = 1e-4F;

Result<void> checkOptions(const EpisodeSamplerOptions& options) {
  const auto refuse = [](std::string message) {
    return fail(ErrorCode::kInvalidInput, "episodes", std::move(message));
  };
  if (options.episodes == 0) return refuse("0 episodes are asked for; ask for at least 1");
  if (options.objects == 0) return refuse("0 objects are asked for; an episode needs at least 1");
  if (!(options.lowest < options.highest) || !std::isfinite(options.lowest) ||
      !std::isfinite(options.highest)) {
    return refuse(fmt::format("heights from {} to {} m are no range; give the lower one first",
                              options.lowest, options.highest));
  }
  if (!(options.least_distance >= 0) || !std::isfinite(options.least_distance)) {
    return refuse(fmt::format("the least distance of target and goal is {} m; give 0 or more",
                              options.least_distance));
  }
  return {};
}

bool sameRadii(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

std::string listOf(std::span<const float> radii) {
  return fmt::format("{}", fmt::join(radii, ", "));
}

Result<void> checkRobot(const Robot& robot) {
  const auto refuse = [&](std::string_view what) {
    return fail(ErrorCode::kInvalidInput, std::string(robot.name()),
                fmt::format("the robot has no {}; bake it with a recipe that gives it one", what));
  };
  if (!robot.base()) return refuse("base");
  if (!robot.endEffector()) return refuse("end effector");
  if (robot.spheres().empty()) return refuse("spheres");
  return {};
}

Result<void> checkRadii(const Scene& scene, const ObjectSet& objects, const Robot& robot) {
  std::vector<float> radii;
  for (const ColumnGrid& grid : scene.grids()) radii.push_back(grid.radius());
  const auto refuse = [&](std::string_view other, std::span<const float> found) {
    return fail(ErrorCode::kInvalidInput, std::string(scene.name()),
                fmt::format("the scene is baked for spheres of {} m, the {} for {} m; bake all "
                            "with the same --radii",
                            listOf(radii), other, listOf(found)));
  };
  if (radii.empty()) {
    return fail(ErrorCode::kInvalidInput, std::string(scene.name()), "the scene has no grids");
  }
  if (!sameRadii(radii, robot.radii())) return refuse("robot", robot.radii());
  if (!sameRadii(radii, objects.radii())) return refuse("objects", objects.radii());
  return {};
}

/// By name: the order in which a pack lists them. Refuses equal names.
Result<std::vector<const Scene*>> byName(std::span<const Scene> scenes) {
  if (scenes.empty()) {
    return fail(ErrorCode::kInvalidInput, "episodes", "no scene is given; give at least one");
  }
  std::vector<const Scene*> sorted;
  sorted.reserve(scenes.size());
  for (const Scene& scene : scenes) sorted.push_back(&scene);
  const auto name = [](const Scene* scene) { return scene->name(); };
  std::ranges::sort(sorted, {}, name);
  const auto twice = std::ranges::adjacent_find(sorted, {}, name);
  if (twice != sorted.end()) {
    return fail(ErrorCode::kInvalidInput, std::string((*twice)->name()),
                "two scenes have this name; give scenes of different names");
  }
  return sorted;
}

/// Samples the episodes of one scene after the other.
class Sampler {
 public:
  Sampler(const ObjectSet& objects, const Robot& robot, const EpisodeSamplerOptions& options)
      : objects_(objects), robot_(robot), options_(options), reach_(robot) {
    Random seeds(options.seed);
    streams_.reserve(options.episodes);
    for (std::uint32_t n = 0; n < options.episodes; ++n) streams_.emplace_back(seeds.next());
    drafted_.resize(options.episodes);
  }

  /// Samples episodes first, first + step and so on in this scene.
  Result<void> sampleScene(const Scene& scene, std::size_t first, std::size_t step) {
    const FloorMap floor(scene, robot_);
    if (floor.places().empty()) {
      return fail(ErrorCode::kInvalidInput, std::string(scene.name()),
                  fmt::format("the robot {} stands nowhere: {} places on the floor were tried in "
                              "{} headings each, and in its start pose one of its {} spheres was "
                              "blocked at each; give a larger scene or a smaller start pose",
                              robot_.name(), floor.tried(), kHeadings, robot_.spheres().size()));
    }
    const SupportPlaces supports(scene, floor, reach_, options_);
    if (supports.places().empty()) {
      return fail(
          ErrorCode::kInvalidInput, std::string(scene.name()),
          fmt::format("no flat surface between {} and {} m over the floor is within reach "
                      "of the {} places to which the robot {} can drive; change the heights "
                      "or the robot's start pose",
                      options_.lowest, options_.highest, floor.places().size(), robot_.name()));
    }
    const Stage stage{scene, objects_, robot_, floor, reach_, supports, options_};
    for (std::size_t n = first; n < drafted_.size(); n += step) {
      DraftFailures failures;
      auto episode = draftEpisode(stage, streams_[n], failures);
      if (!episode) return tl::unexpected(noEpisode(stage, n, failures));
      drafted_[n] = std::move(*episode);
    }
    return {};
  }

  [[nodiscard]] const std::vector<DraftedEpisode>& drafted() const { return drafted_; }

 private:
  [[nodiscard]] Error noEpisode(const Stage& stage, std::size_t episode,
                                const DraftFailures& failures) const {
    return {ErrorCode::kInvalidInput, std::string(stage.scene.name()),
            fmt::format("episode {} found no place in any of {} drafts: {} ended at the target, {} "
                        "at a goal {} m away, {} at the other {} objects, {} at the robot's start; "
                        "there are {} support places and {} floor places: ask for fewer objects, a "
                        "shorter distance or other heights",
                        episode, failures.target + failures.goal + failures.others + failures.start,
                        failures.target, failures.goal, options_.least_distance, failures.others,
                        options_.objects - 1, failures.start, stage.supports.places().size(),
                        stage.floor.places().size())};
  }

  const ObjectSet& objects_;
  const Robot& robot_;
  const EpisodeSamplerOptions& options_;
  ArmReach reach_;
  /// One for each episode, so that none depends on another.
  std::vector<Random> streams_;
  std::vector<DraftedEpisode> drafted_;
};

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

}  // namespace

Result<SourceEpisodes> sampleEpisodes(std::span<const Scene> scenes, const ObjectSet& objects,
                                      const Robot& robot, const EpisodeSamplerOptions& options) {
  if (auto checked = checkOptions(options); !checked) return tl::unexpected(checked.error());
  if (auto checked = checkRobot(robot); !checked) return tl::unexpected(checked.error());
  if (objects.objects().empty()) {
    return fail(ErrorCode::kInvalidInput, "episodes", "no object is given; give at least one");
  }
  const auto sorted = byName(scenes);
  if (!sorted) return tl::unexpected(sorted.error());
  for (const Scene* scene : *sorted) {
    if (auto checked = checkRadii(*scene, objects, robot); !checked) {
      return tl::unexpected(checked.error());
    }
  }
  Sampler sampler(objects, robot, options);
  for (std::size_t n = 0; n < sorted->size(); ++n) {
    if (auto done = sampler.sampleScene(*(*sorted)[n], n, sorted->size()); !done) {
      return tl::unexpected(done.error());
    }
  }
  SourceEpisodes episodes;
  episodes.name = std::string(sorted->front()->name());
  episodes.robot = std::string(robot.name());
  for (const Scene* scene : *sorted) episodes.scenes.emplace_back(scene->name());
  for (const ObjectModel& model : objects.objects()) episodes.objects.emplace_back(model.name);
  for (std::size_t n = 0; n < sampler.drafted().size(); ++n) {
    append(sampler.drafted()[n], static_cast<std::uint32_t>(n % sorted->size()), episodes);
  }
  return episodes;
}

}  // namespace galactic::bake
