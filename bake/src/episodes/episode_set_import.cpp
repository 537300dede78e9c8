#include "galactic/bake/episode_set_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "episodes/object_frame.h"
#include "json/json_reader.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxBytes = std::size_t{512} << 20U;
/// Metres from the world's origin.
constexpr double kFarthest = 10'000;
/// Radians or metres of a joint, and the base's yaw: continuous joints may have turned often.
constexpr double kLargestPosition = 1e6;
/// Saved with seven decimals, a unit quaternion is off by far less.
constexpr double kUnitTolerance = 1e-3;
/// A pack of them would be beyond its limit. Episodes may share spawns, so a small file may ask for
/// more.
constexpr std::uint64_t kMostPlacements = 60'000'000;
constexpr std::int64_t kMostElements = std::numeric_limits<std::int32_t>::max();

/// Something that has a place, before it is known which objects and scenes are used.
struct Spawn {
  std::uint32_t object = 0;
  Pose pose;
};

/// An episode as the file has it: `episode.scene` counts in the file's scenes, `first_placement` in
/// its spawns.
struct FileEpisode {
  Episode episode;
  std::vector<float> start_positions;
};

/// What is read of an episode set, all of it, and the first error.
class EpisodeSetReader {
 public:
  EpisodeSetReader(const fs::path& path, const EpisodeImportOptions& options)
      : json_(path.string()), options_(options), file_from_pack_(fileFromPack(options.object_up)) {}

  /// Reads the whole file and checks it.
  Result<void> read(const Json& root);
  /// What the options ask for of it.
  Result<SourceEpisodes> choose() const;

 private:
  /// An index below `count`; 0 on an offence.
  std::uint32_t index(const JsonNode& node, std::size_t count, const char* of);
  Rotation rotation(const JsonNode& node);
  /// world_from_object, for the frame of the object's pack.
  Pose pose(const JsonNode& position, const JsonNode& turned);

  std::vector<std::string> readAssets(const JsonNode& list);
  void readScenes(const JsonNode& list);
  void readObjects(const JsonNode& list, const std::vector<std::string>& assets);
  void readSpawns(const JsonNode& list);
  void readEpisode(const JsonNode& node);
  /// The range of spawns and the target among them.
  void readRange(const JsonNode& node, Episode& episode);
  void renameScenes(const JsonNode& list);
  /// Indices of the episodes to keep.
  Result<std::vector<std::uint32_t>> chosen() const;

  JsonReader json_;
  const EpisodeImportOptions& options_;
  Rotation file_from_pack_;
  std::vector<std::string> scenes_;
  std::vector<std::string> objects_;
  std::vector<Spawn> spawns_;
  std::vector<FileEpisode> episodes_;
  /// Of all episodes.
  std::uint64_t placements_ = 0;
};

std::uint32_t EpisodeSetReader::index(const JsonNode& node, std::size_t count, const char* of) {
  const std::int64_t value = json_.whole(node, std::numeric_limits<std::int32_t>::min(),
                                         std::numeric_limits<std::int32_t>::max());
  if (value >= 0 && static_cast<std::size_t>(value) < count) {
    return static_cast<std::uint32_t>(value);
  }
  json_.error(node.place, fmt::format("is {}, wanted one of {} {}", value, count, of));
  return 0;
}

Rotation EpisodeSetReader::rotation(const JsonNode& node) {
  Rotation value{1, 0, 0, 0};
  json_.numbers(node, 2, value);
  const double length = std::hypot(std::hypot(value[0], value[1]), std::hypot(value[2], value[3]));
  if (std::abs(length - 1) > kUnitTolerance) {
    json_.error(node.place, fmt::format("has the length {}, a rotation w, x, y, z of length 1 is "
                                        "wanted",
                                        length));
    return {1, 0, 0, 0};
  }
  for (double& part : value) part /= length;
  return value;
}

Pose EpisodeSetReader::pose(const JsonNode& position, const JsonNode& turned) {
  const auto point = json_.vector<3>(position, kFarthest);
  return {
      {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])},
      narrow(product(rotation(turned), file_from_pack_))};
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
    // The grids are those of the scene's pack, and so are its render meshes.
    json_.onlyKnown(scene, {"name", "columnGridSetName", "renderAssetInstances"});
    const JsonNode name = json_.require(scene, "name");
    scenes_.push_back(json_.text(name));
    if (scenes_.back().empty()) json_.error(name.place, "is empty, a scene's name is wanted");
  }
  if (scenes_.empty()) json_.error(list.place, "is empty, at least one scene is wanted");
  renameScenes(list);
}

void EpisodeSetReader::renameScenes(const JsonNode& list) {
  if (json_.failed()) return;
  for (const auto& [from, to] : options_.scene_names) {
    if (std::find(scenes_.begin(), scenes_.end(), from) == scenes_.end()) {
      return json_.error(list.place,
                         fmt::format("has no scene '{}' to be named '{}'; the first of {} is '{}'",
                                     from, to, scenes_.size(), scenes_.front()));
    }
  }
  std::set<std::string> names;
  for (std::size_t n = 0; n < scenes_.size(); ++n) {
    const auto renamed = options_.scene_names.find(scenes_[n]);
    if (renamed != options_.scene_names.end()) scenes_[n] = renamed->second;
    if (names.insert(scenes_[n]).second) continue;
    return json_.error(
        fmt::format("{}[{}].name", list.place, n),
        fmt::format("'{}' is the name of two scenes; give them names of their own", scenes_[n]));
  }
}

void EpisodeSetReader::readObjects(const JsonNode& list, const std::vector<std::string>& assets) {
  for (const JsonNode& object : json_.elements(list)) {
    // How the published generator stood them up: not needed for episodes that exist.
    json_.onlyKnown(object, {"renderAssetIndex", "startRotations"});
    const JsonNode asset = json_.require(object, "renderAssetIndex");
    const std::uint32_t at = index(asset, assets.size(), "render assets");
    if (json_.failed()) return;
    if (assets[at].empty()) json_.error(asset.place, "leads to an asset without a name");
    objects_.push_back(assets[at]);
  }
}

void EpisodeSetReader::readSpawns(const JsonNode& list) {
  const auto nodes = json_.elements(list);
  spawns_.reserve(nodes.size());
  for (const JsonNode& spawn : nodes) {
    json_.onlyKnown(spawn, {"freeObjIndex", "startRotation", "startPos"});
    const std::uint32_t object =
        index(json_.require(spawn, "freeObjIndex"), objects_.size(), "free objects");
    spawns_.push_back(
        {object, pose(json_.require(spawn, "startPos"), json_.require(spawn, "startRotation"))});
    if (json_.failed()) return;
  }
}

void EpisodeSetReader::readRange(const JsonNode& node, Episode& episode) {
  const JsonNode first = json_.require(node, "firstFreeObjectSpawnIndex");
  const JsonNode count = json_.require(node, "numFreeObjectSpawns");
  episode.first_placement = index(first, spawns_.size(), "spawns");
  episode.placement_count = static_cast<std::uint32_t>(json_.whole(count, 1, kMostElements));
  if (json_.failed()) return;
  if (episode.placement_count > spawns_.size() - episode.first_placement) {
    json_.error(count.place,
                fmt::format("is {}, but there are only {} of the {} spawns from the first one, "
                            "{}, on",
                            episode.placement_count, spawns_.size() - episode.first_placement,
                            spawns_.size(), episode.first_placement));
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

void EpisodeSetReader::readEpisode(const JsonNode& node) {
  json_.onlyKnown(node, {"staticSceneIndex", "numFreeObjectSpawns", "targetObjIndex",
                         "firstFreeObjectSpawnIndex", "agentStartPos", "agentStartYaw",
                         "robotStartJointPositions", "targetObjGoalPos", "targetObjGoalRotation"});
  FileEpisode read;
  Episode& episode = read.episode;
  episode.scene = index(json_.require(node, "staticSceneIndex"), scenes_.size(), "scenes");
  readRange(node, episode);
  const auto ground = json_.vector<2>(json_.require(node, "agentStartPos"), kFarthest);
  episode.base_position = {static_cast<float>(ground[0]), 0, static_cast<float>(ground[1])};
  episode.base_yaw = static_cast<float>(
      json_.number(json_.require(node, "agentStartYaw"), -kLargestPosition, kLargestPosition));
  episode.goal =
      pose(json_.require(node, "targetObjGoalPos"), json_.require(node, "targetObjGoalRotation"));
  std::vector<double> positions(options_.start_joints.size());
  const JsonNode joints = json_.require(node, "robotStartJointPositions");
  if (joints.json != nullptr && joints.json->is_array() &&
      joints.json->size() != positions.size()) {
    json_.error(joints.place,
                fmt::format("has {} positions for {} start joints; name the joint of each",
                            joints.json->size(), positions.size()));
  }
  json_.numbers(joints, kLargestPosition, positions);
  read.start_positions.assign(positions.begin(), positions.end());
  episodes_.push_back(std::move(read));
}

Result<void> EpisodeSetReader::read(const Json& root) {
  const JsonNode set = json_.require({&root, ""}, "episodeSet");
  json_.onlyKnown(set,
                  {"renderAssets", "staticScenes", "freeObjects", "freeObjectSpawns", "episodes"});
  const auto assets = readAssets(json_.require(set, "renderAssets"));
  readScenes(json_.require(set, "staticScenes"));
  readObjects(json_.require(set, "freeObjects"), assets);
  readSpawns(json_.require(set, "freeObjectSpawns"));
  const JsonNode list = json_.require(set, "episodes");
  const auto nodes = json_.elements(list);
  episodes_.reserve(nodes.size());
  for (const JsonNode& episode : nodes) {
    if (json_.failed()) break;
    readEpisode(episode);
  }
  if (nodes.empty()) json_.error(list.place, "is empty, at least one episode is wanted");
  if (json_.failed()) return json_.failure();
  return {};
}

Result<std::vector<std::uint32_t>> EpisodeSetReader::chosen() const {
  std::vector<std::uint32_t> indices;
  if (!options_.only) {
    indices.reserve(episodes_.size());
    for (std::uint32_t n = 0; n < episodes_.size(); ++n) indices.push_back(n);
    return indices;
  }
  indices = *options_.only;
  const std::string place = json_.file() + ": episodeSet.episodes";
  if (indices.empty()) {
    return fail(ErrorCode::kInvalidInput, place, "none is to be kept; name at least one");
  }
  std::set<std::uint32_t> seen;
  for (const std::uint32_t n : indices) {
    if (n >= episodes_.size()) {
      return fail(ErrorCode::kInvalidInput, place,
                  fmt::format("has {} episodes, number {} is to be kept; they count from 0",
                              episodes_.size(), n));
    }
    if (!seen.insert(n).second) {
      return fail(ErrorCode::kInvalidInput, place,
                  fmt::format("number {} is to be kept twice; name each once", n));
    }
  }
  return indices;
}

/// Gives the names that are used numbers in ascending order.
class UsedNames {
 public:
  explicit UsedNames(const std::vector<std::string>& all) : all_(all) {}

  void use(std::uint32_t index) { used_.insert(all_[index]); }
  [[nodiscard]] std::vector<std::string> names() const { return {used_.begin(), used_.end()}; }
  /// By the file's index; only of used ones.
  [[nodiscard]] std::vector<std::uint32_t> numbers() const {
    const std::vector<std::string> sorted = names();
    std::vector<std::uint32_t> numbers;
    numbers.reserve(all_.size());
    for (const std::string& name : all_) {
      const auto place = std::lower_bound(sorted.begin(), sorted.end(), name);
      numbers.push_back(static_cast<std::uint32_t>(place - sorted.begin()));
    }
    return numbers;
  }

 private:
  const std::vector<std::string>& all_;
  std::set<std::string> used_;
};

Result<SourceEpisodes> EpisodeSetReader::choose() const {
  const auto kept = chosen();
  if (!kept) return tl::unexpected(kept.error());
  UsedNames scenes(scenes_);
  UsedNames objects(objects_);
  SourceEpisodes source;
  source.start_joints = options_.start_joints;
  source.warnings = json_.warnings();
  source.episodes.reserve(kept->size());
  source.start_positions.reserve(kept->size() * options_.start_joints.size());
  for (const std::uint32_t n : *kept) {
    const FileEpisode& from = episodes_[n];
    Episode& episode = source.episodes.emplace_back(from.episode);
    scenes.use(episode.scene);
    episode.first_placement = static_cast<std::uint32_t>(source.placements.size());
    const auto spawns =
        std::span(spawns_).subspan(from.episode.first_placement, from.episode.placement_count);
    for (const Spawn& spawn : spawns) {
      objects.use(spawn.object);
      source.placements.push_back({spawn.object, spawn.pose});
    }
    source.start_positions.insert(source.start_positions.end(), from.start_positions.begin(),
                                  from.start_positions.end());
  }
  source.scenes = scenes.names();
  source.objects = objects.names();
  const auto scene_numbers = scenes.numbers();
  const auto object_numbers = objects.numbers();
  for (Episode& episode : source.episodes) episode.scene = scene_numbers[episode.scene];
  for (Placement& placement : source.placements) {
    placement.object = object_numbers[placement.object];
  }
  return source;
}

/// "tidy" of "tidy.episode_set.json".
std::string nameOf(const fs::path& path) {
  const std::string file = path.filename().string();
  if (file.size() > kEpisodeSetSuffix.size() && file.ends_with(kEpisodeSetSuffix)) {
    return file.substr(0, file.size() - kEpisodeSetSuffix.size());
  }
  return path.stem().string();
}

}  // namespace

Result<SourceEpisodes> readEpisodeSet(const fs::path& path, const EpisodeImportOptions& options) {
  const auto json = readJsonFile(
      path, {.what = "an episode set", .suffix = kEpisodeSetSuffix, .max_bytes = kMaxBytes});
  if (!json) return tl::unexpected(json.error());
  EpisodeSetReader reader(path, options);
  if (auto read = reader.read(*json); !read) return tl::unexpected(read.error());
  auto source = reader.choose();
  if (source) source->name = nameOf(path);
  return source;
}

}  // namespace galactic::bake
