#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/random.h"
#include "episodes/home/arm_reach.h"
#include "episodes/home/floor_map.h"
#include "episodes/home/placed_object.h"
#include "episodes/home/robot_start.h"
#include "episodes/home/support_places.h"
#include "episodes/home/surface_rays.h"
#include "episodes/trial/settling.h"
#include "galactic/bake/episode_generator.h"

namespace galactic::bake {

/// Least distance between the boxes of objects, meters.
inline constexpr float kObjectGap = 0.05F;
/// Share of the grasp radius within which the grasp point must come to the box in tests of reach. A
/// run uses the whole radius, but rounds its moves differently.
inline constexpr float kGraspShare = 0.8F;

/// The parts of a scene that drafts read. The references must outlive this.
struct DraftHome {
  const Scene& scene;
  /// By ascending name.
  std::span<const ObjectModel> objects;
  const Robot& robot;
  const FloorMap& floor;
  const ArmReach& reach;
  const SupportPlaces& supports;
  /// Set if the scene's triangles are known, else null and empty; `bodies` has one per object.
  const SurfaceRays* rays = nullptr;
  const SettlingScene* settling = nullptr;
  std::span<const SettlingBody> bodies;
  const EpisodeGeneratorOptions& options;
  /// Distance between the target's origin at its start and at its goal, for this scene.
  DistanceRange target_to_goal;
};

/// One episode in world coordinates.
struct DraftedEpisode {
  std::vector<PlacedObject> objects;
  std::uint32_t target = 0;
  PlacedObject goal;
  RobotStart start;
};

/// The part of a draft for which no place was found.
enum class DraftEnd : std::uint8_t { kDone, kTarget, kGoal, kOthers, kStart };
inline constexpr std::size_t kDraftEnds = 5;

inline constexpr std::size_t kSurveyTries = 20'000;

/// Two places, as indices into SupportPlaces::places(), where an object stood and was reached, at a
/// distance that suits target and goal.
struct ProvenPair {
  std::uint32_t target = 0;
  std::uint32_t goal = 0;
};

/// Result of the search for proven pairs.
struct PairSearch {
  /// Empty only if the scene is nearly hopeless.
  std::vector<ProvenPair> pairs;
  /// Number of targets that stood at their place and were reached.
  std::size_t reached_targets = 0;
  /// Draws that were rejected, with one reason for each try. For a target without any place for its
  /// goal, this is the reason why the place that came nearest to being one is not.
  RejectionCounts rejections;
};

/// Looks for proven pairs in kSurveyTries tries: finds places that hold an object, and from each
/// tries those at the right distance. Depends only on `home`.
[[nodiscard]] PairSearch findProvenPairs(const DraftHome& home);

/// Ways to make a draft easier after others have failed.
struct DraftEase {
  /// Half of the time, target and goal are put near these pairs, and so are other objects; if
  /// empty, all are put anywhere.
  std::span<const ProvenPair> proven;
  /// Whether to accept fewer objects if others find no place; the target must find one.
  bool may_lack_objects = false;
};

/// Tries once to draw an episode: the target, its goal, the other objects, the start. Accepts a
/// target or goal only if it finds a position of base and arm that brings the grasp point to the
/// box and touches neither the scene nor any object; the other objects keep clear of that position.
/// Counts draws that were rejected in `rejections`. The result depends only on the arguments.
[[nodiscard]] DraftEnd draftEpisode(const DraftHome& home, const DraftEase& ease, Random& random,
                                    DraftedEpisode& episode, RejectionCounts& rejections);

}  // namespace galactic::bake
