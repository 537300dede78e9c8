#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/random.h"
#include "robot/robot_parts.h"

namespace galactic::bake {
namespace {

/// A sphere of a group, in the world.
struct Ball {
  Vec3 center;
  float radius = 0;
};

bool overlap(const Ball& a, const Ball& b) {
  const Vec3 between = a.center - b.center;
  const float reach = a.radius + b.radius;
  return dot(between, between) < reach * reach;
}

/// The bounding sphere of a group's spheres, in the group's frame.
Ball boundingBall(const BakedGroup& group, const std::vector<float>& radii) {
  Vec3 sum;
  for (const SetSphere& sphere : group.spheres.spheres) sum = sum + sphere.center;
  Ball ball{sum * (1 / static_cast<float>(group.spheres.spheres.size())), 0};
  for (const SetSphere& sphere : group.spheres.spheres) {
    const Vec3 from_center = sphere.center - ball.center;
    ball.radius = std::max(ball.radius,
                           std::sqrt(dot(from_center, from_center)) + radii[sphere.radius_index]);
  }
  return ball;
}

/// Tests whether the spheres of two groups touch in a pose.
class PairSampler {
 public:
  explicit PairSampler(const BakedRobot& robot)
      : robot_(robot),
        bounds_(robot.groups.size()),
        balls_(robot.groups.size()),
        world_from_link_(robot.kinematics.links.size()) {
    for (std::size_t n = 0; n < robot.groups.size(); ++n) {
      const BakedGroup& group = robot.groups[n];
      if (!group.spheres.spheres.empty()) bounds_[n] = boundingBall(group, robot.radii);
    }
  }

  /// Places all spheres for a vector of joint positions.
  void pose(std::span<const float> positions) {
    forwardKinematics(robot_.kinematics.links, {}, positions, world_from_link_);
    for (std::size_t n = 0; n < robot_.groups.size(); ++n) {
      const BakedGroup& group = robot_.groups[n];
      const Pose& world_from_group = world_from_link_[group.link];
      balls_[n].clear();
      for (const SetSphere& sphere : group.spheres.spheres) {
        balls_[n].push_back({world_from_group * sphere.center, robot_.radii[sphere.radius_index]});
      }
    }
  }

  [[nodiscard]] bool touch(std::size_t first, std::size_t second) const {
    if (!overlap(placed(first), placed(second))) return false;
    for (const Ball& a : balls_[first]) {
      for (const Ball& b : balls_[second]) {
        if (overlap(a, b)) return true;
      }
    }
    return false;
  }

 private:
  [[nodiscard]] Ball placed(std::size_t group) const {
    return {world_from_link_[robot_.groups[group].link] * bounds_[group].center,
            bounds_[group].radius};
  }

  const BakedRobot& robot_;
  std::vector<Ball> bounds_;
  std::vector<std::vector<Ball>> balls_;
  std::vector<Pose> world_from_link_;
};

std::vector<float> randomPositions(const FlatKinematics& kinematics, Random& random) {
  std::vector<float> positions;
  for (const PositionLimits& limits : kinematics.limits) {
    const bool limited = limits.lower > std::numeric_limits<float>::lowest();
    const double lower = limited ? static_cast<double>(limits.lower) : -std::numbers::pi;
    const double upper = limited ? static_cast<double>(limits.upper) : std::numbers::pi;
    const double position = lower + (upper - lower) * random.unit();
    positions.push_back(static_cast<float>(position));
  }
  return positions;
}

/// The group of each link.
std::vector<std::size_t> groupOfLinks(const BakedRobot& robot) {
  std::vector<std::size_t> group_of(robot.kinematics.links.size());
  for (std::size_t n = 0; n < robot.groups.size(); ++n) {
    for (const std::uint32_t link : robot.groups[n].links) group_of[link] = n;
  }
  return group_of;
}

/// Pairs of groups that a joint connects, directly or through groups without spheres.
std::vector<std::pair<std::size_t, std::size_t>> adjacentGroups(
    const BakedRobot& robot, const std::vector<std::size_t>& group_of) {
  std::vector<std::pair<std::size_t, std::size_t>> adjacent;
  for (std::size_t n = 0; n < robot.groups.size(); ++n) {
    std::int32_t parent = robot.kinematics.links[robot.groups[n].link].parent;
    while (parent >= 0) {
      const std::size_t above = group_of[static_cast<std::size_t>(parent)];
      adjacent.emplace_back(above, n);
      if (!robot.groups[above].spheres.spheres.empty()) break;
      parent = robot.kinematics.links[robot.groups[above].link].parent;
    }
  }
  return adjacent;
}

/// All pairs of groups that have spheres, ascending.
std::vector<BakedPair> pairsWithSpheres(const BakedRobot& robot) {
  std::vector<std::uint16_t> with_spheres;
  for (std::size_t n = 0; n < robot.groups.size(); ++n) {
    if (robot.groups[n].spheres.spheres.empty()) continue;
    with_spheres.push_back(static_cast<std::uint16_t>(n));
  }
  std::vector<BakedPair> pairs;
  for (std::size_t a = 0; a < with_spheres.size(); ++a) {
    for (std::size_t b = a + 1; b < with_spheres.size(); ++b) {
      pairs.push_back({with_spheres[a], with_spheres[b], PairKind::kTested});
    }
  }
  return pairs;
}

/// Decides the pairs that are still to be tested by sampling many poses.
void samplePairs(const BakedRobot& robot, std::vector<BakedPair>& pairs) {
  std::vector<std::size_t> touches(pairs.size());
  PairSampler sampler(robot);
  constexpr std::uint64_t kSeed = 20230613;
  Random random(kSeed);
  for (std::size_t sample = 0; sample < kSelfCollisionSamples; ++sample) {
    sampler.pose(sample == 0 ? robot.kinematics.start_positions
                             : randomPositions(robot.kinematics, random));
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      if (pairs[n].kind == PairKind::kTested && sampler.touch(pairs[n].first, pairs[n].second)) {
        ++touches[n];
      }
    }
  }
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (pairs[n].kind != PairKind::kTested) continue;
    if (touches[n] == 0) pairs[n].kind = PairKind::kNever;
    if (touches[n] == kSelfCollisionSamples) pairs[n].kind = PairKind::kAlways;
  }
}

}  // namespace

std::vector<BakedPair> classifyPairs(
    const BakedRobot& robot, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& ignored) {
  const std::vector<std::size_t> group_of = groupOfLinks(robot);
  std::vector<BakedPair> pairs = pairsWithSpheres(robot);
  const auto mark = [&](std::size_t a, std::size_t b, PairKind kind) {
    const auto [first, second] = std::minmax(a, b);
    for (BakedPair& pair : pairs) {
      if (pair.first == first && pair.second == second) pair.kind = kind;
    }
  };
  for (const auto& [a, b] : ignored) mark(group_of[a], group_of[b], PairKind::kIgnored);
  for (const auto& [a, b] : adjacentGroups(robot, group_of)) mark(a, b, PairKind::kAdjacent);
  samplePairs(robot, pairs);
  return pairs;
}

}  // namespace galactic::bake
