#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "episodes/arm_reach.h"
#include "episodes/columns_view.h"
#include "episodes/floor_map.h"
#include "episodes/placed_object.h"
#include "galactic/bake/episode_sampler.h"
#include "galactic/scene.h"

namespace galactic::bake {

/// Free height over an object in which a gripper comes from above, metres: as wide as the largest
/// sphere.
inline constexpr float kApproachHeight = 0.2F;
/// Free height between an object and what is over it, metres.
inline constexpr float kHeadroom = 0.02F;
/// Heights within one footprint may differ by this much, metres: a bake rounds them to less.
inline constexpr float kFlatness = 0.002F;

/// A column over a flat piece of surface that the robot can reach.
struct SupportPlace {
  float x = 0;
  float z = 0;
  /// Height of the surface, metres.
  float surface = 0;
  /// Height of the floor from which it is reached, metres.
  float floor = 0;
};

/// The surfaces of a scene on which objects can stand: all that the columns of the smallest radius
/// see.
class SupportPlaces {
 public:
  /// Collects the columns between the options' heights over a floor from which the arm reaches
  /// them, and flat together with the eight around.
  SupportPlaces(const Scene& scene, const FloorMap& floor, const ArmReach& reach,
                const EpisodeSamplerOptions& options);

  /// Row by row, the lower one of a column first.
  [[nodiscard]] const std::vector<SupportPlace>& places() const { return places_; }

  /// The highest surface under an object's footprint, which must be flat and free up to kHeadroom
  /// over the object, and have room for a gripper over its middle; one cell around it, too. None
  /// where it is not so. Only the footprint's rectangle and top count; heights in metres.
  [[nodiscard]] std::optional<float> surfaceUnder(const Footprint& footprint, float surface) const;

 private:
  [[nodiscard]] bool isFlatAround(const Column& column, float surface) const;

  const Scene* scene_;
  std::vector<SupportPlace> places_;
};

}  // namespace galactic::bake
