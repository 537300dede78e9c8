// Plans motions of base and arm among furniture and objects, by RRT-Connect (Kuffner and LaValle
// 2000): in eight homes, from where the robot is to a pose that is drawn. Usage: plan_motion WORLD
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/path_finder.h"
#include "galactic/planning_scene.h"

namespace {

constexpr float kPi = 3.14159265F;
/// Longest edge of a tree; see Home::distance().
constexpr float kEdge = 0.4F;
/// How near parts of the robot may come to each other, meters.
constexpr float kMargin = 0.01F;
constexpr int kMostDraws = 3000;

struct Pose {
  galactic::BasePlace base;
  std::vector<float> joints;

  [[nodiscard]] galactic::RobotPose view() const { return {base, joints}; }
};

/// What a planner asks about one home.
class Home {
 public:
  Home(const galactic::World& world, const galactic::SimulationOptions& options,
       const galactic::EnvState& state)
      : robot_(world.robot()),
        scene_(world, options),
        finder_(orThrow(
            galactic::PathFinder::create(world, state.scene, state.world_from_root.translation))) {
    scene_.update(state);
    start_ = {scene_.baseOf(state), state.joint_positions};
    is_unlimited_.resize(state.joint_positions.size());
    for (const galactic::ControlledJoint& joint : robot_.controlledJoints()) {
      is_unlimited_[joint.position] = joint.upper == std::numeric_limits<float>::max();
    }
  }

  [[nodiscard]] const Pose& start() const { return start_; }
  [[nodiscard]] std::size_t asked() const { return asked_; }

  /// Anywhere on the floor that the robot reaches, joints anywhere within their limits.
  template <class Random>
  Pose draw(Random& random) {
    std::uniform_real_distribution<float> share(0, 1);
    Pose pose = start_;
    std::uniform_int_distribution<std::size_t> place(0, finder_.places().size() - 1);
    pose.base = {finder_.places()[place(random)], kPi * (2 * share(random) - 1)};
    for (const galactic::ControlledJoint& joint : robot_.controlledJoints()) {
      const float lower = std::max(joint.lower, -kPi);
      const float upper = std::min(joint.upper, kPi);
      pose.joints[joint.position] = lower + (upper - lower) * share(random);
    }
    return pose;
  }
  template <class Random>
  std::optional<Pose> drawFree(Random& random) {
    for (int n = 0; n < kMostDraws; ++n) {
      const Pose pose = draw(random);
      if (isFree(pose)) return pose;
    }
    return std::nullopt;
  }

  bool isFree(const Pose& pose) {
    ++asked_;
    scene_.setJoints(pose.joints);
    return !scene_.touchesItself(kMargin) && scene_.isFree(pose.base);
  }
  /// Looks at the way, too, so closely that nothing passes through anything; whether the robot
  /// touches itself is asked at the end.
  bool isMotionFree(const Pose& from, const Pose& to) {
    return isFree(to) && (++asked_, scene_.isMotionFree(from.view(), to.view()));
  }

  /// Meters; four radians are as far as one of them.
  [[nodiscard]] float distance(const Pose& a, const Pose& b) const {
    const galactic::Vec3 way = b.base.position - a.base.position;
    const float turn = galactic::wrappedAngle(b.base.yaw - a.base.yaw) / 4;
    float sum = dot(way, way) + turn * turn;
    for (std::size_t n = 0; n < a.joints.size(); ++n) {
      const float move = moveOf(n, a, b) / 4;
      sum += move * move;
    }
    return std::sqrt(sum);
  }
  /// On the way, on the floor. None where there is no floor.
  std::optional<Pose> between(const Pose& a, const Pose& b, float share) {
    Pose pose = a;
    pose.base.position = a.base.position + (b.base.position - a.base.position) * share;
    pose.base.yaw += share * galactic::wrappedAngle(b.base.yaw - a.base.yaw);
    for (std::size_t n = 0; n < a.joints.size(); ++n) {
      pose.joints[n] += share * moveOf(n, a, b);
    }
    const auto floor =
        scene_.floorAt(pose.base.position.x, pose.base.position.z, a.base.position.y);
    if (!floor) return std::nullopt;
    pose.base.position.y = *floor;
    return pose;
  }

 private:
  /// How far a joint goes: the shorter way round where it turns without limits.
  [[nodiscard]] float moveOf(std::size_t position, const Pose& a, const Pose& b) const {
    const float move = b.joints[position] - a.joints[position];
    return is_unlimited_[position] ? galactic::wrappedAngle(move) : move;
  }

  const galactic::Robot& robot_;
  galactic::PlanningScene scene_;
  galactic::PathFinder finder_;
  std::vector<bool> is_unlimited_;
  Pose start_;
  std::size_t asked_ = 0;
};

struct Tree {
  std::vector<Pose> poses;
  std::vector<std::size_t> parents;
};

enum class Growth : std::uint8_t { kBlocked, kGrown, kArrived };

/// Grows a tree by an edge toward a pose, or to it.
Growth grow(Home& home, Tree& tree, const Pose& to) {
  const auto nearer = [&](const Pose& a, const Pose& b) {
    return home.distance(a, to) < home.distance(b, to);
  };
  const auto nearest = std::min_element(tree.poses.begin(), tree.poses.end(), nearer);
  const float far = home.distance(*nearest, to);
  const std::optional<Pose> next = far <= kEdge ? to : home.between(*nearest, to, kEdge / far);
  if (!next || !home.isMotionFree(*nearest, *next)) return Growth::kBlocked;
  tree.parents.push_back(static_cast<std::size_t>(nearest - tree.poses.begin()));
  tree.poses.push_back(*next);
  return far <= kEdge ? Growth::kArrived : Growth::kGrown;
}

/// From the last pose of a tree to its first.
std::vector<Pose> branch(const Tree& tree) {
  std::vector<Pose> poses{tree.poses.back()};
  for (std::size_t n = tree.poses.size() - 1; n != 0; n = tree.parents[n]) {
    poses.push_back(tree.poses[tree.parents[n]]);
  }
  return poses;
}

/// Poses from `start` to `goal` with a free motion from each to the next; none where nothing was
/// found.
template <class Random>
std::vector<Pose> plan(Home& home, const Pose& start, const Pose& goal, Random& random) {
  Tree trees[2] = {{{start}, {0}}, {{goal}, {0}}};
  for (int draw = 0; draw < kMostDraws; ++draw) {
    Tree& growing = trees[draw % 2];
    Tree& other = trees[1 - draw % 2];
    if (grow(home, growing, home.draw(random)) == Growth::kBlocked) continue;
    const Pose reached = growing.poses.back();
    Growth growth = Growth::kGrown;
    while (growth == Growth::kGrown) growth = grow(home, other, reached);
    if (growth == Growth::kBlocked) continue;
    std::vector<Pose> path = branch(trees[0]);
    std::reverse(path.begin(), path.end());
    const std::vector<Pose> rest = branch(trees[1]);
    path.insert(path.end(), rest.begin() + 1, rest.end());
    return path;
  }
  return {};
}

/// Leaves out poses that the robot can pass by.
std::vector<Pose> shortened(Home& home, const std::vector<Pose>& path) {
  std::vector<Pose> shorter{path.front()};
  for (std::size_t at = 0; at + 1 < path.size();) {
    std::size_t next = path.size() - 1;
    while (next > at + 1 && !home.isMotionFree(path[at], path[next])) --next;
    shorter.push_back(path[next]);
    at = next;
  }
  return shorter;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: plan_motion WORLD\n");
    return galactic::kExitUsage;
  }
  const auto world = orThrow(galactic::World::open(argv[1]));
  galactic::SimulationOptions options = world.withTask();
  options.envs = 8;
  const auto simulator = orThrow(galactic::BatchSimulator::create(world, options));
  std::mt19937 random(1);
  std::size_t found = 0;
  std::size_t asked = 0;
  const auto began = std::chrono::steady_clock::now();
  for (std::size_t env = 0; env < simulator.envCount(); ++env) {
    Home home(world, options, simulator.envState(env));
    const std::optional<Pose> goal = home.drawFree(random);
    const std::vector<Pose> path =
        goal ? plan(home, home.start(), *goal, random) : std::vector<Pose>{};
    if (path.empty()) {
      std::printf("home %zu: nothing found after %zu questions\n", env, home.asked());
    } else {
      const std::size_t length = shortened(home, path).size() - 1;
      std::printf("home %zu: %zu motions, shortened from %zu, after %zu questions\n", env, length,
                  path.size() - 1, home.asked());
      ++found;
    }
    asked += home.asked();
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  std::printf("found %zu of %zu, %zu questions, %.0f a second\n", found, simulator.envCount(),
              asked, static_cast<double>(asked) / took.count());
  return galactic::kExitOk;
} catch (const galactic::ErrorException& failure) {
  std::fprintf(stderr, "%s\n", failure.what());
  return static_cast<int>(failure.error().code);
}
