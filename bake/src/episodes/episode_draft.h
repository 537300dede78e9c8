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

/// Objects keep this distance between their boxes, meters.
inline constexpr float kObjectGap = 0.05F;
/// Share of the grasp radius within which the grasp point of a test of reach comes to the box: a
/// run counts what is nearer than the whole radius, and moves in floats of its own.
inline constexpr float kGraspShare = 0.8F;

/// Everything of a scene that drafts read. The references outlive it.
struct DraftHome {
  const Scene& scene;
  /// Ascending names.
  std::span<const ObjectModel> objects;
  const Robot& robot;
  const FloorMap& floor;
  const ArmReach& reach;
  const SupportPlaces& supports;
  /// Where the scene's triangles are known, else null and empty; one body per object.
  const SurfaceRays* rays = nullptr;
  const SettlingScene* settling = nullptr;
  std::span<const SettlingBody> bodies;
  const EpisodeGeneratorOptions& options;
  /// Distance of the target's origin at its start and at its goal, in this scene.
  DistanceRange target_to_goal;
};

/// One episode in world coordinates.
struct DraftedEpisode {
  std::vector<PlacedObject> objects;
  std::uint32_t target = 0;
  PlacedObject goal;
  RobotStart start;
};

/// The part of a draft that found no place.
enum class DraftEnd : std::uint8_t { kDone, kTarget, kGoal, kOthers, kStart };
inline constexpr std::size_t kDraftEnds = 5;

inline constexpr std::size_t kSurveyTries = 20'000;

/// Two places, as indices into SupportPlaces::places(), at which some object stood and was reached,
/// at a distance that suits target and goal.
struct ProvenPair {
  std::uint32_t target = 0;
  std::uint32_t goal = 0;
};

/// What a search for proven pairs found.
struct PairSearch {
  /// Empty where the scene is all but hopeless.
  std::vector<ProvenPair> pairs;
  /// Targets that stood at their place and were reached.
  std::size_t reached_targets = 0;
  /// What was drawn and not taken, one reason for each try: of a target for which no place is a
  /// goal, why the place that came nearest to it is none.
  RejectionCounts rejections;
};

/// Looks for proven pairs in kSurveyTries tries, by going from places that held an object to all
/// those at the right distance. Depends on the home only.
[[nodiscard]] PairSearch findProvenPairs(const DraftHome& home);

/// What a draft may make use of, and do without, after others have failed.
struct DraftEase {
  /// Target and goal are put near these half of the time, other objects as well; empty: anywhere.
  std::span<const ProvenPair> proven;
  /// Whether to make do with the objects that find a place, the target among them.
  bool may_lack_objects = false;
};

/// Tries once to draw an episode: the target, its goal, the other objects, the start. Target and
/// goal are taken only where a position of base and arm was found in which the grasp point is at
/// the box, and neither the scene nor any object is touched; the other objects keep clear of it.
/// Adds up in `rejections` what was drawn and not taken. The result depends on the arguments only.
[[nodiscard]] DraftEnd draftEpisode(const DraftHome& home, const DraftEase& ease, Random& random,
                                    DraftedEpisode& episode, RejectionCounts& rejections);

}  // namespace galactic::bake
