#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "galactic/episode_set.h"
#include "galactic/error.h"
#include "galactic/object_set.h"
#include "galactic/option_text.h"
#include "galactic/pack.h"
#include "galactic/robot.h"
#include "galactic/scene.h"
#include "galactic/simulation_options.h"

namespace galactic {

/// Checks whether packs can be parts of one world, which need not be complete: unique names, the
/// same radii, at most one robot and one episode set. If it has both, they must meet all
/// requirements of World::from(). Fails as World::from() does.
[[nodiscard]] Result<void> checkTogether(std::vector<PackFile> packs);

/// Everything that a run reads and never writes: scenes, objects, robot and episodes, mapped into
/// memory. Immutable, so safe to share between threads. Copies are cheap and share one world, whose
/// packs stay mapped as long as a copy lives; simulators and similar classes keep a copy. What a
/// World returns is valid for as long as that.
class World {
 public:
  /// Opens the packs at `paths`: either one world pack, which lists all others, or the packs
  /// themselves (one robot, one episode set, one or more scenes, any number of object sets and
  /// textures).
  /// Fails with the errors of PackFile::open(), and with kInvalidInput if
  /// - a referenced pack is missing, or is not the one that was linked (kind, size or hash),
  /// - a kind of pack is missing, there are two where only one is allowed, or two scenes or two
  ///   objects have the same name,
  /// - an episode names a scene, an object or a joint (with one position, and not a mimic) that the
  ///   packs do not have, or another robot,
  /// - the packs were baked for different radii,
  /// - the world pack has an unknown task option, or a wrong value for one,
  /// - the robot has no end effector, no base or no spheres.
  [[nodiscard]] static Result<World> open(std::span<const std::filesystem::path> paths,
                                          Trust trust = Trust::kVerify);

  /// One world pack.
  [[nodiscard]] static Result<World> open(const std::filesystem::path& path,
                                          Trust trust = Trust::kVerify) {
    return open(std::span(&path, 1), trust);
  }

  /// The same for packs that are already open, none of which is a world pack.
  [[nodiscard]] static Result<World> from(std::vector<PackFile> packs);

  /// The working set of radii, meters, ascending: the same in all packs.
  [[nodiscard]] std::span<const float> radii() const { return robot().radii(); }
  /// By ascending name, whatever the order of the packs.
  [[nodiscard]] const std::vector<Scene>& scenes() const { return content_->scenes; }
  /// A world has one robot and one episode set.
  [[nodiscard]] const Robot& robot() const { return content_->robot.front(); }
  [[nodiscard]] const EpisodeSet& episodes() const { return content_->episodes.front(); }
  /// Identifies the world: it follows from the kinds, sizes and hashes of its packs, in any order.
  [[nodiscard]] std::uint64_t hash() const { return content_->hash; }
  /// The packs of the assets, without the world pack that lists them.
  [[nodiscard]] const std::vector<PackFile>& packs() const { return content_->packs; }

  [[nodiscard]] const Scene& sceneOf(const Episode& episode) const {
    return content_->scenes[sceneIndexOf(episode)];
  }
  /// Index into scenes().
  [[nodiscard]] std::uint32_t sceneIndexOf(const Episode& episode) const {
    return content_->scene_of_name[episode.scene];
  }
  /// `number`: index into EpisodeSet::objectNames().
  [[nodiscard]] const ObjectModel& object(std::uint32_t number) const {
    return content_->object_of_name[number];
  }
  [[nodiscard]] const ObjectModel& objectOf(const Placement& placement) const {
    return object(placement.object);
  }
  /// Index into the robot's joint positions of each of the episodes' startJoints().
  [[nodiscard]] std::span<const std::uint32_t> startPositionIndices() const {
    return content_->start_position_indices;
  }
  /// The largest number of objects in one episode.
  [[nodiscard]] std::size_t mostObjects() const { return content_->most_objects; }
  /// The largest number of spheres of one object in the episodes.
  [[nodiscard]] std::size_t mostObjectSpheres() const { return content_->most_object_spheres; }

  /// The task options in the world pack, in the order of the option table; empty if it has none, or
  /// if the packs were opened one by one.
  [[nodiscard]] const std::vector<OptionText>& taskOptions() const {
    return content_->task_options;
  }
  /// `base` with the task options in the world pack applied; other options keep their values. For
  /// BatchSimulator::create(); only galactic-run does this by itself.
  [[nodiscard]] SimulationOptions withTask(SimulationOptions base = {}) const;

 private:
  struct Content {
    std::vector<PackFile> packs;
    std::vector<Scene> scenes;
    /// One element each; vectors because neither can be default-constructed.
    std::vector<Robot> robot;
    std::vector<EpisodeSet> episodes;
    /// Indexed by the episode set's indices.
    std::vector<std::uint32_t> scene_of_name;
    std::vector<ObjectModel> object_of_name;
    std::vector<std::uint32_t> start_position_indices;
    std::size_t most_objects = 0;
    std::size_t most_object_spheres = 0;
    std::uint64_t hash = 0;
    std::vector<OptionText> task_options;
  };

  explicit World(std::shared_ptr<const Content> content) : content_(std::move(content)) {}
  static Result<World> make(std::vector<PackFile> packs, std::vector<OptionText> task_options);

  std::shared_ptr<const Content> content_;
};

}  // namespace galactic
