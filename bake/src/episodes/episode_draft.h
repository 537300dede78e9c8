#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "episodes/arm_reach.h"
#include "episodes/floor_map.h"
#include "episodes/placed_object.h"
#include "episodes/support_places.h"
#include "galactic/bake/episode_sampler.h"
#include "random.h"

namespace galactic::bake {

/// Objects keep this distance between their boxes, metres.
inline constexpr float kObjectGap = 0.05F;
/// Share of the grasp radius within which the grasp point of a test of reach comes to the box: a
/// run counts what is nearer than the whole radius, and moves in floats of its own.
inline constexpr float kGraspShare = 0.8F;

/// Everything of a scene that drafts read. The references outlive it.
struct Stage {
  const Scene& scene;
  const ObjectSet& objects;
  const Robot& robot;
  const FloorMap& floor;
  const ArmReach& reach;
  const SupportPlaces& supports;
  const EpisodeSamplerOptions& options;
};

/// One episode in world coordinates.
struct DraftedEpisode {
  std::vector<PlacedObject> objects;
  std::uint32_t target = 0;
  PlacedObject goal;
  /// On the floor, metres; radians.
  Vec3 base_position;
  float base_yaw = 0;
};

/// How often each part of a draft found no place.
struct DraftFailures {
  std::size_t target = 0;
  std::size_t goal = 0;
  std::size_t others = 0;
  std::size_t start = 0;
};

/// Draws one episode: the target, its goal, the other objects, the start. Target and goal are
/// taken only where a position of base and arm was found in which the grasp point is at the box,
/// and neither the scene nor any object is touched; the other objects keep clear of it. Gives up
/// after some drafts and adds up in `failures` why. The result depends on the arguments only.
[[nodiscard]] std::optional<DraftedEpisode> draftEpisode(const Stage& stage, Random random,
                                                         DraftFailures& failures);

}  // namespace galactic::bake
