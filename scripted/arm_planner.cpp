#include "scripted/arm_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace galactic::scripted {
namespace {

/// Distance between the positions that are checked on a line, radians or meters: finer than a step,
/// so that the check skips nothing of the robot's size.
constexpr float kResolution = 0.07F;
/// Longest line, radians or meters: an arm whose joints have wound up further would not arrive
/// within an episode.
constexpr float kLongestLine = 100;
/// Longest edge of a tree, radians or meters.
constexpr float kEdge = 0.4F;
/// The search gives up after this many nodes of both trees together, or this many random positions.
/// Connecting the trees at the end may add as many nodes again.
constexpr std::size_t kMostNodes = 1200;
constexpr int kMostDraws = 500;
/// Length of the pieces in which the hand moves straight, meters.
constexpr float kPiece = 0.02F;
/// A joint that moves farther than this within a piece jumps to another configuration of the arm,
/// radians.
constexpr float kJump = 0.6F;

}  // namespace

bool ArmPlanner::isFreeAt(const BasePlace& base, const Joints& joints) {
  scene_.setJoints(joints);
  return scene_.isFree(base);
}

bool ArmPlanner::isFree(const BasePlace& base, const Joints& from, const Joints& to) {
  const float length = arm_.distance(from, to);
  if (length > kLongestLine) return false;
  const auto pieces = std::max(1, static_cast<int>(std::ceil(length / kResolution)));
  // Check the end first: it is the likeliest to be blocked.
  for (int n = pieces; n > 0; --n) {
    arm_.interpolate(from, to, static_cast<float>(n) / static_cast<float>(pieces), between_);
    if (!isFreeAt(base, between_)) return false;
  }
  return true;
}

std::optional<ArmPath> ArmPlanner::plan(const BasePlace& base, const Joints& from, const Joints& to,
                                        std::uint64_t seed) {
  if (!isFreeAt(base, to)) return std::nullopt;
  if (isFree(base, from, to)) return ArmPath{to};
  std::optional<ArmPath> path = connect(base, from, to, seed);
  if (path) shorten(base, from, *path);
  return path;
}

ArmPath ArmPlanner::slide(const BasePlace& base, const Joints& from, HandGoal hand,
                          const Slide& slide) {
  InverseKinematicsOptions options;
  options.direction_tolerance = slide.direction_tolerance;
  const Vec3 start = hand.place;
  const int pieces = std::max(1, static_cast<int>(std::lround(slide.length / kPiece)));
  ArmPath path;
  path.reserve(static_cast<std::size_t>(pieces));
  Joints last = from;
  for (int n = 1; n <= pieces; ++n) {
    const float share = static_cast<float>(n) / static_cast<float>(pieces);
    hand.place = start + slide.way * (slide.length * share);
    const std::optional<Joints> next = solveHand(arm_, hand, last, options);
    if (!next || arm_.distance(last, *next) > kJump) break;
    if (!isFree(base, last, *next)) break;
    last = *next;
    path.push_back(last);
    if (scene_.isHolding()) {
      scene_.setJoints(last);
      scene_.countFree(base);
    }
  }
  return path;
}

std::uint32_t ArmPlanner::nearest(const Tree& tree, const Joints& to) {
  float best = std::numeric_limits<float>::max();
  std::uint32_t found = 0;
  for (std::uint32_t n = 0; n < tree.nodes.size(); ++n) {
    float sum = 0;
    for (std::size_t joint = 0; joint < arm_.joints().size(); ++joint) {
      const float way = arm_.difference(joint, tree.nodes[n], to);
      sum += way * way;
    }
    if (sum < best) {
      best = sum;
      found = n;
    }
  }
  return found;
}

ArmPlanner::Growth ArmPlanner::extend(const BasePlace& base, Tree& tree, const Joints& to) {
  const std::uint32_t parent = nearest(tree, to);
  const float length = arm_.distance(tree.nodes[parent], to);
  const bool arrives = length <= kEdge;
  Joints next = to;
  if (!arrives) arm_.interpolate(tree.nodes[parent], to, kEdge / length, next);
  if (!isFree(base, tree.nodes[parent], next)) return Growth::kBlocked;
  tree.nodes.push_back(std::move(next));
  tree.parents.push_back(parent);
  return arrives ? Growth::kArrived : Growth::kGrown;
}

std::optional<ArmPath> ArmPlanner::connect(const BasePlace& base, const Joints& from,
                                           const Joints& to, std::uint64_t seed) {
  Tree trees[2] = {{{from}, {0}}, {{to}, {0}}};
  RandomStream random(seed, 0, 0, 0);
  Joints drawn = from;
  for (int n = 0; n < kMostDraws; ++n) {
    Tree& growing = trees[n % 2];
    Tree& other = trees[1 - n % 2];
    const auto nodes = [&] { return growing.nodes.size() + other.nodes.size(); };
    if (nodes() > kMostNodes) break;
    arm_.draw(random, drawn);
    if (extend(base, growing, drawn) == Growth::kBlocked) continue;
    const Joints reached = growing.nodes.back();
    Growth growth = Growth::kGrown;
    while (growth == Growth::kGrown && nodes() <= 2 * kMostNodes) {
      growth = extend(base, other, reached);
    }
    if (growth != Growth::kArrived) continue;
    ArmPath path;
    const auto walk = [&path](const Tree& tree) {
      for (auto node = static_cast<std::uint32_t>(tree.nodes.size() - 1); node != 0;
           node = tree.parents[node]) {
        path.push_back(tree.nodes[node]);
      }
    };
    walk(trees[0]);
    std::ranges::reverse(path);
    // The trees meet in the last node of the other tree.
    if (!path.empty()) path.pop_back();
    walk(trees[1]);
    path.push_back(to);
    return path;
  }
  return std::nullopt;
}

void ArmPlanner::shorten(const BasePlace& base, const Joints& from, ArmPath& path) {
  ArmPath shorter;
  Joints at = from;
  std::size_t next = 0;
  while (next < path.size()) {
    std::size_t last = path.size() - 1;
    while (last > next && !isFree(base, at, path[last])) --last;
    at = path[last];
    shorter.push_back(at);
    next = last + 1;
  }
  path = std::move(shorter);
}

}  // namespace galactic::scripted
