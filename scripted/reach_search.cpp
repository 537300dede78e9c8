#include "scripted/reach_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace galactic::scripted {
namespace {

/// Seeds of the inverse kinematics for each reach.
constexpr std::size_t kSeeds = 3;
/// A sample is too far away to be a seed if its grip is farther away than this, meters.
constexpr float kSeedReach = 0.15F;
/// Distance of grip and target, as a fraction of the radius in which the hand grasps.
constexpr float kGraspShare = 0.5F;
/// The fraction of the success distance that a planned release may use up.
constexpr float kLandingShare = 0.7F;

/// See handFreedoms().
constexpr int kAllFreedoms = 5;
/// Half of the angle between the headings that the search of the floor offers, radians.
constexpr float kMostTurn = 0.22F;

constexpr Vec3 kUp{0, 1, 0};

Vec3 unit(const Vec3& v) { return v * (1 / std::sqrt(dot(v, v))); }

/// Starting `inside` an object and going against `way`, the point that is `distance` away from what
/// the hand touches of the object.
Vec3 pointBefore(const PlanningScene& scene, std::uint32_t object, const Vec3& inside,
                 const Vec3& way, float distance) {
  const Vec3 half = scene.objectBox(object).half_extents;
  float near = 0;
  float far = 2 * std::sqrt(dot(half, half)) + distance;
  for (int n = 0; n < 20; ++n) {
    const float middle = 0.5F * (near + far);
    const bool is_outside =
        scene.squaredGraspDistance(object, inside - way * middle) >= distance * distance;
    (is_outside ? far : near) = middle;
  }
  return inside - way * far;
}

/// A goal in the world frame, in the frame of the robot's root.
HandGoal seenFrom(const Pose& root_from_world, const HandGoal& goal) {
  HandGoal result = goal;
  result.place = root_from_world * goal.place;
  result.toward = rotate(root_from_world.rotation, goal.toward);
  return result;
}

/// The largest handFreedoms() over some of the table's samples.
int mostFreedoms(Arm& arm, const ReachTable& table, const Joints& others, Movers movers) {
  constexpr std::size_t kLooks = 32;
  int freedoms = 0;
  for (std::size_t n = 0; n < std::min(kLooks, table.size()); ++n) {
    freedoms = std::max(freedoms, handFreedoms(arm, table.joints(arm, n, others), movers));
  }
  return freedoms;
}

/// Whether a plan that ended here, or nearly here, has failed.
bool hasFailed(const CurrentPlan& plan, const Stance& stance) {
  // Meters, and the cosine of about half a radian: the directions from which hands come are farther
  // apart.
  constexpr float kNearBase = 0.15F;
  constexpr float kNearGrip = 0.1F;
  constexpr float kAlike = 0.88F;
  const auto is_near = [](const Vec3& a, const Vec3& b, float distance) {
    return dot(a - b, a - b) < distance * distance;
  };
  return std::ranges::any_of(plan.failed, [&](const Stance& failed) {
    return is_near(stance.base.position, failed.base.position, kNearBase) &&
           is_near(stance.grip, failed.grip, kNearGrip) &&
           dot(stance.approach, failed.approach) > kAlike;
  });
}

}  // namespace

ReachSearch::ReachSearch(PlanningScene& scene, Arm& arm, const ReachTable& table,
                         float success_distance)
    : scene_(scene),
      arm_(arm),
      table_(table),
      arm_planner_(scene, arm),
      landing_distance_(kLandingShare * success_distance) {
  const std::span<const float> start = arm.robot().startPositions();
  const auto is_stiff_with = [&](Movers movers) {
    return mostFreedoms(arm, table, {start.begin(), start.end()}, movers) < kAllFreedoms;
  };
  if (is_stiff_with(Movers::kArm)) most_turn_ = kMostTurn;
  is_stiff_ = is_stiff_with(Movers::kArmAndTurnOfBase);
}

Stance ReachSearch::stanceAt(const BasePlace& base, const Joints& joints) {
  const Pose world_from_grip = scene_.worldFromRoot(base) * gripAt(joints);
  return {base, world_from_grip.translation, rotate(world_from_grip.rotation, {1, 0, 0})};
}

ArmPath ReachSearch::retreatFrom(const CurrentPlan& plan, const BasePlace& base,
                                 const Joints& there, const Reach& reach) {
  const Pose root_from_world = inverse(scene_.worldFromRoot(base));
  const HandGoal goal = seenFrom(root_from_world, reach.goal);
  ArmPlanner::Slide slide{.length = reach.retreat_length,
                          .way = rotate(root_from_world.rotation, reach.retreat),
                          .direction_tolerance = plan.hand_options.direction_tolerance};
  if (!reach.any_direction) return arm_planner_.slide(base, there, goal, slide);
  slide.direction_tolerance = -1;
  const Pose root_from_grip = gripAt(there);
  slide.way = rotate(root_from_grip.rotation, goal.direction) * -1.0F;
  ArmPath path = arm_planner_.slide(base, there, goal, slide);
  if (!path.empty()) return path;
  slide.way = kUp;
  return arm_planner_.slide(base, there, goal, slide);
}

template <class IsRight>
std::optional<ArmPath> ReachSearch::reach(CurrentPlan& plan, BasePlace& base, const Joints& carried,
                                          const Reach& reach, const IsRight& is_right) {
  std::array<std::uint32_t, kSeeds> seeds{};
  const Pose root_from_world = inverse(scene_.worldFromRoot(base));
  const HandGoal goal = seenFrom(root_from_world, reach.goal);
  const std::size_t count = plan.view.nearest(goal, kSeedReach, seeds);
  InverseKinematicsOptions options = plan.hand_options;
  if (reach.any_direction) options.direction_tolerance = -1;
  for (const std::uint32_t sample : std::span(seeds).first(count)) {
    const Joints seed = table_.joints(arm_, sample, carried);
    const std::optional<TurnedHand> hand = solveHandAndTurn(arm_, goal, seed, most_turn_, options);
    if (!hand) continue;
    const Joints& there = hand->joints;
    const BasePlace turned{base.position, base.yaw + hand->turn};
    if (hasFailed(plan, stanceAt(turned, there))) continue;
    scene_.setJoints(there);
    if (!scene_.isFree(turned) || !is_right(turned)) continue;
    ArmPath path = retreatFrom(plan, turned, there, reach);
    if (path.empty()) continue;
    std::ranges::reverse(path);
    path.push_back(there);
    std::optional<ArmPath> begin = arm_planner_.plan(turned, carried, path.front(), plan.seed++);
    if (!begin) {
      ++plan.failed_motions;
      continue;
    }
    begin->insert(begin->end(), path.begin() + 1, path.end());
    base = turned;
    return begin;
  }
  return std::nullopt;
}

std::optional<ArmPath> ReachSearch::reachTarget(CurrentPlan& plan, BasePlace& base,
                                                const Joints& carried) {
  const std::uint32_t target = plan.state.target;
  const Vec3 center = scene_.objectBox(target).pose.translation;
  const float radius = arm_.robot().endEffector()->grasp_radius;
  const Vec3 to_target = center - base.position;
  const Vec3 ahead = unit({to_target.x, 0, to_target.z});
  // Slightly below the top: a thick hand that comes from the side cannot get lower.
  constexpr float kHigh = 0.9F;
  constexpr float kAlmostNone = 1e-3F;
  const Vec3 top = pointBefore(scene_, target, center, kUp * -1.0F, kAlmostNone);
  const Vec3 high = center + (top - center) * kHigh;
  struct Way {
    Vec3 way;
    Vec3 inside;
    bool any_direction = false;
  };
  const std::array<Way, 5> ways{{{kUp * -1.0F, center},
                                 {unit(ahead - kUp), center},
                                 {ahead, center},
                                 {ahead, high, true},
                                 {ahead, center, true}}};
  for (const auto& [way, inside, any_direction] : std::span(ways).first(plan.is_thorough ? 5 : 3)) {
    const Vec3 grip = pointBefore(scene_, target, inside, way, kGraspShare * radius);
    const Reach goal{.goal = {.point = {}, .direction = {1, 0, 0}, .place = grip, .toward = way},
                     .retreat = way * -1.0F,
                     .any_direction = any_direction};
    const auto is_right = [&](const BasePlace& place) { return scene_.graspedAt(place) == target; };
    BasePlace turned = base;
    std::optional<ArmPath> path = reach(plan, turned, carried, goal, is_right);
    if (!path || !comesAway(plan, turned, path->back(), carried)) continue;
    base = turned;
    return path;
  }
  return std::nullopt;
}

bool ReachSearch::comesAway(CurrentPlan& plan, const BasePlace& base, const Joints& positions,
                            const Joints& carried) {
  scene_.setJoints(positions);
  scene_.hold(plan.state.target, base);
  const bool result = liftAndFold(plan, base, positions, carried).has_value();
  scene_.putBack();
  if (!result) ++plan.failed_motions;
  return result;
}

std::optional<ArmPath> ReachSearch::reachGoal(CurrentPlan& plan, BasePlace& base,
                                              const Joints& carried) {
  const Pose& goal_pose = plan.state.goal;
  const Vec3 up_of_object = rotate(conjugate(goal_pose.rotation), kUp);
  for (const float lift : {0.04F, 0.015F}) {
    const Reach goal{{.point = scene_.gripFromObject().translation,
                      .direction = rotate(scene_.gripFromObject().rotation, up_of_object),
                      .place = goal_pose.translation + kUp * lift,
                      .toward = kUp},
                     kUp};
    const auto is_right = [&](const BasePlace& place) {
      const std::optional<Pose> landing = scene_.landing(place);
      if (!landing) return false;
      const Vec3 away = landing->translation - goal_pose.translation;
      return std::sqrt(dot(away, away)) < landing_distance_;
    };
    std::optional<ArmPath> path = reach(plan, base, carried, goal, is_right);
    if (path) return path;
  }
  return std::nullopt;
}

std::optional<ArmPath> ReachSearch::fold(CurrentPlan& plan, const BasePlace& base,
                                         const Joints& from, const Joints& carried) {
  constexpr float kThere = 1e-3F;
  if (arm_.distance(from, carried) < kThere) return ArmPath{};
  return arm_planner_.plan(base, from, carried, plan.seed++);
}

std::optional<ArmPath> ReachSearch::liftAndFold(CurrentPlan& plan, const BasePlace& base,
                                                const Joints& from, const Joints& carried) {
  constexpr float kLift = 0.1F;
  const Pose root_from_grip = gripAt(from);
  const Vec3 ahead = rotate(root_from_grip.rotation, {1, 0, 0});
  const HandGoal here{
      .point = {}, .direction = {1, 0, 0}, .place = root_from_grip.translation, .toward = ahead};
  for (const Vec3& way : {kUp, unit(kUp - ahead * 0.9F), ahead * -1.0F}) {
    if (scene_.isHolding()) {
      scene_.setJoints(from);
      scene_.ignorePenetrating(base);
    }
    ArmPath path = arm_planner_.slide(base, from, here, {.length = kLift, .way = way});
    const std::optional<ArmPath> rest =
        fold(plan, base, path.empty() ? from : path.back(), carried);
    if (!rest) continue;
    path.insert(path.end(), rest->begin(), rest->end());
    return path;
  }
  return std::nullopt;
}

}  // namespace galactic::scripted
