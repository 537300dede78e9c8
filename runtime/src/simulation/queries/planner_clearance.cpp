#include "simulation/queries/planner_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "galactic/kinematics.h"
#include "galactic/robot.h"
#include "simulation/collision/resting_box.h"
#include "simulation/collision/sphere_bits.h"

namespace galactic::simulation {
namespace {

using detail::Directions;
using detail::GridDistance;
using detail::SignedDistance;

/// The numbers of a base: x, y, z and yaw.
constexpr std::size_t kBaseNumbers = 4;

/// Whether any joint between a link and the root is moved by actions.
bool isMoved(const Robot& robot, std::uint32_t link) {
  for (auto n = static_cast<std::int32_t>(link); n >= 0;) {
    const LinkFrame& frame = robot.links()[static_cast<std::size_t>(n)];
    const auto first = static_cast<std::int64_t>(frame.position);
    const auto end = first + std::int64_t{positionCount(frame.type)};
    const bool is_moved =
        std::ranges::any_of(robot.controlledJoints(), [&](const ControlledJoint& joint) {
          return joint.position >= first && joint.position < end;
        });
    if (is_moved) return true;
    n = frame.parent;
  }
  return false;
}

/// The signed distance of a point inside of a box: its nearest face is the way out.
SignedDistance depthIn(const RestingBox& box, const Vec3& point) {
  const Vec3 from = point - box.center;
  const std::array axes{box.axis_x, box.axis_y, box.axis_z};
  const std::array half{box.half_extents.x, box.half_extents.y, box.half_extents.z};
  SignedDistance deepest{-half[0] - half[1] - half[2], {}};
  for (std::size_t n = 0; n < axes.size(); ++n) {
    const float along = dot(axes[n], from);
    const float distance = std::fabs(along) - half[n];
    if (distance > deepest.distance) deepest = {distance, axes[n] * std::copysign(1.0F, along)};
  }
  return deepest;
}

SignedDistance distanceFrom(const RestingBox& box, const Vec3& point) {
  const Vec3 away = point - nearestPoint(box, point);
  const float distance = std::sqrt(dot(away, away));
  if (distance > 0) return {distance, away * (1 / distance)};
  return depthIn(box, point);
}

/// A sphere in the world.
struct Ball {
  Vec3 center;
  float radius = 0;
  std::uint32_t radius_index = 0;
  /// Its index in its batch.
  std::size_t entry = 0;
};

template <class Visit>
void forEachBall(const SphereBatch& batch, const Visit& visit) {
  for (const RadiusRange& range : batch.ranges) {
    for (std::size_t n = range.first; n < range.first + range.count; ++n) {
      visit(Ball{{batch.x[n], batch.y[n], batch.z[n]}, range.radius, range.radius_index, n});
    }
  }
}

void takeScene(const SignedDistance& found, float most, SphereClearance& nearest) {
  if (found.distance < most) nearest = {found.distance, CastEnd::kScene, -1, found.gradient};
}

void takeBox(const RestingBox& box, std::uint32_t object, const Ball& ball,
             SphereClearance& nearest) {
  const SignedDistance found = distanceFrom(box, ball.center);
  const float distance = found.distance - ball.radius;
  if (!(distance < nearest.distance)) return;
  nearest = {distance, CastEnd::kObject, static_cast<std::int32_t>(object), found.gradient};
}

}  // namespace

WorldDistances::WorldDistances(const World& world)
    : world_(world), scenes_(world.scenes().size()) {}

const std::vector<GridDistance>& WorldDistances::of(const Scene& scene) {
  OfScene& made = scenes_[static_cast<std::size_t>(&scene - world_.scenes().data())];
  std::call_once(made.once, [&] {
    for (const ColumnGrid& grid : scene.grids()) made.grids.emplace_back(grid);
  });
  return made.grids;
}

PlannerClearance::PlannerClearance(const World& world)
    : distances_(std::make_shared<WorldDistances>(world)) {
  for (const SphereGroup& group : world.robot().groups()) {
    links_.insert(links_.end(), group.spheres.size(), group.link);
    keeps_height_.insert(keeps_height_.end(), group.spheres.size(),
                         !isMoved(world.robot(), group.link));
  }
}

std::size_t PlannerClearance::sphereCount(const PlannerEnv& env) const {
  return links_.size() + (env.held_ == nullptr ? 0 : env.held_->spheres.size());
}

std::span<const SphereClearance> PlannerClearance::measure(PlannerEnv& env, const BasePlace& base,
                                                           float most) {
  const std::vector<GridDistance>& grids = distances_->of(env.scene());
  SphereClearance nothing;
  nothing.distance = most;
  clearances_.assign(sphereCount(env), nothing);
  centers_.resize(clearances_.size());
  findNear(env, base, most);
  const auto look = [&](const Ball& ball, std::size_t sphere, Directions directions,
                        const auto& counts) {
    centers_[sphere] = ball.center;
    SphereClearance& nearest = clearances_[sphere];
    takeScene(grids[ball.radius_index].at(ball.center, most, directions), most, nearest);
    for (const std::uint32_t object : near_) {
      if (counts(object)) takeBox(env.resting().box(object), object, ball, nearest);
    }
  };
  forEachBall(env.robotAt(base), [&](const Ball& ball) {
    const std::size_t sphere = env.robot_.sphereOf(ball.entry);
    const Directions directions = keeps_height_[sphere] ? Directions::kLevel : Directions::kAll;
    look(ball, sphere, directions, [&](std::uint32_t object) {
      const auto left = std::ranges::find(env.left_, object, &PlannerEnv::Left::object);
      return left == env.left_.end() || !hasBit(left->spheres, ball.entry);
    });
  });
  if (env.held_ == nullptr) return clearances_;
  forEachBall(env.heldAt(base), [&](const Ball& ball) {
    const std::size_t sphere = links_.size() + env.held_spheres_.sphereOf(ball.entry);
    centers_[sphere] = ball.center;
    if (hasBit(env.ignored_, ball.entry)) return;
    look(ball, sphere, Directions::kAll, [](std::uint32_t) { return true; });
  });
  return clearances_;
}

void PlannerClearance::findNear(const PlannerEnv& env, const BasePlace& base, float most) {
  near_.clear();
  const float reach =
      std::max(env.reach_, env.held_ == nullptr ? 0.0F : env.held_spheres_.reach()) + most;
  for (std::uint32_t n = 0; n < env.resting().capacity(); ++n) {
    if (!env.resting().isResting(n)) continue;
    const RestingBox& box = env.resting().box(n);
    const Vec3 way = box.center - base.position;
    const float far = reach + std::sqrt(dot(box.half_extents, box.half_extents));
    if (way.x * way.x + way.z * way.z < far * far) near_.push_back(n);
  }
}

void PlannerClearance::derive(const PlannerEnv& env, const RobotPose& pose,
                              const ClearanceGradients& gradients) const {
  const Robot& robot = env.world().robot();
  const Pose world_from_root = env.worldFromRoot(pose.base);
  const Pose root_from_world = inverse(world_from_root);
  const std::size_t positions = robot.positionCount();
  for (std::size_t n = 0; n < clearances_.size(); ++n) {
    const Vec3 along = clearances_[n].direction;
    if (!gradients.bases.empty()) {
      const Vec3 turn = cross({0, 1, 0}, centers_[n] - pose.base.position);
      const std::array moves{along.x, along.y, along.z, dot(turn, along)};
      std::ranges::copy(moves,
                        gradients.bases.begin() + static_cast<std::ptrdiff_t>(n * kBaseNumbers));
    }
    if (!gradients.joints.empty()) {
      const std::span<float> moves = gradients.joints.subspan(n * positions, positions);
      if (along == Vec3{}) {
        std::ranges::fill(moves, 0.0F);
        continue;
      }
      const std::uint32_t link = n < links_.size() ? links_[n] : robot.endEffector()->link;
      applyTransposedJacobian(
          robot.links(), pose.joints, env.links(),
          {link, root_from_world * centers_[n], rotate(root_from_world.rotation, along)}, moves);
    }
  }
}

}  // namespace galactic::simulation
