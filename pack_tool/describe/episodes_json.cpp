#include <algorithm>
#include <cmath>

#include "galactic/episode_set.h"
#include "pack_tool/describe/asset_json.h"
#include "pack_tool/describe/json_parts.h"

namespace galactic::pack_tool {

namespace {

Json poseJson(const Pose& pose) {
  const Quat& q = pose.rotation;
  return {{"translation", describePoint(pose.translation)},
          {"rotation_wxyz",
           Json::array({jsonNumber(q.w), jsonNumber(q.x), jsonNumber(q.y), jsonNumber(q.z)})}};
}

/// Least, mean and greatest of numbers that come one by one.
class Spread {
 public:
  void add(double value) {
    least_ = count_ == 0 ? value : std::min(least_, value);
    greatest_ = count_ == 0 ? value : std::max(greatest_, value);
    sum_ += value;
    ++count_;
  }

  [[nodiscard]] Json json() const {
    if (count_ == 0) return nullptr;
    return {{"min", least_}, {"mean", sum_ / static_cast<double>(count_)}, {"max", greatest_}};
  }

 private:
  double least_ = 0;
  double greatest_ = 0;
  double sum_ = 0;
  std::size_t count_ = 0;
};

double distance(const Vec3& a, const Vec3& b) {
  const Vec3 between = a - b;
  return std::hypot(static_cast<double>(between.x), static_cast<double>(between.y),
                    static_cast<double>(between.z));
}

/// What can be counted without listing the episodes.
void addCounts(const EpisodeSet& set, Json& json) {
  std::vector<std::size_t> of_scene(set.sceneNames().size());
  std::vector<std::size_t> placed(set.objectNames().size());
  std::vector<std::size_t> targets(set.objectNames().size());
  Spread objects;
  Spread ways;
  for (const Episode& episode : set.episodes()) {
    const std::span<const Placement> placements = set.placements(episode);
    const Placement& target = placements[episode.target];
    ++of_scene.at(episode.scene);
    ++targets.at(target.object);
    for (const Placement& placement : placements) ++placed.at(placement.object);
    objects.add(static_cast<double>(placements.size()));
    ways.add(distance(target.pose.translation, episode.goal.translation));
  }
  json["episode_count"] = set.episodes().size();
  json["objects_per_episode"] = objects.json();
  json["target_to_goal"] = ways.json();
  json["scenes"] = Json::array();
  for (std::size_t n = 0; n < of_scene.size(); ++n) {
    json["scenes"].push_back({{"name", set.sceneNames()[n]}, {"episodes", of_scene[n]}});
  }
  json["objects"] = Json::array();
  for (std::size_t n = 0; n < placed.size(); ++n) {
    json["objects"].push_back(
        {{"name", set.objectNames()[n]}, {"placements", placed[n]}, {"targets", targets[n]}});
  }
}

Json describeEpisode(const EpisodeSet& set, std::size_t n) {
  const Episode& episode = set.episodes()[n];
  Json json;
  json["scene"] = set.sceneNames().at(episode.scene);
  json["base_position"] = describePoint(episode.base_position);
  json["base_yaw"] = jsonNumber(episode.base_yaw);
  json["start_positions"] = Json::array();
  for (const float position : set.startPositions(n)) {
    json["start_positions"].push_back(jsonNumber(position));
  }
  json["placements"] = Json::array();
  for (const Placement& placement : set.placements(episode)) {
    Json placed{{"object", set.objectNames().at(placement.object)}};
    placed.update(poseJson(placement.pose));
    json["placements"].push_back(std::move(placed));
  }
  json["target"] = episode.target;
  json["goal"] = poseJson(episode.goal);
  return json;
}

}  // namespace

Json describeEpisodes(const PackFile& pack, Detail detail) {
  const auto set = EpisodeSet::from(pack);
  if (!set) return nullptr;
  Json json;
  json["name"] = set->name();
  json["robot"] = set->robotName().empty() ? Json() : Json(set->robotName());
  json["start_joints"] = set->startJoints();
  addCounts(*set, json);
  if (detail == Detail::kSummary) return json;
  json["episodes"] = Json::array();
  for (std::size_t n = 0; n < set->episodes().size(); ++n) {
    json["episodes"].push_back(describeEpisode(*set, n));
  }
  return json;
}

}  // namespace galactic::pack_tool
