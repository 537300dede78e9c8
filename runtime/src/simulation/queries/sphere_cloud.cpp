#include "simulation/queries/sphere_cloud.h"

#include <algorithm>
#include <cmath>

namespace galactic::simulation {

SphereCloud::SphereCloud(std::span<const Sphere> spheres, std::span<const float> radii) {
  entries_.reserve(spheres.size() + kLanes * radii.size());
  ranges_.reserve(radii.size());
  for (std::uint32_t radius = 0; radius < radii.size(); ++radius) {
    const auto first = static_cast<std::uint32_t>(entries_.size());
    for (std::uint32_t n = 0; n < spheres.size(); ++n) {
      if (spheres[n].sphere.radius_index != radius) continue;
      entries_.push_back(spheres[n]);
      numbers_.push_back(n);
    }
    const auto count = static_cast<std::uint32_t>(entries_.size()) - first;
    if (count == 0) continue;
    ranges_.push_back({radius, radii[radius], first, count});
    while (entries_.size() % kLanes != 0) {
      const Sphere last = entries_.back();
      entries_.push_back(last);
      numbers_.push_back(numbers_.back());
    }
  }
  in_root_.resize(entries_.size());
  x_.resize(entries_.size());
  y_.resize(entries_.size());
  z_.resize(entries_.size());
}

void SphereCloud::assemble(std::span<const Pose> parts) {
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    in_root_[n] = parts[entries_[n].part] * entries_[n].sphere.center;
  }
}

float SphereCloud::reach() const {
  float most = 0;
  for (const RadiusRange& range : ranges_) {
    for (std::size_t n = range.first; n < range.first + range.count; ++n) {
      const Vec3& p = in_root_[n];
      most = std::max(most, std::sqrt(p.x * p.x + p.z * p.z) + range.radius);
    }
  }
  return most;
}

SphereBatch SphereCloud::at(const BasePlace& base, float root_height) {
  const float cosine = std::cos(base.yaw);
  const float sine = std::sin(base.yaw);
  const float up = base.position.y + root_height;
  for (std::size_t n = 0; n < in_root_.size(); ++n) {
    const Vec3& p = in_root_[n];
    x_[n] = cosine * p.x + sine * p.z + base.position.x;
    y_[n] = p.y + up;
    z_[n] = cosine * p.z - sine * p.x + base.position.z;
  }
  return {x_.data(), y_.data(), z_.data(), ranges_};
}

}  // namespace galactic::simulation
