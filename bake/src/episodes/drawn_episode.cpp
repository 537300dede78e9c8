#include "episodes/drawn_episode.h"

#include <string>

namespace galactic::bake {

void setStart(const RobotStart& start, Episode& episode) {
  // Distance in meters that lifts the base off the floor, so that rounding never puts it below; far
  // less than what a run counts as a step.
  constexpr float kFloorMargin = 1e-4F;
  episode.base_position = start.base_position;
  episode.base_position.y += kFloorMargin;
  episode.base_yaw = start.base_yaw;
}

void setDraft(const DraftedEpisode& draft, DrawnEpisode& episode) {
  episode.episode = {.placement_count = static_cast<std::uint32_t>(draft.objects.size()),
                     .target = draft.target,
                     .base_position = {},
                     .base_yaw = 0,
                     .goal = draft.goal.pose};
  setStart(draft.start, episode.episode);
  episode.placements.clear();
  for (const PlacedObject& object : draft.objects) {
    episode.placements.push_back({.object = object.object, .pose = object.pose});
  }
}

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

void append(const DrawnEpisode& drawn, std::uint32_t scene, SourceEpisodes& episodes) {
  Episode& episode = episodes.episodes.emplace_back(drawn.episode);
  episode.scene = scene;
  episode.first_placement = static_cast<std::uint32_t>(episodes.placements.size());
  episodes.placements.insert(episodes.placements.end(), drawn.placements.begin(),
                             drawn.placements.end());
}

}  // namespace galactic::bake
