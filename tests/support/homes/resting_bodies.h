#pragma once
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "simulation/collision/resting_objects.h"
#include "support/oracles/resting_oracle.h"

namespace galactic::test {

inline constexpr float kRadii[] = {0.015F, 0.05F, 0.12F};
inline constexpr float kLargestRadius = 0.12F;
/// Spheres this near to touching are left out of comparisons with double precision: floats of a
/// few meters are a micrometer apart.
inline constexpr double kTies = 1e-5;

inline std::vector<Body> randomBodies(const Room& room, std::size_t count, std::mt19937& random) {
  std::vector<Body> bodies;
  bodies.reserve(count);
  for (std::size_t n = 0; n < count; ++n) bodies.push_back(randomBody(room, random));
  return bodies;
}

/// A center near one of the bodies, or anywhere when there is none; often exactly at the border of
/// a cell.
inline Vec3 randomCenter(const std::vector<Body>& bodies, const Room& room, std::mt19937& random) {
  if (bodies.empty()) return randomBody(room, random).pose.translation;
  const Point3 near = bodies[random() % bodies.size()].solid().at({0, 0, 0});
  const float reach = room.most + 0.15F;
  const auto coordinate = [&](std::size_t axis) {
    return static_cast<float>(near[axis]) + uniformIn(random, -reach, reach);
  };
  Vec3 center{coordinate(0), coordinate(1), coordinate(2)};
  const auto border = [](float at) {
    return (std::floor(at / simulation::kCellEdge) + 0.5F) * simulation::kCellEdge;
  };
  if (random() % 4 == 0) center.x = border(center.x);
  if (random() % 4 == 0) center.y = border(center.y);
  if (random() % 4 == 0) center.z = border(center.z);
  return center;
}

inline simulation::RestingObjects restingAt(const std::vector<Body>& bodies) {
  simulation::RestingObjects objects(bodies.size(), kLargestRadius);
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    objects.insert(static_cast<std::uint32_t>(n), bodies[n].resting());
  }
  return objects;
}

/// All that are found.
inline std::vector<simulation::SphereHit> hitsOf(const simulation::RestingObjects& objects,
                                                 const simulation::SphereBatch& batch) {
  std::vector<simulation::SphereHit> hits(10000);
  hits.resize(objects.hits(batch, hits));
  return hits;
}

}  // namespace galactic::test
