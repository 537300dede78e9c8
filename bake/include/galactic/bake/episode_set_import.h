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

/// Episodes as importers and the generator return them, ready for encodeEpisodePack(). World frame:
/// Y up, meters, radians; object frames are those of the object packs.
struct SourceEpisodes {
  std::string name;
  /// Ascending, no two the same; Episode::scene is an index into it.
  std::vector<std::string> scenes;
  /// Ascending, no two the same; Placement::object is an index into it.
  std::vector<std::string> objects;
  /// Name of the robot that the start positions are for; empty if they fit any robot.
  std::string robot;
  /// Joints whose positions each episode gives.
  std::vector<std::string> start_joints;
  /// Shape: episodes * start_joints.
  std::vector<float> start_positions;
  /// The placements of all episodes, one episode after the other.
  std::vector<Placement> placements;
  std::vector<Episode> episodes;
  /// Ascending indices of the episodes for which the file gives no start: the robot stands at the
  /// origin. See drawStarts().
  std::vector<std::uint32_t> without_start{};
  /// One sentence each.
  std::vector<std::string> warnings;
};

/// A place for objects that a dataset names: a box over a surface, placed in the world, such as
/// Habitat's receptacles (user_defined.receptacle_aabb_*).
struct SupportRegion {
  std::string name;
  Pose world_from_region;
  /// Meters, along the region's axes.
  Vec3 half_extents;
};

/// The suffix of published episode sets' file names.
inline constexpr std::string_view kEpisodeSetSuffix = ".episode_set.json";

/// Which targets of a Habitat episode are imported. An episode of ours has one target; Habitat's
/// may have several.
enum class HabitatTargets {
  kFirst,  ///< Only the one that comes first among its rigid_objs.
  kEach,   ///< Each target, as an episode of its own, in the order of rigid_objs.
};

/// What published episodes do not specify.
struct EpisodeImportOptions {
  /// Up axis of the objects' frames in the file; the frames of object packs are Y up. If not given:
  /// Z in episode sets, whose frames are those of the mesh files (packs were baked with the same
  /// --up), and Y in Habitat's files, because Habitat turns the meshes.
  std::optional<UpAxis> object_up;
  /// Habitat: where the origin of an object's frame in the file lies in the frame of its pack,
  /// meters, by the object's name. For other objects, it is the pack's origin. See objectCenters().
  std::map<std::string, Vec3> object_centers;
  /// Habitat: whether an object that is missing in object_centers is an error.
  bool centers_needed = false;
  HabitatTargets targets = HabitatTargets::kFirst;
  /// Episode sets: the joints of robotStartJointPositions, which the file lists in the order of the
  /// collection's actionMap. Default: the published collection's Fetch. Exported sets name their
  /// joints (`startJoints`).
  std::vector<std::string> start_joints{
      "shoulder_pan_joint", "shoulder_lift_joint", "upperarm_roll_joint", "elbow_flex_joint",
      "forearm_roll_joint", "wrist_flex_joint",    "wrist_roll_joint"};
  /// Scenes whose packs have other names than in the file: maps the file's name to the pack's.
  std::map<std::string, std::string> scene_names;
  /// Indices of the episodes to keep, in this order; none: all of them. With HabitatTargets::kEach,
  /// these count the imported episodes, not the file's.
  std::optional<std::vector<std::uint32_t>> only;

  friend bool operator==(const EpisodeImportOptions&, const EpisodeImportOptions&) = default;
};

/// Reads a published `*.episode_set.json`. An object is named by its render asset, a scene by its
/// static scene. Quaternions are in the order w, x, y, z in the file and are normalized. Poses are
/// converted from an object's published frame to that of its pack, so that each point of the object
/// stays where it is in the world. The robot stands at height 0 unless the set is an exported one
/// that says otherwise. Scenes, objects and placements that no kept episode uses are left out.
/// Names ascend and placements are in the order of the episodes, as a pack requires. Fails with kIo
/// or kInvalidInput, naming the file and the element, on broken JSON, missing keys, wrong types,
/// counts and indices out of range, numbers that are not finite or absurdly large, quaternions
/// whose length is not 1 within 1e-3 (those within 1e-6 are not changed, so that an exported set
/// reads back as the same floats), two scenes of the same name, and a scene to rename or an episode
/// to keep that does not exist.
[[nodiscard]] Result<SourceEpisodes> readEpisodeSet(const std::filesystem::path& path,
                                                    const EpisodeImportOptions& options = {});

/// Reads a rearrangement dataset of Habitat 2.0 (`*.json`, `*.json.gz`): the fields of
/// RearrangeEpisode in habitat-lab, habitat/datasets/rearrange/rearrange_dataset.py. Scenes and
/// object templates are named by their files without folders and extensions. Objects are placed as
/// in rigid_objs (row-major world_from_object, whose origin is the object's center of mass; see
/// object_centers); the goal is the target's transform. The robot starts at start_position, turned
/// by the heading of start_rotation (x, y, z, w); datasets made by habitat-lab's generator give
/// neither (SourceEpisodes::without_start). There are no start joints. A warning lists what is
/// lost: other targets, opened furniture. Fails like readEpisodeSet(), and also on transforms that
/// are not rigid within 1e-3, and on targets that are not among the episode's objects.
[[nodiscard]] Result<SourceEpisodes> readHabitatEpisodes(const std::filesystem::path& path,
                                                         const EpisodeImportOptions& options = {});

/// Reads either kind of file, which it recognizes by its content.
[[nodiscard]] Result<SourceEpisodes> readEpisodeFile(const std::filesystem::path& path,
                                                     const EpisodeImportOptions& options = {});

/// The name of the episodes in a file: "tidy" of "tidy.episode_set.json" and "tidy.json.gz".
[[nodiscard]] std::string episodeSetName(const std::filesystem::path& path);

/// The centers of the bounds of all objects in an object pack, in their own frames, by name.
/// Habitat uses these points as the origins of objects that have no center of mass of their own.
/// Fails with kInvalidInput if `objects` is another kind of pack.
[[nodiscard]] Result<std::map<std::string, Vec3>> objectCenters(const PackFile& objects);

/// The indices in a text file, one or more per line, separated by blanks; '#' begins a comment.
/// Fails with kIo, and with kInvalidInput, naming the line, on text that is not an index.
[[nodiscard]] Result<std::vector<std::uint32_t>> readEpisodeList(const std::filesystem::path& path);

}  // namespace galactic::bake
