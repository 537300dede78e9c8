#include "galactic/bake/episode_set_import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "episodes/import/episode_file.h"
#include "episodes/import/episode_readers.h"
#include "episodes/import/object_frame.h"
#include "json/json_reader.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

/// Limit for positions of joints (radians or meters) and the base's yaw: continuous joints may have
/// turned many times.
constexpr double kLargestPosition = 1e6;
constexpr std::int64_t kMostElements = std::numeric_limits<std::int32_t>::max();

/// The content of an episode set, and the first error.
class EpisodeSetReader {
 public:
  EpisodeSetReader(const fs::path& path, const EpisodeImportOptions& options)
      : json_(path.string()),
        options_(options),
        file_from_pack_(fileFromPack(options.object_up.value_or(UpAxis::kZ))) {}

  /// Reads the whole file and checks it.
  Result<EpisodeFile> read(const Json& root);

 private:
  /// An index below `count`; 0 after an error.
  std::uint32_t index(const JsonNode& node, std::size_t count, const char* of);
  Rotation rotation(const JsonNode& node);
  /// world_from_object, for the frame of the object's pack.
  Pose pose(const JsonNode& position, const JsonNode& turned);

  std::vector<std::string> readAssets(const JsonNode& list);
  void readScenes(const JsonNode& list);
  void readObjects(const JsonNode& list, const std::vector<std::string>& assets);
  void readSpawns(const JsonNode& list);
  /// Reads what Galactic's own sets say about the robot.
  void readRobot(const JsonNode& set);
  void readEpisode(const JsonNode& node);
  /// Reads the range of spawns and the target among them.
  void readRange(const JsonNode& node, Episode& episode);
  void renameScenes(const JsonNode& list);

  JsonReader json_;
  const EpisodeImportOptions& options_;
  Rotation file_from_pack_;
  EpisodeFile file_;
  /// Of all episodes.
  std::uint64_t placements_ = 0;
};

std::uint32_t EpisodeSetReader::index(const JsonNode& node, std::size_t count, const char* of) {
  const std::int64_t value = json_.whole(node, std::numeric_limits<std::int32_t>::min(),
                                         std::numeric_limits<std::int32_t>::max());
  if (value >= 0 && static_cast<std::size_t>(value) < count) {
    return static_cast<std::uint32_t>(value);
  }
  json_.error(node.place, fmt::format("is {}, expected one of {} {}", value, count, of));
  return 0;
}

Rotation EpisodeSetReader::rotation(const JsonNode& node) {
  Rotation value{1, 0, 0, 0};
  json_.numbers(node, 2, value);
  const double length = lengthOf(value);
  if (std::abs(length - 1) > kUnitTolerance) {
    json_.error(node.place, fmt::format("has the length {}, expected a rotation w, x, y, z "
                                        "of length 1",
                                        length));
    return {1, 0, 0, 0};
  }
  return ofUnitLength(value);
}

Pose EpisodeSetReader::pose(const JsonNode& position, const JsonNode& turned) {
  const auto point = json_.vector<3>(position, kFarthest);
  return narrow(point, product(rotation(turned), file_from_pack_));
}

std::vector<std::string> EpisodeSetReader::readAssets(const JsonNode& list) {
  std::vector<std::string> names;
  for (const JsonNode& asset : json_.elements(list)) {
    json_.onlyKnown(asset, {"name"});
    names.push_back(json_.text(json_.require(asset, "name")));
  }
  return names;
}

void EpisodeSetReader::readScenes(const JsonNode& list) {
  for (const JsonNode& scene : json_.elements(list)) {
    // Ignores the scene's column grids and render meshes: those of its pack are used.
    json_.onlyKnown(scene, {"name", "columnGridSetName", "renderAssetInstances"});
    const JsonNode name = json_.require(scene, "name");
    file_.scenes.push_back(json_.text(name));
    if (file_.scenes.back().empty()) json_.error(name.place, "is empty, expected a scene's name");
  }
  if (file_.scenes.empty()) json_.error(list.place, "is empty, expected at least one scene");
  renameScenes(list);
}

void EpisodeSetReader::renameScenes(const JsonNode& list) {
  if (json_.failed()) return;
  const auto fault = galactic::bake::renameScenes(file_.scenes, options_.scene_names);
  if (!fault) return;
  json_.error(fault->scene ? fmt::format("{}[{}].name", list.place, *fault->scene) : list.place,
              fault->message);
}

void EpisodeSetReader::readObjects(const JsonNode& list, const std::vector<std::string>& assets) {
  for (const JsonNode& object : json_.elements(list)) {
    // The start rotations are for the published generator, and are not needed for existing
    // episodes.
    json_.onlyKnown(object, {"renderAssetIndex", "startRotations"});
    const JsonNode asset = json_.require(object, "renderAssetIndex");
    const std::uint32_t at = index(asset, assets.size(), "render assets");
    if (json_.failed()) return;
    if (assets[at].empty()) json_.error(asset.place, "leads to an asset without a name");
    file_.objects.push_back(assets[at]);
  }
}

void EpisodeSetReader::readSpawns(const JsonNode& list) {
  const auto nodes = json_.elements(list);
  file_.spawns.reserve(nodes.size());
  for (const JsonNode& spawn : nodes) {
    json_.onlyKnown(spawn, {"freeObjIndex", "startRotation", "startPos"});
    const std::uint32_t object =
        index(json_.require(spawn, "freeObjIndex"), file_.objects.size(), "free objects");
    file_.spawns.push_back(
        {object, pose(json_.require(spawn, "startPos"), json_.require(spawn, "startRotation"))});
    if (json_.failed()) return;
  }
}

void EpisodeSetReader::readRange(const JsonNode& node, Episode& episode) {
  const JsonNode first = json_.require(node, "firstFreeObjectSpawnIndex");
  const JsonNode count = json_.require(node, "numFreeObjectSpawns");
  episode.first_placement = index(first, file_.spawns.size(), "spawns");
  episode.placement_count = static_cast<std::uint32_t>(json_.whole(count, 1, kMostElements));
  if (json_.failed()) return;
  if (episode.placement_count > file_.spawns.size() - episode.first_placement) {
    json_.error(count.place,
                fmt::format("is {}, but there are only {} of the {} spawns from the first one, "
                            "{}, on",
                            episode.placement_count, file_.spawns.size() - episode.first_placement,
                            file_.spawns.size(), episode.first_placement));
  }
  placements_ += episode.placement_count;
  if (placements_ > kMostPlacements) {
    json_.error(count.place,
                fmt::format("makes it {} objects in all episodes, one pack holds at most {}; split "
                            "the set",
                            placements_, kMostPlacements));
  }
  episode.target = index(json_.require(node, "targetObjIndex"), episode.placement_count,
                         "spawns of its episode");
}

void EpisodeSetReader::readRobot(const JsonNode& set) {
  file_.start_joints = options_.start_joints;
  const JsonNode robot = JsonReader::member(set, "robot");
  if (robot.json != nullptr) file_.robot = json_.text(robot);
  const JsonNode joints = JsonReader::member(set, "startJoints");
  if (joints.json == nullptr) return;
  file_.start_joints.clear();
  for (const JsonNode& joint : json_.elements(joints)) {
    file_.start_joints.push_back(json_.text(joint));
  }
  const bool is_asked_for = options_.start_joints != EpisodeImportOptions().start_joints;
  if (is_asked_for && options_.start_joints != file_.start_joints) {
    const std::string named =
        file_.start_joints.empty()
            ? "no start joints"
            : fmt::format("the start joints {}", fmt::join(file_.start_joints, ","));
    json_.error(joints.place, fmt::format("names {}, and `start-joints` is {}; leave that out",
                                          named, fmt::join(options_.start_joints, ",")));
  }
}

void EpisodeSetReader::readEpisode(const JsonNode& node) {
  json_.onlyKnown(
      node, {"staticSceneIndex", "numFreeObjectSpawns", "targetObjIndex",
             "firstFreeObjectSpawnIndex", "agentStartPos", "agentStartHeight", "agentStartYaw",
             "robotStartJointPositions", "targetObjGoalPos", "targetObjGoalRotation"});
  FileEpisode read;
  Episode& episode = read.episode;
  episode.scene = index(json_.require(node, "staticSceneIndex"), file_.scenes.size(), "scenes");
  readRange(node, episode);
  const auto ground = json_.vector<2>(json_.require(node, "agentStartPos"), kFarthest);
  // Published sets have one floor, at height 0.
  const JsonNode height = JsonReader::member(node, "agentStartHeight");
  const double above = height.json == nullptr ? 0 : json_.number(height, -kFarthest, kFarthest);
  episode.base_position = {static_cast<float>(ground[0]), static_cast<float>(above),
                           static_cast<float>(ground[1])};
  episode.base_yaw = static_cast<float>(
      json_.number(json_.require(node, "agentStartYaw"), -kLargestPosition, kLargestPosition));
  episode.goal =
      pose(json_.require(node, "targetObjGoalPos"), json_.require(node, "targetObjGoalRotation"));
  std::vector<double> positions(file_.start_joints.size());
  const JsonNode joints = json_.require(node, "robotStartJointPositions");
  if (joints.json != nullptr && joints.json->is_array() &&
      joints.json->size() != positions.size()) {
    json_.error(joints.place,
                fmt::format("has {} positions for {} start joints; name the joint of each",
                            joints.json->size(), positions.size()));
  }
  json_.numbers(joints, kLargestPosition, positions);
  read.start_positions.assign(positions.begin(), positions.end());
  file_.episodes.push_back(std::move(read));
}

Result<EpisodeFile> EpisodeSetReader::read(const Json& root) {
  const JsonNode set = json_.require({&root, ""}, "episodeSet");
  json_.onlyKnown(set, {"renderAssets", "staticScenes", "freeObjects", "freeObjectSpawns",
                        "episodes", "robot", "startJoints"});
  readRobot(set);
  const auto assets = readAssets(json_.require(set, "renderAssets"));
  readScenes(json_.require(set, "staticScenes"));
  readObjects(json_.require(set, "freeObjects"), assets);
  readSpawns(json_.require(set, "freeObjectSpawns"));
  const JsonNode list = json_.require(set, "episodes");
  const auto nodes = json_.elements(list);
  file_.episodes.reserve(nodes.size());
  for (const JsonNode& episode : nodes) {
    if (json_.failed()) break;
    readEpisode(episode);
  }
  if (nodes.empty()) json_.error(list.place, "is empty, expected at least one episode");
  if (json_.failed()) return json_.failure();
  file_.place = json_.file() + ": episodeSet.episodes";
  file_.warnings = json_.warnings();
  return std::move(file_);
}

}  // namespace

Result<SourceEpisodes> readEpisodeSetJson(const fs::path& path, const Json& json,
                                          const EpisodeImportOptions& options) {
  ASSIGN_OR_RETURN(const auto file, EpisodeSetReader(path, options).read(json));
  auto source = chooseEpisodes(file, options.only);
  if (source) source->name = episodeSetName(path);
  return source;
}

Result<SourceEpisodes> readEpisodeSet(const fs::path& path, const EpisodeImportOptions& options) {
  ASSIGN_OR_RETURN(const auto json, readEpisodeJson(path));
  return readEpisodeSetJson(path, json, options);
}

}  // namespace galactic::bake
