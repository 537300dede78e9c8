#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "galactic/planning_scene.h"
#include "galactic/pose.h"
#include "galactic/shapes.h"
#include "simulation/collision/sphere_batch.h"

namespace galactic::simulation {

/// Spheres of rigid parts, which are first assembled in the frame of the robot's root, then moved
/// to many places of its base.
class SphereCloud {
 public:
  struct Sphere {
    /// Index of the part in whose frame the sphere is.
    std::uint32_t part = 0;
    SetSphere sphere;
  };
  SphereCloud() = default;
  /// `radii`: of the working set, meters.
  SphereCloud(std::span<const Sphere> spheres, std::span<const float> radii);

  [[nodiscard]] std::size_t paddedCount() const { return entries_.size(); }
  /// The index, among the spheres given to the constructor, of an entry of at(); padding entries
  /// repeat a sphere.
  [[nodiscard]] std::uint32_t sphereOf(std::size_t entry) const { return numbers_[entry]; }
  /// root_from_part of all parts.
  void assemble(std::span<const Pose> parts);
  /// The farthest that an assembled sphere reaches from the root's vertical axis, meters.
  [[nodiscard]] float reach() const;
  /// The assembled spheres in the world, for a root that lies `root_height` above the base's place;
  /// valid until the next call.
  [[nodiscard]] SphereBatch at(const BasePlace& base, float root_height);

 private:
  /// Sorted by radius; each radius is padded to whole groups of lanes.
  std::vector<Sphere> entries_;
  std::vector<std::uint32_t> numbers_;
  std::vector<RadiusRange> ranges_;
  std::vector<Vec3> in_root_;
  std::vector<float> x_, y_, z_;
};

}  // namespace galactic::simulation
