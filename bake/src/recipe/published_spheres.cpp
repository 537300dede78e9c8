#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "recipe/collection_shape.h"

namespace galactic::bake {
namespace {

/// Above this radius spheres stand side by side; below it there are gaps of one radius between
/// them.
constexpr double kLargeRadius = 0.1;
/// The published simulator computes in floats and compares fuzzily.
constexpr double kSameCenter = 1e-7;

/// The rule for one box, with x across, y deep and z up.
class PublishedRule {
 public:
  PublishedRule(const CollectionObject& object, const std::vector<float>& radii)
      : lo_(object.box_min), hi_(object.box_max), radii_(radii) {}

  [[nodiscard]] std::vector<HandSphere> spheres(SphereTechnique technique) {
    double least = HUGE_VAL;
    for (std::size_t axis = 0; axis < 3; ++axis) least = std::min(least, hi_[axis] - lo_[axis]);
    bool first = true;
    for (std::size_t rank = radii_.size(); rank-- > 0;) {
      const auto radius = static_cast<double>(radii_[rank]);
      if (least < 2 * radius) continue;
      radius_ = radius;
      const double spacing = radius > kLargeRadius ? 2 * radius : 3 * radius;
      if (technique == SphereTechnique::kUprightCylinder) {
        addRings(spacing, first);
      } else if (first) {
        addGrid(spacing);
      } else {
        addCorners();
      }
      first = false;
    }
    return spheres_;
  }

 private:
  using Triple = std::array<double, 3>;

  [[nodiscard]] int countAlong(std::size_t axis, double spacing) const {
    // Bounded, because the smallest spheres along the largest extent would be a few thousand.
    const double count = (hi_[axis] - lo_[axis]) / spacing;
    return std::max(static_cast<int>(std::min(count, kMostAlong)) + 1, 2);
  }

  [[nodiscard]] double inset(std::size_t axis, double share) const {
    return std::lerp(lo_[axis] + radius_, hi_[axis] - radius_, share);
  }

  void addGrid(double spacing) {
    const std::array<int, 3> count{countAlong(0, spacing), countAlong(1, spacing),
                                   countAlong(2, spacing)};
    for (int i = 0; i < count[0]; ++i) {
      for (int j = 0; j < count[1]; ++j) {
        for (int k = 0; k < count[2]; ++k) {
          add({inset(0, i / (count[0] - 1.0)), inset(1, j / (count[1] - 1.0)),
               inset(2, k / (count[2] - 1.0))});
        }
      }
    }
  }

  void addCorners() {
    for (unsigned corner = 0; corner < 8; ++corner) {
      add({(corner & 1U) != 0 ? hi_[0] : lo_[0], (corner & 2U) != 0 ? hi_[1] : lo_[1],
           (corner & 4U) != 0 ? hi_[2] : lo_[2]});
    }
  }

  void addRings(double spacing, bool first) {
    const int along_x = countAlong(0, spacing);
    const int around = along_x + countAlong(1, spacing);
    const double last_ring = first ? countAlong(2, spacing) - 1.0 : 1.0;
    const Triple middle{(lo_[0] + hi_[0]) / 2, (lo_[1] + hi_[1]) / 2, 0};
    for (int ring = 0; ring < along_x; ++ring) {
      const double z = inset(2, ring / last_ring);
      for (int step = 0; step < around; ++step) {
        const double turn = 2 * std::numbers::pi * step / around;
        add({std::lerp(middle[0], hi_[0] - radius_, std::cos(turn)),
             std::lerp(middle[1], hi_[1] - radius_, std::sin(turn)), z});
      }
      if (first && around > 4) add({middle[0], middle[1], z});
    }
  }

  void add(Triple center) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double middle = (lo_[axis] + hi_[axis]) / 2;
      double& at = center[axis];
      at = at < middle ? std::clamp(at, std::min(lo_[axis] + radius_, middle), middle)
                       : std::clamp(at, middle, std::max(hi_[axis] - radius_, middle));
    }
    const bool known =
        std::any_of(spheres_.begin(), spheres_.end(), [&center, this](const HandSphere& sphere) {
          return sphere.radius == radius_ && isNear(sphere.center, center);
        });
    if (!known) spheres_.push_back({.center = center, .radius = radius_});
  }

  static bool isNear(const Triple& a, const Triple& b) {
    return std::abs(a[0] - b[0]) < kSameCenter && std::abs(a[1] - b[1]) < kSameCenter &&
           std::abs(a[2] - b[2]) < kSameCenter;
  }

  static constexpr double kMostAlong = 100;

  Triple lo_;
  Triple hi_;
  std::vector<float> radii_;
  double radius_ = 0;
  std::vector<HandSphere> spheres_;
};

}  // namespace

std::vector<HandSphere> publishedSpheres(const CollectionObject& object,
                                         const std::vector<float>& radii) {
  if (object.technique == SphereTechnique::kListed) return {};
  return PublishedRule(object, radii).spheres(object.technique);
}

}  // namespace galactic::bake
