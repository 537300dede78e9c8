#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/episode_set_import.h"
#include "galactic/error.h"

namespace galactic::bake {

/// Meters from the world's origin.
inline constexpr double kFarthest = 10'000;
/// Saved with seven decimals, a unit quaternion is off by far less; so is an axis of a rotation.
inline constexpr double kUnitTolerance = 1e-3;
/// A pack of them would be beyond its limit. Episodes may share spawns, so a small file may ask for
/// more.
inline constexpr std::uint64_t kMostPlacements = 60'000'000;

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
  bool has_start = true;
};

/// All that a file of episodes says, in its own order.
struct EpisodeFile {
  /// Where its episodes stand, for errors: "x.json: episodes".
  std::string place;
  std::vector<std::string> scenes;
  std::vector<std::string> objects;
  std::vector<Spawn> spawns;
  std::vector<FileEpisode> episodes;
  /// Empty: any.
  std::string robot;
  std::vector<std::string> start_joints;
  std::vector<std::string> warnings;
};

/// What is wrong with the names of scenes, and with which scene where it is one.
struct SceneNameFault {
  std::optional<std::size_t> scene;
  std::string message;
};

/// Gives the `scenes` that `names` knows their other names. Nothing, or a name that is not there or
/// that two scenes would have.
[[nodiscard]] std::optional<SceneNameFault> renameScenes(
    std::vector<std::string>& scenes, const std::map<std::string, std::string>& names);

/// The episodes of `file` whose indices are in `only` (not given: all), in that order, without the
/// scenes, objects and spawns that none of them uses; names ascend. It gets no name. Fails with
/// kInvalidInput on an index that is not there or comes twice, or when none is kept.
[[nodiscard]] Result<SourceEpisodes> chooseEpisodes(
    const EpisodeFile& file, const std::optional<std::vector<std::uint32_t>>& only);

}  // namespace galactic::bake
