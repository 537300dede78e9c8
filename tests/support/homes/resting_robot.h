#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "simulation/collision/sphere_batch.h"
#include "support/homes/resting_bodies.h"

namespace galactic::test {

/// Spheres by eights as a robot's are, each eight of its own radius, with their bounds.
class RobotOfEights {
 public:
  /// `radii`: of each eight.
  RobotOfEights(const std::vector<Vec3>& centers, std::vector<float> radii)
      : groups_(centers.size() / simulation::kLanes),
        stride_(simulation::paddedToLanes(groups_)),
        radii_(std::move(radii)),
        bounds_(simulation::kBounds * stride_) {
    for (const Vec3& center : centers) {
      x_.push_back(center.x);
      y_.push_back(center.y);
      z_.push_back(center.z);
    }
    for (std::size_t n = 0; n < groups_; ++n) {
      ranges_.push_back(
          {0, radii_[n], static_cast<std::uint32_t>(n * simulation::kLanes), simulation::kLanes});
    }
    radii_.resize(stride_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<float>& along = *std::array{&x_, &y_, &z_}[axis];
      for (std::size_t n = 0; n < stride_; ++n) {
        // Lanes beyond the last group repeat the first of their eight.
        const std::size_t group = n < groups_ ? n : n / simulation::kLanes * simulation::kLanes;
        const auto [least, most] = std::ranges::minmax(
            std::span(along).subspan(group * simulation::kLanes, simulation::kLanes));
        bounds_[2 * axis * stride_ + n] = least;
        bounds_[(2 * axis + 1) * stride_ + n] = most;
      }
      const auto [least, most] = std::ranges::minmax(along);
      all_.values[2 * axis] = least;
      all_.values[2 * axis + 1] = most;
    }
  }

  [[nodiscard]] simulation::SphereBatch batch() const {
    return {x_.data(), y_.data(), z_.data(), ranges_};
  }
  [[nodiscard]] simulation::BoundedSpheres bounded() const {
    return {x_.data(),     y_.data(),      z_.data(), groups_,
            radii_.data(), bounds_.data(), stride_,   &all_};
  }
  [[nodiscard]] const simulation::CenterBounds& all() const { return all_; }

 private:
  std::size_t groups_;
  std::size_t stride_;
  std::vector<float> radii_;
  std::vector<float> bounds_;
  simulation::CenterBounds all_;
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> z_;
  std::vector<simulation::RadiusRange> ranges_;
};

/// As many centers as eights of spheres have, each eight together somewhere within two meters.
inline std::vector<Vec3> robotCenters(std::size_t eights, const std::vector<Body>& bodies,
                                      const Room& room, std::mt19937& random) {
  const Vec3 base = randomCenter(bodies, room, random);
  const auto aside = [&](float most) { return uniformIn(random, -most, most); };
  std::vector<Vec3> centers;
  for (std::size_t eight = 0; eight < eights; ++eight) {
    const Vec3 link = base + Vec3{aside(1), aside(0.3F), aside(1)};
    for (std::size_t n = 0; n < simulation::kLanes; ++n) {
      centers.push_back(link + Vec3{aside(0.1F), aside(0.1F), aside(0.1F)});
    }
  }
  return centers;
}

}  // namespace galactic::test
