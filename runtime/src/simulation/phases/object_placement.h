#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/column_grid.h"
#include "galactic/object_set.h"
#include "galactic/pose.h"
#include "galactic/simulation_options.h"
#include "simulation/collision/collision.h"
#include "simulation/collision/held_spheres.h"
#include "support/random_stream.h"

namespace galactic::simulation {

/// Where a released object came to rest.
struct Landing {
  /// world_from_object; the pose of the release if it was not placed.
  Pose pose;
  /// False: every candidate failed. The caller restores the whole pose that the object had before
  /// it was grasped, its rotation included.
  bool placed = false;
  /// Candidate poses that were tried.
  std::uint32_t attempts = 0;
};

/// Scratch space for the queries of a placement; after construction nothing allocates.
class PlacementScratch {
 public:
  /// `most_spheres`: of any object. `radii`: of the working set, meters.
  PlacementScratch(std::size_t most_spheres, std::span<const float> radii);

  HeldSpheres spheres;
  std::vector<Clearance> clearance;
  std::vector<float> down;
  std::vector<float> up;
};

/// Finds where `object`, released at `released` (world_from_object, rotation of unit length), comes
/// to rest (paper, appendix I.2). It keeps its rotation. A candidate pose, first that of the
/// release, is
/// - lifted, by at most options.most_lift, to the lowest height at which no sphere penetrates the
///   scene or a resting object, and its resting box overlaps no other;
/// - lowered until a sphere touches the scene or an object, or box touches box, and put
///   options.clearance above that (at least 0.2 mm, to which the grids' heights are rounded); boxes
///   may overlap by the same amount;
/// - accepted if something was under it and it is then free of all penetration.
/// If that fails, the object is jittered in the ground plane at the height of the release, along a
/// path that is free for a sphere of the smallest radius. The jitter leads away from the objects
/// that block it, or out of the static geometry that blocks it, turned by up to
/// options.direction_spread; in any direction if that way is closed, or nothing gives a direction.
/// The numbers come from `random`; the result depends on the arguments only, and not on the order
/// of the spheres. The radii of `object`, `obstacles.scene` and `scratch` must be the same working
/// set. Neither allocates nor throws.
[[nodiscard]] Landing placeObject(const Obstacles& obstacles, const ObjectModel& object,
                                  const Pose& released, RandomStream& random,
                                  const PlacementOptions& options,
                                  PlacementScratch& scratch) noexcept;

}  // namespace galactic::simulation
