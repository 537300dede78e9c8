#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/random.h"
#include "episodes/home/arm_reach.h"
#include "episodes/home/floor_map.h"
#include "episodes/home/placed_object.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/scene.h"

namespace galactic::bake {

/// Free height above an object that a gripper needs to come from above, meters: the diameter of the
/// largest sphere.
inline constexpr float kApproachHeight = 0.2F;
/// Free height between an object and what is above it, meters.
inline constexpr float kHeadroom = 0.02F;

/// A column over a flat piece of surface that the robot can reach.
struct SupportPlace {
  float x = 0;
  float z = 0;
  /// Height of the surface, meters.
  float surface = 0;
  /// Height in meters of the floor from which it is reached, and FloorPlace::part of that floor.
  float floor = 0;
  std::uint32_t part = 0;
  /// Number of the flat surface that it belongs to: connected columns of about the same height.
  std::uint32_t surface_id = 0;
};

/// Whether a point on a surface (world frame, meters) belongs to the region: whether the region's
/// box contains it or is slightly above or below it, as is usual in datasets.
[[nodiscard]] bool contains(const SupportRegion& region, const Vec3& point);

/// The floor and the arm that surfaces must be within reach of.
struct Reachable {
  const FloorMap& floor;
  const ArmReach& reach;
};

/// The surfaces of a scene on which objects can stand: all that the columns of the smallest radius
/// show, or only those in receptacles.
class SupportPlaces {
 public:
  /// Collects columns whose surface is at one of the options' heights above a floor from which the
  /// arm reaches it, and is flat together with those of the eight neighbors. `receptacles` must
  /// outlive the result.
  SupportPlaces(const Scene& scene, const Reachable& from,
                std::span<const SupportRegion> receptacles, const EpisodeGeneratorOptions& options);

  /// Row by row, the lower place of a column first.
  [[nodiscard]] const std::vector<SupportPlace>& places() const { return places_; }

  /// Draws a place, all with the same probability; with SupportChoice::kBoth, one in a receptacle
  /// half of the time.
  [[nodiscard]] const SupportPlace& draw(Random& random) const;

  /// Number of different surfaces among the places.
  [[nodiscard]] std::size_t surfaceCount() const;

  /// Whether objects may be put at this point of a surface; with SupportChoice::kReceptacles, only
  /// in receptacles.
  [[nodiscard]] bool isAllowed(const Vec3& point) const;

  /// The highest surface under an object's footprint. None unless the surface, including one cell
  /// around the footprint, is flat and free up to kHeadroom above the object, and has room for a
  /// gripper above the middle. Uses only the footprint's rectangle and top; heights in meters.
  [[nodiscard]] std::optional<float> surfaceUnder(const Footprint& footprint, float surface) const;

 private:
  [[nodiscard]] std::vector<SupportPlace> flatPlaces() const;
  [[nodiscard]] bool isInReceptacle(const Vec3& point) const;

  const Scene* scene_;
  std::span<const SupportRegion> receptacles_;
  SupportChoice choice_;
  float flatness_ = 0;
  std::vector<SupportPlace> places_;
  /// Indices of places in receptacles, for SupportChoice::kBoth.
  std::vector<std::uint32_t> in_receptacles_;
};

}  // namespace galactic::bake
