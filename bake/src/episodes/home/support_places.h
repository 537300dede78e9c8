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

/// Free height over an object in which a gripper comes from above, meters: as wide as the largest
/// sphere.
inline constexpr float kApproachHeight = 0.2F;
/// Free height between an object and what is over it, meters.
inline constexpr float kHeadroom = 0.02F;

/// A column over a flat piece of surface that the robot can reach.
struct SupportPlace {
  float x = 0;
  float z = 0;
  /// Height of the surface, meters.
  float surface = 0;
  /// Height of the floor from which it is reached, meters, and FloorPlace::part.
  float floor = 0;
  std::uint32_t part = 0;
  /// Number of the flat surface that it belongs to: neighboring columns of one height.
  std::uint32_t surface_id = 0;
};

/// Whether a point on a surface (world frame, meters) belongs to the region: whether the region's
/// box is there, or somewhat over it, as the boxes of datasets are.
[[nodiscard]] bool contains(const SupportRegion& region, const Vec3& point);

/// From where surfaces have to be within reach.
struct Reachable {
  const FloorMap& floor;
  const ArmReach& reach;
};

/// The surfaces of a scene on which objects can stand: all that the columns of the smallest radius
/// see, or those of them in receptacles.
class SupportPlaces {
 public:
  /// Collects the columns between the options' heights over a floor from which the arm reaches
  /// them, and flat together with the eight around. `receptacles` must outlive the result.
  SupportPlaces(const Scene& scene, const Reachable& from,
                std::span<const SupportRegion> receptacles, const EpisodeGeneratorOptions& options);

  /// Row by row, the lower one of a column first.
  [[nodiscard]] const std::vector<SupportPlace>& places() const { return places_; }

  /// A place, each as likely; with SupportChoice::kBoth one in a receptacle half of the time.
  [[nodiscard]] const SupportPlace& draw(Random& random) const;

  /// Different surfaces among the places.
  [[nodiscard]] std::size_t surfaceCount() const;

  /// Whether objects may be put at this point of a surface: with SupportChoice::kReceptacles only
  /// in one.
  [[nodiscard]] bool isAllowed(const Vec3& point) const;

  /// The highest surface under an object's footprint, which must be flat and free up to kHeadroom
  /// over the object, and have room for a gripper over its middle; one cell around it, too. None
  /// where it is not so. Only the footprint's rectangle and top count; heights in meters.
  [[nodiscard]] std::optional<float> surfaceUnder(const Footprint& footprint, float surface) const;

 private:
  [[nodiscard]] std::vector<SupportPlace> flatPlaces() const;
  [[nodiscard]] bool isInReceptacle(const Vec3& point) const;

  const Scene* scene_;
  std::span<const SupportRegion> receptacles_;
  SupportChoice choice_;
  float flatness_ = 0;
  std::vector<SupportPlace> places_;
  /// Those in receptacles, for SupportChoice::kBoth.
  std::vector<std::uint32_t> in_receptacles_;
};

}  // namespace galactic::bake
