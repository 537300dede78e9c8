#include "galactic/self_collision.h"

#include <algorithm>
#include <cmath>

#include "galactic/kinematics.h"

namespace galactic {
namespace {

/// More than rounding moves centers, meters: a ball must never seem farther away than the spheres
/// in it.
constexpr float kSlack = 1e-4F;

/// Whether two centers are nearer to each other than `reach`, the sum of their radii and a margin.
bool areWithin(const Vec3& a, const Vec3& b, float reach) {
  const Vec3 between = a - b;
  return reach > 0 && dot(between, between) < reach * reach;
}

}  // namespace

SelfCollision::SelfCollision(const Robot& robot) : robot_(&robot) {
  balls_.reserve(robot.groups().size());
  for (const SphereGroup& group : robot.groups()) balls_.push_back(ballAround(robot, group));
  std::vector<Pose> links(robot.links().size());
  forwardKinematics(robot.links(), {}, robot.startPositions(), links);
  for (const GroupPair& pair : robot.testedPairs()) {
    if (!areNear(pair, links, 0)) pairs_.push_back(pair);
  }
}

SelfCollision::Ball SelfCollision::ballAround(const Robot& robot, const SphereGroup& group) {
  Ball ball;
  if (group.spheres.empty()) return ball;
  for (const SetSphere& sphere : group.spheres) ball.center = ball.center + sphere.center;
  ball.center = ball.center * (1 / static_cast<float>(group.spheres.size()));
  for (const SetSphere& sphere : group.spheres) {
    const Vec3 out = sphere.center - ball.center;
    const float reach = std::sqrt(dot(out, out)) + robot.radii()[sphere.radius_index];
    ball.radius = std::max(ball.radius, reach + kSlack);
  }
  return ball;
}

bool SelfCollision::areNear(const GroupPair& pair, std::span<const Pose> links,
                            float margin) const noexcept {
  const SphereGroup& first = robot_->groups()[pair.first];
  const SphereGroup& second = robot_->groups()[pair.second];
  const Pose& of_first = links[first.link];
  const Pose& of_second = links[second.link];
  const Ball& a = balls_[pair.first];
  const Ball& b = balls_[pair.second];
  const Vec3 about_second = of_second * b.center;
  if (!areWithin(of_first * a.center, about_second, a.radius + b.radius + margin)) return false;
  for (const SetSphere& own : first.spheres) {
    const Vec3 center = of_first * own.center;
    const float radius = robot_->radii()[own.radius_index];
    if (!areWithin(center, about_second, radius + b.radius + margin)) continue;
    for (const SetSphere& other : second.spheres) {
      const float both = radius + robot_->radii()[other.radius_index];
      if (areWithin(center, of_second * other.center, both + margin)) return true;
    }
  }
  return false;
}

bool SelfCollision::touches(std::span<const Pose> links, float margin) const noexcept {
  return std::ranges::any_of(pairs_,
                             [&](const GroupPair& pair) { return areNear(pair, links, margin); });
}

}  // namespace galactic
