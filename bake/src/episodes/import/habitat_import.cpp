#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "episodes/import/episode_file.h"
#include "episodes/import/episode_readers.h"
#include "episodes/import/object_frame.h"
#include "fit/rotation.h"
#include "galactic/bake/habitat_names.h"
#include "json/json_reader.h"
#include "support/try.h"

namespace galactic::bake {
namespace {

namespace fs = std::filesystem;
using fit::Axes;

constexpr double kLargestState = 1e6;
/// Furniture that is open by less than this counts as closed: radians or meters.
constexpr double kClosed = 1e-3;

/// A rigid transform in Habitat's format.
struct RigidMatrix {
  Axes axes = fit::kIdentityAxes;
  Vec3d translation;
};

/// Numbers names in the order in which they first occur.
class NameList {
 public:
  std::uint32_t numberOf(const std::string& name) {
    const auto [place, fresh] = numbers_.emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (fresh) names_.push_back(name);
    return place->second;
  }
  [[nodiscard]] std::vector<std::string> take() { return std::move(names_); }

 private:
  std::map<std::string, std::uint32_t> numbers_;
  std::vector<std::string> names_;
};

/// The object that an instance handle refers to: "mug_:0002" is the third object named "mug".
struct HabitatInstance {
  std::string object;
  std::size_t number = 0;
};

/// None if `handle` is not an instance handle.
std::optional<HabitatInstance> habitatInstance(std::string_view handle) {
  constexpr std::string_view kMark = "_:";
  const std::size_t mark = handle.rfind(kMark);
  if (mark == std::string_view::npos) return std::nullopt;
  const std::string_view digits = handle.substr(mark + kMark.size());
  std::uint32_t number = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (problem != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return HabitatInstance{habitatName(handle.substr(0, mark)), number};
}

/// How often the file had something that a pack cannot hold.
struct Losses {
  std::size_t episodes = 0;
  std::size_t more_targets = 0;
  std::size_t open_furniture = 0;
};

/// The content of a rearrangement dataset, and the first error.
class HabitatReader {
 public:
  HabitatReader(const fs::path& path, const EpisodeImportOptions& options)
      : json_(path.string()),
        options_(options),
        file_from_pack_(fileFromPack(options.object_up.value_or(UpAxis::kY))) {}

  Result<EpisodeFile> read(const Json& root);

 private:
  /// For each name, the numbers of the episode's objects with this name, ascending.
  using Instances = std::map<std::string, std::vector<std::size_t>>;

  void readEpisode(const JsonNode& node);
  std::uint32_t readScene(const JsonNode& node);
  /// Reads the names of the episode's objects, and adds their spawns at the end of the list.
  std::vector<std::string> readObjects(const JsonNode& list);
  void readStart(const JsonNode& node, FileEpisode& read);
  void readFurniture(const JsonNode& states);
  /// Reads the goals, keyed by the target's number among the episode's objects.
  std::map<std::size_t, Pose> readTargets(const JsonNode& targets,
                                          const std::vector<std::string>& objects);
  std::optional<std::size_t> targetOf(const JsonNode& target, const std::string& handle,
                                      const Instances& instances);
  void addEpisodes(const JsonNode& node, const FileEpisode& read,
                   const std::map<std::size_t, Pose>& goals);

  RigidMatrix matrix(const JsonNode& node);
  /// world_from_object in the frame of the object's pack.
  Pose pose(const JsonNode& node, const std::string& object);
  void warnOfLosses();

  JsonReader json_;
  const EpisodeImportOptions& options_;
  Rotation file_from_pack_;
  EpisodeFile file_;
  NameList scenes_;
  NameList objects_;
  std::set<std::string> uncentered_;
  /// Of all episodes.
  std::uint64_t placements_ = 0;
  Losses losses_;
};

RigidMatrix HabitatReader::matrix(const JsonNode& node) {
  std::array<std::array<double, 4>, 4> rows{};
  const auto lists = json_.elements(node);
  if (json_.failed()) return {};
  if (lists.size() != rows.size()) {
    json_.error(node.place,
                fmt::format("it has {} rows, expected 4 rows of 4 numbers", lists.size()));
    return {};
  }
  for (std::size_t n = 0; n < rows.size(); ++n) json_.numbers(lists[n], kFarthest, rows[n]);
  if (json_.failed()) return {};
  RigidMatrix read;
  const auto column = [&rows](std::size_t n) { return Vec3d{rows[0][n], rows[1][n], rows[2][n]}; };
  Axes& axes = read.axes;
  for (std::size_t n = 0; n < axes.size(); ++n) axes[n] = column(n);
  read.translation = column(3);
  double worst = std::abs(rows[3][3] - 1);
  for (std::size_t n = 0; n < 3; ++n) {
    worst = std::max({worst, std::abs(rows[3][n]), std::abs(norm(axes[n]) - 1),
                      std::abs(dot(axes[n], axes[(n + 1) % 3]))});
  }
  if (worst > kUnitTolerance || dot(cross(axes[0], axes[1]), axes[2]) < 0) {
    json_.error(node.place,
                "it is not a rigid transform: its columns must be perpendicular, right-handed and "
                "of length 1, with the translation in the last one, and its last row 0, 0, 0, 1");
    return {};
  }
  axes[0] = normalized(axes[0]);
  axes[1] = normalized(axes[1] - axes[0] * dot(axes[0], axes[1]));
  axes[2] = cross(axes[0], axes[1]);
  return read;
}

Pose HabitatReader::pose(const JsonNode& node, const std::string& object) {
  const RigidMatrix read = matrix(node);
  const Quat turned = fit::quaternionOf(read.axes);
  const Quat rotation =
      narrow(product({static_cast<double>(turned.w), static_cast<double>(turned.x),
                      static_cast<double>(turned.y), static_cast<double>(turned.z)},
                     file_from_pack_));
  Vec3d origin = read.translation;
  const auto center = options_.object_centers.find(object);
  if (center != options_.object_centers.end()) {
    const Vec3& c = center->second;
    const Axes axes = fit::axesOf(rotation);
    origin = origin - axes[0] * static_cast<double>(c.x) - axes[1] * static_cast<double>(c.y) -
             axes[2] * static_cast<double>(c.z);
  } else if (options_.centers_needed) {
    json_.error(node.place, fmt::format("is of '{}', which is not in the object pack; bake it into "
                                        "it",
                                        object));
  } else {
    uncentered_.insert(object);
  }
  return {
      {static_cast<float>(origin.x), static_cast<float>(origin.y), static_cast<float>(origin.z)},
      rotation};
}

std::uint32_t HabitatReader::readScene(const JsonNode& node) {
  const std::string name = habitatName(json_.text(node));
  if (name.empty()) json_.error(node.place, "is empty, expected a scene's name or file");
  return scenes_.numberOf(name);
}

std::vector<std::string> HabitatReader::readObjects(const JsonNode& list) {
  std::vector<std::string> objects;
  const auto nodes = json_.elements(list);
  if (nodes.empty()) json_.error(list.place, "is empty, expected at least one object");
  objects.reserve(nodes.size());
  for (const JsonNode& node : nodes) {
    const auto pair = json_.elements(node);
    if (json_.failed()) break;
    if (pair.size() != 2) {
      json_.error(node.place,
                  fmt::format("it has {} elements, expected an object's template and its "
                              "transform",
                              pair.size()));
      break;
    }
    const std::string name = habitatName(json_.text(pair[0]));
    if (name.empty()) json_.error(pair[0].place, "is empty, expected an object's template");
    const Pose placed = pose(pair[1], name);
    if (json_.failed()) break;
    objects.push_back(name);
    file_.spawns.push_back({objects_.numberOf(name), placed});
  }
  return objects;
}

void HabitatReader::readStart(const JsonNode& node, FileEpisode& read) {
  const JsonNode turned = json_.require(node, "start_rotation");
  const auto start = json_.vector<3>(json_.require(node, "start_position"), kFarthest);
  const auto xyzw = json_.vector<4>(turned, 2);
  if (json_.failed()) return;
  const Rotation rotation = ofUnitLength({xyzw[3], xyzw[0], xyzw[1], xyzw[2]});
  const double length = lengthOf({xyzw[3], xyzw[0], xyzw[1], xyzw[2]});
  if (std::abs(length - 1) > kUnitTolerance) {
    return json_.error(turned.place, fmt::format("has the length {}, expected a rotation "
                                                 "x, y, z, w of length 1",
                                                 length));
  }
  // The direction of the robot's X axis; a base that is tipped over has no heading.
  const auto& [w, x, y, z] = rotation;
  const double ahead = 1 - 2 * (y * y + z * z);
  const double right = 2 * (x * z - w * y);
  if (std::hypot(ahead, right) < 0.5) {
    return json_.error(turned.place, "points the robot up or down, expected a heading");
  }
  Episode& episode = read.episode;
  episode.base_position = {static_cast<float>(start[0]), static_cast<float>(start[1]),
                           static_cast<float>(start[2])};
  episode.base_yaw = static_cast<float>(std::atan2(-right, ahead) + 0.0);
  read.has_start = episode.base_position != Vec3{} || episode.base_yaw != 0;
}

void HabitatReader::readFurniture(const JsonNode& states) {
  if (states.json == nullptr) return;
  if (!states.json->is_object()) return json_.error(states.place, "expected an object");
  bool open = false;
  for (auto one = states.json->begin(); one != states.json->end(); ++one) {
    const JsonNode links{&*one, fmt::format("{}.{}", states.place, one.key())};
    if (!one->is_object()) return json_.error(links.place, "expected an object");
    for (auto link = one->begin(); link != one->end(); ++link) {
      const double state = json_.number({&*link, fmt::format("{}.{}", links.place, link.key())},
                                        -kLargestState, kLargestState);
      open = open || std::abs(state) > kClosed;
    }
  }
  if (open) ++losses_.open_furniture;
}

std::optional<std::size_t> HabitatReader::targetOf(const JsonNode& target,
                                                   const std::string& handle,
                                                   const Instances& instances) {
  const auto instance = habitatInstance(handle);
  if (!instance) {
    json_.error(
        target.place,
        "is not an instance's handle, expected a template's name and its number, for example "
        "mug_:0000");
    return std::nullopt;
  }
  const auto named = instances.find(instance->object);
  const std::size_t count = named == instances.end() ? 0 : named->second.size();
  if (instance->number < count) return named->second[instance->number];
  json_.error(target.place, fmt::format("is number {} of the objects '{}' from 0 on, rigid_objs "
                                        "has {} of them",
                                        instance->number, instance->object, count));
  return std::nullopt;
}

std::map<std::size_t, Pose> HabitatReader::readTargets(const JsonNode& targets,
                                                       const std::vector<std::string>& objects) {
  std::map<std::size_t, Pose> goals;
  if (targets.json == nullptr || json_.failed()) return goals;
  if (!targets.json->is_object()) {
    json_.error(targets.place, "expected an object");
    return goals;
  }
  Instances instances;
  for (std::size_t n = 0; n < objects.size(); ++n) instances[objects[n]].push_back(n);
  for (auto one = targets.json->begin(); one != targets.json->end(); ++one) {
    const JsonNode node{&*one, fmt::format("{}.{}", targets.place, one.key())};
    const auto target = targetOf(node, one.key(), instances);
    if (!target) return goals;
    if (!goals.emplace(*target, pose(node, objects[*target])).second) {
      json_.error(node.place, "is the second goal of one object, expected one for each");
    }
  }
  if (goals.empty()) json_.error(targets.place, "is empty, expected at least one target");
  return goals;
}

void HabitatReader::addEpisodes(const JsonNode& node, const FileEpisode& read,
                                const std::map<std::size_t, Pose>& goals) {
  const bool each = options_.targets == HabitatTargets::kEach;
  if (goals.size() > 1 && !each) ++losses_.more_targets;
  placements_ += std::uint64_t{read.episode.placement_count} * (each ? goals.size() : 1);
  if (placements_ > kMostPlacements) {
    return json_.error(node.place,
                       fmt::format("makes it {} objects in all episodes, one pack holds "
                                   "at most {}; split the set",
                                   placements_, kMostPlacements));
  }
  for (const auto& [target, goal] : goals) {
    Episode& added = file_.episodes.emplace_back(read).episode;
    added.target = static_cast<std::uint32_t>(target);
    added.goal = goal;
    if (!each) return;
  }
}

void HabitatReader::readEpisode(const JsonNode& node) {
  // The keys after the targets are not needed for simulation: names for people, where furniture can
  // be grasped, and the furniture on which objects stand.
  json_.onlyKnown(
      node, {"scene_id", "start_position", "start_rotation", "ao_states", "rigid_objs", "targets",
             "episode_id", "scene_dataset_config", "additional_obj_config_paths", "info", "markers",
             "target_receptacles", "goal_receptacles", "name_to_receptacle", "object_labels"});
  const auto has = [&node](const char* key) {
    return JsonReader::member(node, key).json != nullptr;
  };
  if (has("goals") && !has("rigid_objs")) {
    return json_.error(node.place,
                       "has goals and no rigid_objs, as Habitat's navigation (PointNav) has; only "
                       "rearrangement datasets are imported: to navigate, run the task of "
                       "examples/python/point_nav.py in a world of generated episodes");
  }
  FileEpisode read;
  Episode& episode = read.episode;
  episode.scene = readScene(json_.require(node, "scene_id"));
  readStart(node, read);
  readFurniture(JsonReader::member(node, "ao_states"));
  const JsonNode list = json_.require(node, "rigid_objs");
  episode.first_placement = static_cast<std::uint32_t>(file_.spawns.size());
  const auto objects = readObjects(list);
  episode.placement_count = static_cast<std::uint32_t>(objects.size());
  const auto goals = readTargets(json_.require(node, "targets"), objects);
  if (json_.failed()) return;
  ++losses_.episodes;
  addEpisodes(node, read, goals);
}

void HabitatReader::warnOfLosses() {
  const auto warn = [this](std::size_t count, const char* message) {
    if (count == 0) return;
    file_.warnings.push_back(fmt::format("{} of {} episodes {}", count, losses_.episodes, message));
  };
  warn(losses_.more_targets,
       "have several targets; the first is kept, `targets` each makes an episode of each");
  warn(losses_.open_furniture,
       "open furniture (ao_states), which stands in the scenes' packs as they were baked");
  if (uncentered_.empty()) return;
  file_.warnings.push_back(
      fmt::format("{} objects, first '{}', stand with their origins where their centers belong; "
                  "give `object-pack`, unless these are the same",
                  uncentered_.size(), *uncentered_.begin()));
}

Result<EpisodeFile> HabitatReader::read(const Json& root) {
  const JsonNode top{&root, ""};
  const JsonNode list = json_.require(top, "episodes");
  const auto nodes = json_.elements(list);
  for (const JsonNode& episode : nodes) {
    if (json_.failed()) break;
    readEpisode(episode);
  }
  if (nodes.empty()) json_.error(list.place, "is empty, expected at least one episode");
  if (json_.failed()) return json_.failure();
  file_.scenes = scenes_.take();
  file_.objects = objects_.take();
  file_.place = json_.file() + ": episodes";
  if (const auto fault = renameScenes(file_.scenes, options_.scene_names)) {
    return fail(ErrorCode::kInvalidInput, file_.place, fault->message);
  }
  file_.warnings = json_.warnings();
  warnOfLosses();
  return std::move(file_);
}

}  // namespace

Result<SourceEpisodes> readHabitatJson(const fs::path& path, const Json& json,
                                       const EpisodeImportOptions& options) {
  ASSIGN_OR_RETURN(const auto file, HabitatReader(path, options).read(json));
  auto source = chooseEpisodes(file, options.only);
  if (source) source->name = episodeSetName(path);
  return source;
}

Result<SourceEpisodes> readHabitatEpisodes(const fs::path& path,
                                           const EpisodeImportOptions& options) {
  ASSIGN_OR_RETURN(const auto json, readEpisodeJson(path));
  return readHabitatJson(path, json, options);
}

}  // namespace galactic::bake
