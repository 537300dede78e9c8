#pragma once
#include <string>
#include <vector>

#include "galactic/episode_set.h"
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

}  // namespace galactic::bake
