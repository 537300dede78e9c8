#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/source_episodes.h"
#include "galactic/error.h"

namespace galactic::bake {

/// How the names of published episode sets end.
inline constexpr std::string_view kEpisodeSetSuffix = ".episode_set.json";

/// What a published episode set leaves open.
struct EpisodeImportOptions {
  /// Up axis of the objects' own frames. Object packs are Y up: they were baked with the same --up.
  UpAxis object_up = UpAxis::kZ;
  /// The joints of robotStartJointPositions, which the file counts in the order of the collection's
  /// actionMap. Default: the published collection's Fetch.
  std::vector<std::string> start_joints{
      "shoulder_pan_joint", "shoulder_lift_joint", "upperarm_roll_joint", "elbow_flex_joint",
      "forearm_roll_joint", "wrist_flex_joint",    "wrist_roll_joint"};
  /// Scenes whose packs have other names than the file says: the file's name to the pack's.
  std::map<std::string, std::string> scene_names;
  /// Indices of the episodes to keep, in this order; none: all of them.
  std::optional<std::vector<std::uint32_t>> only;
};

/// Reads a published `*.episode_set.json`. An object is named by its render asset, a scene by its
/// static scene. Quaternions stand as w, x, y, z in the file and are normalised. Objects turn from
/// their published frame to that of their packs: a point of the object stays where it is in the
/// world. The robot stands at height 0. Scenes, objects and placements that no kept episode uses
/// are left out. Names ascend and placements stand in the order of the episodes, as a pack wants
/// them.
/// Fails with kIo or kInvalidInput, naming the file and the element, on broken JSON, missing keys,
/// wrong types, counts and indices out of range, numbers that are not finite or absurdly far,
/// quaternions that are not of length 1 within 1e-3, two scenes of one name, a scene to rename or
/// an episode to keep that is not there.
[[nodiscard]] Result<SourceEpisodes> readEpisodeSet(const std::filesystem::path& path,
                                                    const EpisodeImportOptions& options = {});

/// The indices in a text file, one or more in a line, separated by blanks; '#' begins a comment.
/// Fails with kIo, and with kInvalidInput, naming the line, on what is no index.
[[nodiscard]] Result<std::vector<std::uint32_t>> readEpisodeList(const std::filesystem::path& path);

}  // namespace galactic::bake
