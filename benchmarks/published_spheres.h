#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "galactic/bake/triangle_mesh.h"
#include "galactic/sphere_set.h"

namespace galactic::bake {

/// The spheres of the published implementation's rule for an object with these bounds: a grid (box)
/// or rings around the vertical axis (upright cylinder) of the largest radius that fits, and
/// corners of each smaller one. For measurements only; its one loop over the wrong axis is kept.
class PublishedRule {
 public:
  PublishedRule(const Bounds& bounds, const std::vector<float>& radii)
      : lo_{toDouble(bounds.min.x), toDouble(bounds.min.z), toDouble(bounds.min.y)},
        hi_{toDouble(bounds.max.x), toDouble(bounds.max.z), toDouble(bounds.max.y)},
        radii_(radii) {}

  [[nodiscard]] std::vector<SetSphere> spheres(bool cylinder) {
    double least = HUGE_VAL;
    for (std::size_t axis = 0; axis < 3; ++axis) least = std::min(least, hi_[axis] - lo_[axis]);
    bool first = true;
    for (std::size_t rank = radii_.size(); rank-- > 0;) {
      const double radius = toDouble(radii_[rank]);
      if (least < 2 * radius) continue;
      radius_index_ = static_cast<std::uint32_t>(rank);
      const double spacing = radius > 0.1 ? 2 * radius : 3 * radius;
      if (cylinder) {
        addRings(radius, spacing, first);
      } else if (first) {
        addGrid(radius, spacing);
      } else {
        addCorners(radius);
      }
      first = false;
    }
    return spheres_;
  }

 private:
  using Triple = std::array<double, 3>;

  static double toDouble(float value) { return static_cast<double>(value); }

  [[nodiscard]] int countAlong(std::size_t axis, double spacing) const {
    return std::max(static_cast<int>((hi_[axis] - lo_[axis]) / spacing) + 1, 2);
  }

  [[nodiscard]] double inset(std::size_t axis, double radius, double share) const {
    return std::lerp(lo_[axis] + radius, hi_[axis] - radius, share);
  }

  void addGrid(double radius, double spacing) {
    const std::array<int, 3> count{countAlong(0, spacing), countAlong(1, spacing),
                                   countAlong(2, spacing)};
    for (int i = 0; i < count[0]; ++i) {
      for (int j = 0; j < count[1]; ++j) {
        for (int k = 0; k < count[2]; ++k) {
          add({inset(0, radius, i / (count[0] - 1.0)), inset(1, radius, j / (count[1] - 1.0)),
               inset(2, radius, k / (count[2] - 1.0))},
              radius);
        }
      }
    }
  }

  void addCorners(double radius) {
    for (unsigned corner = 0; corner < 8; ++corner) {
      add({(corner & 1U) != 0 ? hi_[0] : lo_[0], (corner & 2U) != 0 ? hi_[1] : lo_[1],
           (corner & 4U) != 0 ? hi_[2] : lo_[2]},
          radius);
    }
  }

  void addRings(double radius, double spacing, bool first) {
    const int along_x = countAlong(0, spacing);
    const int around = along_x + countAlong(1, spacing);
    const double last_ring = first ? countAlong(2, spacing) - 1.0 : 1.0;
    const Triple middle{(lo_[0] + hi_[0]) / 2, (lo_[1] + hi_[1]) / 2, 0};
    for (int ring = 0; ring < along_x; ++ring) {
      const double z = inset(2, radius, ring / last_ring);
      for (int step = 0; step < around; ++step) {
        const double turn = 2 * std::numbers::pi * step / around;
        add({std::lerp(middle[0], hi_[0] - radius, std::cos(turn)),
             std::lerp(middle[1], hi_[1] - radius, std::sin(turn)), z},
            radius);
      }
      if (first && around > 4) add({middle[0], middle[1], z}, radius);
    }
  }

  void add(Triple centre, double radius) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double middle = (lo_[axis] + hi_[axis]) / 2;
      double& at = centre[axis];
      at = at < middle ? std::clamp(at, std::min(lo_[axis] + radius, middle), middle)
                       : std::clamp(at, middle, std::max(hi_[axis] - radius, middle));
    }
    const SetSphere sphere{{static_cast<float>(centre[0]), static_cast<float>(centre[2]),
                            static_cast<float>(centre[1])},
                           radius_index_};
    const bool known = std::find(spheres_.begin(), spheres_.end(), sphere) != spheres_.end();
    if (!known) spheres_.push_back(sphere);
  }

  /// Across, deep and up.
  Triple lo_;
  Triple hi_;
  std::vector<float> radii_;
  std::uint32_t radius_index_ = 0;
  std::vector<SetSphere> spheres_;
};

[[nodiscard]] inline std::vector<SetSphere> publishedSpheres(const Bounds& bounds, bool cylinder,
                                                             const std::vector<float>& radii) {
  return PublishedRule(bounds, radii).spheres(cylinder);
}

}  // namespace galactic::bake
