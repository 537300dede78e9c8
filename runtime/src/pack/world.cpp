#include "galactic/world.h"

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "galactic/pack_reference.h"
#include "support/text/counted.h"
#include "support/threads/workers.h"
#include "support/try.h"

namespace galactic {
namespace {

constexpr auto kInvalid = ErrorCode::kInvalidInput;
/// Radii that a user typed and radii that packs store may differ in the last digit.
constexpr float kSameRadius = 1e-6F;

/// A part of a world, and the pack that contains it.
template <class T>
struct Packed {
  T content;
  const PackFile* pack = nullptr;
};

/// The contents of a world's packs, by kind; maps where names have to be unique.
struct Parts {
  std::map<std::string_view, Packed<Scene>> scenes;
  std::map<std::string_view, Packed<ObjectModel>> objects;
  std::optional<Packed<Robot>> robot;
  std::optional<Packed<EpisodeSet>> episodes;
};

tl::unexpected<Error> repeated(const PackFile& pack, std::string_view what, std::string_view name,
                               const PackFile& first) {
  return fail(kInvalid, pack.where(),
              fmt::format("has a second {} named \"{}\", the first is in {}; names must be "
                          "unique in a world, leave one pack out",
                          what, name, first.where()),
              "world/repeated-name");
}

Result<void> addScene(const PackFile& pack, Parts& parts) {
  ASSIGN_OR_RETURN(Scene scene, Scene::from(pack));
  const std::string_view name = scene.name();
  const auto [place, is_new] = parts.scenes.try_emplace(name, Packed<Scene>{scene, &pack});
  if (!is_new) return repeated(pack, "scene", name, *place->second.pack);
  return {};
}

Result<void> addObjects(const PackFile& pack, Parts& parts) {
  ASSIGN_OR_RETURN(const ObjectSet set, ObjectSet::from(pack));
  for (const ObjectModel& object : set.objects()) {
    const auto [place, is_new] =
        parts.objects.try_emplace(object.name, Packed<ObjectModel>{object, &pack});
    if (!is_new) return repeated(pack, "object", object.name, *place->second.pack);
  }
  return {};
}

/// Keeps the only robot or episode set.
template <class T>
Result<void> addOnly(const PackFile& pack, std::optional<Packed<T>>& only, std::string_view what) {
  if (only) {
    return fail(kInvalid, pack.where(),
                fmt::format("has a second {}, the first is in {}; a world has one, leave one out",
                            what, only->pack->where()),
                "world/repeated-part");
  }
  ASSIGN_OR_RETURN(T content, T::from(pack));
  only.emplace(Packed<T>{std::move(content), &pack});
  return {};
}

Result<void> add(const PackFile& pack, Parts& parts) {
  switch (pack.kind()) {
    case PackKind::kScene:
      return addScene(pack, parts);
    case PackKind::kObjects:
      return addObjects(pack, parts);
    case PackKind::kRobot:
      return addOnly(pack, parts.robot, "robot");
    case PackKind::kEpisodes:
      return addOnly(pack, parts.episodes, "episode set");
    case PackKind::kTexture:
      // Only drawing asks for textures.
      return {};
    case PackKind::kPolicy:
      return fail(kInvalid, pack.where(),
                  "is a policy, which cannot be part of a world; give it with --policy",
                  "world/policy");
    case PackKind::kWorld:
      break;
  }
  return fail(kInvalid, pack.where(),
              "is a world pack among others; give one world pack alone, or the packs themselves",
              "world/nested");
}

Result<Parts> sortByKind(const std::vector<PackFile>& packs) {
  Parts parts;
  for (const PackFile& pack : packs) {
    RETURN_IF_ERROR(add(pack, parts));
  }
  return parts;
}

/// Checks that no required kind is missing.
Result<void> checkComplete(const Parts& parts) {
  const auto missing = [](std::string_view what) {
    return fail(kInvalid, "world", fmt::format("has no {}; give a pack of one, too", what),
                "world/missing-part");
  };
  if (!parts.robot) return missing("robot (RBOT)");
  if (!parts.episodes) return missing("episode set (EPIS)");
  if (parts.scenes.empty()) return missing("scene (SCEN)");
  return {};
}

/// The radii that a pack was baked for.
struct StatedRadii {
  std::vector<float> radii;
  const PackFile* pack = nullptr;
};

Result<void> checkRadii(const StatedRadii& stated, const StatedRadii& first) {
  const auto same = [](float a, float b) { return std::fabs(a - b) <= kSameRadius; };
  if (std::equal(stated.radii.begin(), stated.radii.end(), first.radii.begin(), first.radii.end(),
                 same)) {
    return {};
  }
  return fail(
      kInvalid, stated.pack->where(),
      fmt::format("was baked for the radii {} m, {} for {} m; bake them with the same "
                  "--radii",
                  fmt::join(stated.radii, ", "), first.pack->where(), fmt::join(first.radii, ", ")),
      "world/other-radii");
}

/// The robot's come first; the others are compared with them.
Result<std::vector<StatedRadii>> statedRadii(const std::vector<PackFile>& packs,
                                             const Parts& parts) {
  std::vector<StatedRadii> stated;
  if (parts.robot) {
    const auto radii = parts.robot->content.radii();
    stated.push_back({{radii.begin(), radii.end()}, parts.robot->pack});
  }
  for (const auto& [name, scene] : parts.scenes) {
    StatedRadii of_scene{{}, scene.pack};
    of_scene.radii.reserve(scene.content.grids().size());
    for (const ColumnGrid& grid : scene.content.grids()) of_scene.radii.push_back(grid.radius());
    stated.push_back(std::move(of_scene));
  }
  for (const PackFile& pack : packs) {
    if (pack.kind() != PackKind::kObjects) continue;
    ASSIGN_OR_RETURN(const ObjectSet set, ObjectSet::from(pack));
    stated.push_back({{set.radii().begin(), set.radii().end()}, &pack});
  }
  return stated;
}

Result<void> checkAllRadii(const std::vector<PackFile>& packs, const Parts& parts) {
  ASSIGN_OR_RETURN(const auto stated, statedRadii(packs, parts));
  for (const StatedRadii& one : stated) {
    if (auto same = checkRadii(one, stated.front()); !same) return same;
  }
  return {};
}

/// Checks that the robot can be simulated at all.
Result<void> checkAbilities(const Packed<Robot>& robot) {
  const auto lacks = [&](std::string_view what) {
    return fail(
        kInvalid, robot.pack->where(),
        fmt::format("has no {}, expected a robot to simulate; bake it with a recipe that has "
                    "one",
                    what),
        "world/incomplete-robot");
  };
  if (!robot.content.endEffector()) return lacks("end effector");
  if (!robot.content.base()) return lacks("base");
  if (robot.content.spheres().empty()) {
    return fail(kInvalid, robot.pack->where(),
                "has no spheres, expected a robot to simulate; bake it with collision geometry",
                "world/incomplete-robot");
  }
  return {};
}

/// A list of names in the episode pack, and the name of the error for one that the world lacks.
struct NameList {
  std::string_view field;
  std::string_view error_name;
};
constexpr NameList kSceneNames{"scenes", "world/unknown-scene"};
constexpr NameList kObjectNames{"objects", "world/unknown-object"};
constexpr NameList kJointNames{"start_joints", "world/other-robot"};

/// The error about name `n` of a list in the episode pack.
tl::unexpected<Error> unknown(const PackFile& episodes, const NameList& list, std::size_t n,
                              std::string message) {
  return fail(kInvalid, fmt::format("{}: episode_set.{}[{}]", episodes.where(), list.field, n),
              std::move(message), list.error_name);
}

/// The error about the first of the `names` from `n` on that is not among `known`, which are called
/// `things`; mentions the others, too.
template <class Names, class Known>
tl::unexpected<Error> lacking(const PackFile& episodes, const NameList& list, const Names& names,
                              std::size_t n, const Known& known, std::string_view things) {
  constexpr std::size_t kMostTold = 10;
  std::vector<std::string> more;
  for (std::size_t other = n + 1; other < names.size(); ++other) {
    if (!known.contains(names[other])) more.push_back(fmt::format("\"{}\"", names[other]));
  }
  const std::size_t untold = more.size() - std::min(more.size(), kMostTold);
  more.resize(more.size() - untold);
  const std::string others =
      more.empty() ? "; add its pack"
                   : fmt::format(", nor {}{}; add their packs", fmt::join(more, ", "),
                                 untold > 0 ? fmt::format(" and {} more", untold) : "");
  return unknown(episodes, list, n,
                 fmt::format("is \"{}\", which the world, with {}, does not have{}", names[n],
                             counted(known.size(), things), others));
}

/// For each of the episode set's scenes, its place among the sorted scenes.
Result<std::vector<std::uint32_t>> findScenes(const Parts& parts) {
  const auto& names = parts.episodes->content.sceneNames();
  std::vector<std::uint32_t> indices;
  indices.reserve(names.size());
  for (std::size_t n = 0; n < names.size(); ++n) {
    const auto found = parts.scenes.find(names[n]);
    if (found == parts.scenes.end()) {
      return lacking(*parts.episodes->pack, kSceneNames, names, n, parts.scenes, "scene");
    }
    indices.push_back(static_cast<std::uint32_t>(std::distance(parts.scenes.begin(), found)));
  }
  return indices;
}

Result<std::vector<ObjectModel>> findObjects(const Parts& parts) {
  const auto& names = parts.episodes->content.objectNames();
  std::vector<ObjectModel> objects;
  objects.reserve(names.size());
  for (std::size_t n = 0; n < names.size(); ++n) {
    const auto found = parts.objects.find(names[n]);
    if (found == parts.objects.end()) {
      return lacking(*parts.episodes->pack, kObjectNames, names, n, parts.objects, "object");
    }
    objects.push_back(found->second.content);
  }
  return objects;
}

/// For each start joint, its place in the vector of joint positions.
Result<std::vector<std::uint32_t>> findStartPositions(const Parts& parts) {
  const Robot& robot = parts.robot->content;
  const auto& names = parts.episodes->content.startJoints();
  std::vector<std::uint32_t> indices;
  indices.reserve(names.size());
  for (std::size_t n = 0; n < names.size(); ++n) {
    const auto refuse = [&](std::string_view fault) {
      return unknown(*parts.episodes->pack, kJointNames, n,
                     fmt::format("is \"{}\", which {} of the robot \"{}\"; give the robot that the "
                                 "episodes were made for",
                                 names[n], fault, robot.name()));
    };
    const std::optional<std::uint32_t> joint = robot.findJoint(names[n]);
    if (!joint) return refuse("is not a joint");
    const LinkFrame& link = robot.links()[*joint];
    if (positionCount(link.type) != 1) return refuse("is not a joint with one position");
    if (link.multiplier != 1 || link.offset != 0) return refuse("follows another joint");
    const auto position = static_cast<std::uint32_t>(link.position);
    if (std::find(indices.begin(), indices.end(), position) != indices.end()) {
      return refuse("moves with an earlier start joint");
    }
    indices.push_back(position);
  }
  return indices;
}

Result<void> checkRobotName(const Parts& parts) {
  const std::string_view wanted = parts.episodes->content.robotName();
  if (wanted.empty() || wanted == parts.robot->content.name()) return {};
  return fail(kInvalid, parts.episodes->pack->where() + ": episode_set.robot",
              fmt::format("is \"{}\", the robot in {} is \"{}\"; give the robot that the episodes "
                          "were made for",
                          wanted, parts.robot->pack->where(), parts.robot->content.name()),
              "world/other-robot");
}

Result<void> checkParts(const std::vector<PackFile>& packs, const Parts& parts) {
  if (auto able = checkAbilities(*parts.robot); !able) return able;
  if (auto same = checkAllRadii(packs, parts); !same) return same;
  return checkRobotName(parts);
}

std::uint64_t hashOf(const std::vector<PackFile>& packs) {
  std::vector<std::array<std::uint64_t, 3>> stamps;
  stamps.reserve(packs.size());
  for (const PackFile& pack : packs) {
    const PackHeader& header = pack.header();
    stamps.push_back(
        {static_cast<std::uint64_t>(header.kind), header.payload_bytes, header.payload_xxh64});
  }
  std::ranges::sort(stamps);
  return XXH3_64bits(stamps.data(), stamps.size() * sizeof(stamps.front()));
}

Result<std::vector<PackFile>> openList(const PackFile& world, Trust trust) {
  ASSIGN_OR_RETURN(const auto references, packReferences(world));
  // In parallel: there may be thousands, and each is read and checked from end to end.
  std::vector<std::optional<Result<PackFile>>> opened(references.size());
  std::atomic<std::size_t> failed = opened.size();
  detail::forEachPart(detail::threadCount(0), opened.size(), [&](std::size_t n) {
    // Report the first one that fails, whichever thread is ahead.
    if (n > failed) return;
    opened[n] = openReference(world, references[n], trust);
    if (*opened[n]) return;
    for (std::size_t known = failed; n < known && !failed.compare_exchange_weak(known, n);) {
    }
  });
  std::vector<PackFile> packs;
  packs.reserve(opened.size());
  for (std::optional<Result<PackFile>>& pack : opened) {
    if (!*pack) return tl::unexpected<Error>(std::move(pack->error()));
    packs.push_back(std::move(**pack));
  }
  return packs;
}

}  // namespace

Result<void> checkTogether(std::vector<PackFile> packs) {
  ASSIGN_OR_RETURN(const Parts parts, sortByKind(packs));
  if (!parts.robot || !parts.episodes) return checkAllRadii(packs, parts);
  RETURN_IF_ERROR(World::from(std::move(packs)));
  return {};
}

Result<World> World::open(std::span<const std::filesystem::path> paths, Trust trust) {
  std::vector<PackFile> packs;
  packs.reserve(paths.size());
  for (const std::filesystem::path& path : paths) {
    ASSIGN_OR_RETURN(PackFile pack, PackFile::open(path, trust));
    packs.push_back(std::move(pack));
  }
  if (packs.size() != 1 || packs.front().kind() != PackKind::kWorld) return from(std::move(packs));
  ASSIGN_OR_RETURN(std::vector<PackFile> listed, openList(packs.front(), trust));
  ASSIGN_OR_RETURN(auto task_options, galactic::taskOptions(packs.front()));
  return make(std::move(listed), std::move(task_options));
}

SimulationOptions World::withTask(SimulationOptions base) const {
  // Cannot fail: the options were read when the world was opened.
  (void)setOptions(taskOptions(), OptionScope::kTask, base);
  return base;
}

Result<World> World::from(std::vector<PackFile> packs) { return make(std::move(packs), {}); }

Result<World> World::make(std::vector<PackFile> packs, std::vector<OptionText> task_options) {
  Content world;
  // Must be first: what follows points into the packs.
  world.packs = std::move(packs);
  world.task_options = std::move(task_options);
  world.hash = hashOf(world.packs);
  ASSIGN_OR_RETURN(Parts parts, sortByKind(world.packs));
  RETURN_IF_ERROR(checkComplete(parts));
  RETURN_IF_ERROR(checkParts(world.packs, parts));
  ASSIGN_OR_RETURN(auto scenes, findScenes(parts));
  ASSIGN_OR_RETURN(auto objects, findObjects(parts));
  ASSIGN_OR_RETURN(auto positions, findStartPositions(parts));
  world.scene_of_name = std::move(scenes);
  world.object_of_name = std::move(objects);
  world.start_position_indices = std::move(positions);
  world.scenes.reserve(parts.scenes.size());
  for (auto& [name, scene] : parts.scenes) world.scenes.push_back(std::move(scene.content));
  world.robot.push_back(std::move(parts.robot->content));
  world.episodes.push_back(std::move(parts.episodes->content));
  for (const Episode& episode : world.episodes.front().episodes()) {
    world.most_objects = std::max<std::size_t>(world.most_objects, episode.placement_count);
  }
  for (const ObjectModel& object : world.object_of_name) {
    world.most_object_spheres = std::max(world.most_object_spheres, object.spheres.size());
  }
  return World(std::make_shared<const Content>(std::move(world)));
}

}  // namespace galactic
