#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/episode_set_import.h"
#include "galactic/error.h"

namespace galactic::bake {

/// The greatest coordinate, in meters.
inline constexpr double kFarthest = 10'000;
/// A unit quaternion saved with seven decimals deviates by far less; so does the axis of a
/// rotation.
inline constexpr double kUnitTolerance = 1e-3;
/// A pack with more placements would exceed its size limit. Episodes may share spawns, so that even
/// a small file may ask for more.
inline constexpr std::uint64_t kMostPlacements = 60'000'000;

/// An object at a pose, before it is known which objects and scenes are used.
struct Spawn {
  std::uint32_t object = 0;
  Pose pose;
};

/// An episode as in the file: `episode.scene` indexes the file's scenes, `first_placement` its
/// spawns.
struct FileEpisode {
  Episode episode;
  std::vector<float> start_positions;
  bool has_start = true;
};

/// The whole content of a file of episodes, in its order.
struct EpisodeFile {
  /// Where the episodes are, for errors: "x.json: episodes".
  std::string place;
  std::vector<std::string> scenes;
  std::vector<std::string> objects;
  std::vector<Spawn> spawns;
  std::vector<FileEpisode> episodes;
  /// Empty for any robot.
  std::string robot;
  std::vector<std::string> start_joints;
  std::vector<std::string> warnings;
};

/// A fault in the names of scenes, and the scene that has it, if it is one.
struct SceneNameFault {
  std::optional<std::size_t> scene;
  std::string message;
};

/// Renames the `scenes` that `names` has other names for. Returns a fault if one of them does not
/// exist, or if two scenes would have the same name.
[[nodiscard]] std::optional<SceneNameFault> renameScenes(
    std::vector<std::string>& scenes, const std::map<std::string, std::string>& names);

/// The episodes of `file` whose indices are in `only` (all if not given), in that order, with only
/// the scenes, objects and spawns that they use; names ascend. The result has no name. Fails with
/// kInvalidInput if an index does not exist or occurs twice, or if no episode is kept.
[[nodiscard]] Result<SourceEpisodes> chooseEpisodes(
    const EpisodeFile& file, const std::optional<std::vector<std::uint32_t>>& only);

}  // namespace galactic::bake
