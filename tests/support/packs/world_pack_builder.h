#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/packs/episode_pack_builder.h"
#include "support/packs/object_pack_builder.h"
#include "support/packs/robot_pack_builder.h"
#include "support/packs/scene_pack_builder.h"
#include "support/scratch_folder.h"

namespace galactic::test {

/// One pack of a world's list.
struct ReferenceFields {
  std::string path;
  std::string kind;
  std::uint64_t bytes = 1000;
  /// Low half first.
  std::optional<std::pair<std::uint64_t, std::uint64_t>> hash = std::pair{1, 2};
};

/// Names and values of options of a task.
using TaskTexts = std::vector<std::pair<std::string, std::string>>;

/// All that a world pack holds. buildPack makes a pack that is valid in every field that was left
/// as it is.
struct WorldPackFields {
  PackKind kind = PackKind::kWorld;
  std::vector<ReferenceFields> packs;
  /// None: as worlds were before they had tasks.
  std::optional<TaskTexts> task;
};

/// One pack of each kind; the files are not there.
WorldPackFields smallWorldPack();

/// The whole file: header and payload.
AlignedBytes buildPack(const WorldPackFields& fields);

/// The packs of a small world, all for the same radii.
struct WorldFields {
  ScenePackFields scene = smallScene();
  ObjectPackFields objects = smallObjects();
  RobotPackFields robot = smallRobotPack();
  EpisodePackFields episodes = smallEpisodes();

  WorldFields() {
    objects.radii.clear();
    for (const GridFields& grid : scene.grids) objects.radii.push_back(grid.grid.spec.radius);
    robot.radii = objects.radii;
  }
};

/// A file's bytes as text, for ScratchFolder.
std::string_view textOf(const AlignedBytes& file);

/// Writes `file` to `name` in `folder`; what a world pack has to say about it.
ReferenceFields writeListed(const ScratchFolder& folder, const std::string& name,
                            const AlignedBytes& file);

/// The world's packs in `folder` and what its world pack has to say about them.
WorldPackFields writePacks(const ScratchFolder& folder, const WorldFields& world);

/// The same, and the world pack itself: "world.pack" in `folder`.
std::filesystem::path writeWorld(const ScratchFolder& folder, const WorldFields& world);

}  // namespace galactic::test
