#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/episode_set.h"
#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/pose.h"

namespace galactic::bake {

/// Episodes as importers and the generator give them, ready for encodeEpisodePack. World frame: Y
/// up, meters, radians; object frames are those of the object packs.
struct SourceEpisodes {
  std::string name;
  /// Ascending, no two the same; Episode::scene counts in it.
  std::vector<std::string> scenes;
  /// Ascending, no two the same; Placement::object counts in it.
  std::vector<std::string> objects;
  /// Name of the robot that the start positions are for; empty when they fit any.
  std::string robot;
  /// Joints whose positions each episode gives.
  std::vector<std::string> start_joints;
  /// Shape: episodes * start_joints.
  std::vector<float> start_positions;
  /// Of all episodes, one after the other.
  std::vector<Placement> placements;
  std::vector<Episode> episodes;
  /// Ascending numbers of the episodes whose file gives no start: the robot stands at the origin.
  /// See drawStarts.
  std::vector<std::uint32_t> without_start{};
  /// One sentence each.
  std::vector<std::string> warnings;
};

/// A place for objects that a dataset names: a box over a surface, as Habitat's receptacles
/// (user_defined.receptacle_aabb_*), placed in the world.
struct SupportRegion {
  std::string name;
  Pose world_from_region;
  /// Meters, along the region's axes.
  Vec3 half_extents;
};

/// How the names of published episode sets end.
inline constexpr std::string_view kEpisodeSetSuffix = ".episode_set.json";

/// Which targets of a Habitat episode that has several become one of ours, which has one.
enum class HabitatTargets {
  kFirst,  ///< The one that comes first among its rigid_objs.
  kEach,   ///< Each, as an episode of its own, in the order of rigid_objs.
};

/// What published episodes leave open.
struct EpisodeImportOptions {
  /// Up axis of the objects' frames in the file; the frames of object packs are Y up. Not given: Z
  /// in episode sets, whose frames are those of the mesh files (packs were baked with the same
  /// --up), and Y in Habitat's, which turns the meshes.
  std::optional<UpAxis> object_up;
  /// Habitat: where the origin of an object's frame in the file lies in the frame of its pack,
  /// meters, by the object's name; others have it in the pack's origin. See objectCenters.
  std::map<std::string, Vec3> object_centers;
  /// Habitat: an object that object_centers lacks is an error.
  bool centers_needed = false;
  HabitatTargets targets = HabitatTargets::kFirst;
  /// Episode sets: the joints of robotStartJointPositions, which the file counts in the order of
  /// the collection's actionMap. Default: the published collection's Fetch. Exported sets name
  /// theirs (`startJoints`).
  std::vector<std::string> start_joints{
      "shoulder_pan_joint", "shoulder_lift_joint", "upperarm_roll_joint", "elbow_flex_joint",
      "forearm_roll_joint", "wrist_flex_joint",    "wrist_roll_joint"};
  /// Scenes whose packs have other names than the file says: the file's name to the pack's.
  std::map<std::string, std::string> scene_names;
  /// Indices of the episodes to keep, in this order; none: all of them. With HabitatTargets::kEach
  /// those that the file's become are counted.
  std::optional<std::vector<std::uint32_t>> only;

  friend bool operator==(const EpisodeImportOptions&, const EpisodeImportOptions&) = default;
};

/// Reads a published `*.episode_set.json`. An object is named by its render asset, a scene by its
/// static scene. Quaternions stand as w, x, y, z in the file and are normalized. Objects turn from
/// their published frame to that of their packs: a point of the object stays where it is in the
/// world. The robot stands at height 0 unless the set, an exported one, says otherwise. Scenes,
/// objects and placements that no kept episode uses are left out. Names ascend and placements stand
/// in the order of the episodes, as a pack wants them. Fails with kIo or kInvalidInput, naming the
/// file and the element, on broken JSON, missing keys, wrong types, counts and indices out of
/// range, numbers that are not finite or absurdly far, quaternions that are not of length 1 within
/// 1e-3 (those within 1e-6 are not touched: what was exported comes back as the same floats), two
/// scenes of one name, a scene to rename or an episode to keep that is not there.
[[nodiscard]] Result<SourceEpisodes> readEpisodeSet(const std::filesystem::path& path,
                                                    const EpisodeImportOptions& options = {});

/// Reads a rearrangement dataset of Habitat 2.0 (`*.json`, `*.json.gz`): the fields of
/// RearrangeEpisode in habitat-lab, habitat/datasets/rearrange/rearrange_dataset.py. Scenes and
/// object templates are named by their files without folders and extensions. Objects stand where
/// rigid_objs puts them (row-major world_from_object, whose origin is the object's center of mass,
/// see object_centers); the goal is the target's transform. The robot starts at start_position,
/// turned by the heading of start_rotation (x, y, z, w); datasets of habitat-lab's generator give
/// neither (SourceEpisodes::without_start). There are no start joints. A warning says what is lost:
/// other targets, opened furniture.
/// Fails like readEpisodeSet, and on transforms that are not rigid within 1e-3, and targets that
/// are none of the episode's objects.
[[nodiscard]] Result<SourceEpisodes> readHabitatEpisodes(const std::filesystem::path& path,
                                                         const EpisodeImportOptions& options = {});

/// Either of them, by its content.
[[nodiscard]] Result<SourceEpisodes> readEpisodeFile(const std::filesystem::path& path,
                                                     const EpisodeImportOptions& options = {});

/// The name of the episodes in a file: "tidy" of "tidy.episode_set.json" and "tidy.json.gz".
[[nodiscard]] std::string episodeSetName(const std::filesystem::path& path);

/// The centers of the bounds of all objects in an object pack, in their own frames, by name.
/// Habitat puts the origins of objects there that have no center of mass of their own. Fails with
/// kInvalidInput on another kind of pack.
[[nodiscard]] Result<std::map<std::string, Vec3>> objectCenters(const PackFile& objects);

/// The indices in a text file, one or more in a line, separated by blanks; '#' begins a comment.
/// Fails with kIo, and with kInvalidInput, naming the line, on what is no index.
[[nodiscard]] Result<std::vector<std::uint32_t>> readEpisodeList(const std::filesystem::path& path);

}  // namespace galactic::bake
