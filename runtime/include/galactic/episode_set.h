#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "galactic/error.h"
#include "galactic/pack.h"
#include "galactic/pose.h"

namespace galactic {

/// An object at rest at the start of an episode. The memory layout is that of a pack.
struct Placement {
  /// Index into EpisodeSet::objectNames().
  std::uint32_t object = 0;
  /// world_from_object.
  Pose pose;
};

/// One task instance: bring the target to the goal. The memory layout is that of a pack.
struct Episode {
  /// Index into EpisodeSet::sceneNames().
  std::uint32_t scene = 0;
  /// The episode's range among the episode set's placements.
  std::uint32_t first_placement = 0;
  std::uint32_t placement_count = 0;
  /// The object to move, counted within the episode's placements.
  std::uint32_t target = 0;
  /// Point on the ground under the root link's origin, world frame, meters. A run looks for the
  /// floor at this height or below.
  Vec3 base_position;
  /// Rotation of the base about +Y, radians: 0 faces +X, positive angles turn counter-clockwise,
  /// seen from above.
  float base_yaw = 0;
  /// Where the target object has to be: world_from_object.
  Pose goal;
};

/// Which objects of an episode are present: all of them, or the target alone.
struct PresentObjects {
  std::span<const Placement> placements;
  /// Index into `placements`.
  std::uint32_t target = 0;
  /// Index of the first of `placements` among the episode's placements.
  std::uint32_t first = 0;
};

/// The episodes of an episode pack: views into the pack.
class EpisodeSet {
 public:
  /// The episodes in `pack`, which must outlive the result. Fails with kInvalidInput if it is
  /// another kind of pack.
  [[nodiscard]] static Result<EpisodeSet> from(const PackFile& pack);
  static Result<EpisodeSet> from(const PackFile&& pack) = delete;

  /// A name for people: that of the pack for generated episodes, that of the file without its
  /// extension for others.
  [[nodiscard]] std::string_view name() const { return name_; }
  /// Ascending.
  [[nodiscard]] const std::vector<std::string_view>& sceneNames() const { return scenes_; }
  /// Ascending.
  [[nodiscard]] const std::vector<std::string_view>& objectNames() const { return objects_; }
  /// The robot that the start positions are for; empty if they fit any robot.
  [[nodiscard]] std::string_view robotName() const { return robot_; }
  /// The joints whose positions each episode gives.
  [[nodiscard]] const std::vector<std::string_view>& startJoints() const { return start_joints_; }

  /// All episodes, in the order of the pack. Elsewhere, an episode is identified by its index into
  /// these.
  [[nodiscard]] std::span<const Episode> episodes() const { return episodes_; }
  /// The objects of one episode.
  [[nodiscard]] std::span<const Placement> placements(const Episode& episode) const {
    return placements_.subspan(episode.first_placement, episode.placement_count);
  }
  /// The objects that are present with distractors (TaskOptions::distractors), or without.
  [[nodiscard]] PresentObjects present(const Episode& episode, bool distractors) const {
    const std::span<const Placement> all = placements(episode);
    if (distractors) return {all, episode.target, 0};
    return {all.subspan(episode.target, 1), 0, episode.target};
  }
  /// The objects that are present in a state of the episode that has this many objects.
  [[nodiscard]] PresentObjects presentOf(const Episode& episode, std::size_t objects) const {
    return present(episode, objects == episode.placement_count);
  }
  /// Positions of startJoints() in episode `n`, radians or meters.
  [[nodiscard]] std::span<const float> startPositions(std::size_t n) const {
    return start_positions_.subspan(n * start_joints_.size(), start_joints_.size());
  }

 private:
  EpisodeSet() = default;

  std::string_view name_;
  std::vector<std::string_view> scenes_;
  std::vector<std::string_view> objects_;
  std::string_view robot_;
  std::vector<std::string_view> start_joints_;
  std::span<const float> start_positions_;
  std::span<const Placement> placements_;
  std::span<const Episode> episodes_;
};

}  // namespace galactic
