#include "scripted/planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "simulation/resting_box.h"

namespace galactic::scripted {
namespace {

constexpr std::uint32_t kReachSamples = 20000;
/// Seeds of the inverse kinematics for each reach.
constexpr std::size_t kSeeds = 3;
/// A sample is no seed when its grip is further away than this, metres.
constexpr float kSeedReach = 0.15F;
/// Motions of the arm that are searched for in vain before a plan is given up.
constexpr int kMostFailedMotions = 12;
/// The hand has to come away at least so far on its way to where it turns freely, metres.
constexpr float kLeastRetreat = 0.03F;
/// Distance of grip and target's box, as a share of the radius in which the hand grasps.
constexpr float kGraspShare = 0.5F;
/// The share of the distance of success that a planned release may use up.
constexpr float kLandingShare = 0.7F;

constexpr Vec3 kUp{0, 1, 0};

Vec3 unit(const Vec3& v) { return v * (1 / std::sqrt(dot(v, v))); }

/// The point on the line from the box's centre against `way` that is `distance` off the box.
Vec3 pointBefore(const simulation::RestingBox& box, const Vec3& way, float distance) {
  const Vec3& half = box.half_extents;
  float near = 0;
  float far = std::sqrt(dot(half, half)) + distance;
  for (int n = 0; n < 20; ++n) {
    const float middle = 0.5F * (near + far);
    const bool is_outside =
        simulation::squaredDistance(box, box.centre - way * middle) >= distance * distance;
    (is_outside ? far : near) = middle;
  }
  return box.centre - way * far;
}

void append(const BasePlace& base, const ArmPath& path, Plan& plan) {
  for (const Joints& joints : path) {
    plan.steps.push_back({PlanStep::Kind::kMoveArm, base, joints});
  }
}

void append(const BaseRoute& route, Plan& plan) {
  for (const BasePlace& place : route) {
    plan.steps.push_back({PlanStep::Kind::kMoveBase, place, {}});
  }
}

ScriptedTrouble troubleOf(FloorSearch::Outcome outcome, ScriptedTrouble no_way,
                          ScriptedTrouble not_accepted) {
  return outcome == FloorSearch::Outcome::kNoWay ? no_way : not_accepted;
}

}  // namespace

Planner::Planner(const World& world, const SimulationOptions& options)
    : world_(world),
      options_(options),
      probe_(world, options),
      arm_planner_(probe_),
      floor_search_(probe_, world.robot()),
      reach_table_(probe_.arm(),
                   {world.robot().startPositions().begin(), world.robot().startPositions().end()},
                   kReachSamples),
      pick_view_(reach_table_, {}, {1, 0, 0}) {}

BasePlace Planner::baseOf(const EnvState& state) const {
  const Quat& q = state.world_from_root.rotation;
  const float root_height = world_.robot().base()->root_height;
  return {state.world_from_root.translation - Vec3{0, root_height, 0}, 2 * std::atan2(q.y, q.w)};
}

std::uint64_t Planner::nextSeed() { return seed_++; }

Joints Planner::carriedOf(const EnvState& state) const {
  Joints carried = state.joint_positions;
  for (const ControlledJoint& joint : world_.robot().controlledJoints()) {
    carried[joint.position] =
        std::clamp(world_.robot().startPositions()[joint.position], joint.lower, joint.upper);
  }
  return carried;
}

template <class IsRight>
std::optional<ArmPath> Planner::reach(const BasePlace& base, const Joints& carried,
                                      const Reach& reach, const IsRight& is_right) {
  std::array<std::uint32_t, kSeeds> seeds{};
  const std::size_t count = view_->nearest(reach.goal, kSeedReach, seeds);
  Arm& arm = probe_.arm();
  for (const std::uint32_t sample : std::span(seeds).first(count)) {
    Joints seed = carried;
    for (std::size_t joint = 0; joint < arm.joints().size(); ++joint) {
      seed[arm.joints()[joint].position] = reach_table_.controlled(sample)[joint];
    }
    const std::optional<Joints> there = solveHand(arm, reach.goal, seed);
    if (!there || !probe_.isFree(base, *there) || !is_right(*there)) continue;
    ArmPath path = arm_planner_.slide(base, *there, reach.goal,
                                      {.length = reach.retreat_length, .way = reach.retreat});
    if (path.empty()) continue;
    std::ranges::reverse(path);
    path.push_back(*there);
    std::optional<ArmPath> begin = arm_planner_.plan(base, carried, path.front(), nextSeed());
    if (!begin) {
      ++failed_motions_;
      continue;
    }
    begin->insert(begin->end(), path.begin() + 1, path.end());
    return begin;
  }
  return std::nullopt;
}

std::optional<ArmPath> Planner::reachTarget(const BasePlace& base, const Joints& carried) {
  if (failed_motions_ >= kMostFailedMotions) return std::nullopt;
  const simulation::RestingBox& box = probe_.objects().box(state_->target);
  const float radius = world_.robot().endEffector()->grasp_radius;
  const Pose root_from_world = inverse(probe_.worldFromRoot(base));
  const Vec3 to_target = box.centre - base.position;
  const Vec3 ahead = unit({to_target.x, 0, to_target.z});
  const std::array<Vec3, 3> ways{Vec3{0, -1, 0}, unit(ahead - kUp), ahead};
  for (const Vec3& way : ways) {
    const Vec3 grip = pointBefore(box, way, kGraspShare * radius);
    const Reach goal{{.point = {},
                      .direction = {1, 0, 0},
                      .place = root_from_world * grip,
                      .toward = rotate(root_from_world.rotation, way)},
                     rotate(root_from_world.rotation, way) * -1.0F};
    const auto is_right = [&](const Joints& positions) {
      const Pose world_from_grip =
          probe_.worldFromRoot(base) * probe_.arm().gripOf(probe_.arm().placeLinks(positions));
      return probe_.objects().nearest(world_from_grip.translation, radius) == state_->target;
    };
    std::optional<ArmPath> path = reach(base, carried, goal, is_right);
    if (path) return path;
  }
  return std::nullopt;
}

std::optional<ArmPath> Planner::reachGoal(const BasePlace& base, const Joints& carried) {
  if (failed_motions_ >= kMostFailedMotions) return std::nullopt;
  const Pose root_from_world = inverse(probe_.worldFromRoot(base));
  const Pose& goal_pose = state_->goal;
  const Vec3 up_of_object = rotate(conjugate(goal_pose.rotation), kUp);
  for (const float lift : {0.04F, 0.015F}) {
    const Reach goal{{.point = probe_.gripFromObject().translation,
                      .direction = rotate(probe_.gripFromObject().rotation, up_of_object),
                      .place = root_from_world * (goal_pose.translation + kUp * lift),
                      .toward = kUp},
                     kUp};
    const auto is_right = [&](const Joints& positions) {
      const std::optional<Pose> landing = probe_.landing(base, positions);
      if (!landing) return false;
      const Vec3 away = landing->translation - goal_pose.translation;
      return std::sqrt(dot(away, away)) < kLandingShare * options_.task.success_distance;
    };
    std::optional<ArmPath> path = reach(base, carried, goal, is_right);
    if (path) return path;
  }
  return std::nullopt;
}

std::optional<ArmPath> Planner::fold(const BasePlace& base, const Joints& from,
                                     const Joints& carried) {
  constexpr float kThere = 1e-3F;
  if (probe_.arm().distance(from, carried) < kThere) return ArmPath{};
  return arm_planner_.plan(base, from, carried, nextSeed());
}

std::optional<ArmPath> Planner::liftAndFold(const BasePlace& base, const Joints& from,
                                            const Joints& carried) {
  constexpr float kLift = 0.1F;
  const Pose root_from_grip = probe_.arm().gripOf(probe_.arm().placeLinks(from));
  const Vec3 ahead = rotate(root_from_grip.rotation, {1, 0, 0});
  const HandGoal here{
      .point = {}, .direction = {1, 0, 0}, .place = root_from_grip.translation, .toward = ahead};
  for (const Vec3& way : {kUp, unit(kUp - ahead * 0.9F), ahead * -1.0F}) {
    probe_.ignoreTouching(base, from);
    ArmPath path = arm_planner_.slide(base, from, here, {.length = kLift, .way = way});
    const std::optional<ArmPath> rest = fold(base, path.empty() ? from : path.back(), carried);
    if (!rest) continue;
    path.insert(path.end(), rest->begin(), rest->end());
    return path;
  }
  return std::nullopt;
}

Plan Planner::planPick(const EnvState& state, std::uint32_t attempt) {
  state_ = &state;
  view_ = &pick_view_;
  seed_ = (std::uint64_t{state.episode} << 32U) + attempt * 1000;
  failed_motions_ = 0;
  probe_.look(state);
  const BasePlace start = baseOf(state);
  Joints carried = carriedOf(state);
  std::optional<ArmPath> folding = fold(start, state.joint_positions, carried);
  if (!folding) {
    folding = ArmPath{};
    carried = state.joint_positions;
  }
  Plan plan;
  append(start, *folding, plan);
  std::optional<ArmPath> reaching;
  const FloorSearch::Target target{.point = probe_.objects().box(state.target).centre};
  const FloorSearch::Answer answer =
      floor_search_.search(start, carried, target, [&](const BasePlace& stance) {
        reaching = reachTarget(stance, carried);
        return reaching.has_value();
      });
  if (!reaching) {
    return {{},
            troubleOf(answer.outcome, ScriptedTrouble::kNoWayToTarget, ScriptedTrouble::kNoGrasp)};
  }
  append(answer.route, plan);
  const BasePlace stance = answer.route.back();
  append(stance, *reaching, plan);
  plan.steps.push_back({PlanStep::Kind::kGrasp, stance, {}});
  return plan;
}

Plan Planner::planPlace(const EnvState& state, std::uint32_t attempt) {
  state_ = &state;
  seed_ = (std::uint64_t{state.episode} << 32U) + attempt * 1000 + 500;
  failed_motions_ = 0;
  probe_.look(state);
  const Vec3 up_of_object = rotate(conjugate(state.goal.rotation), kUp);
  const ReachView view(reach_table_, probe_.gripFromObject().translation,
                       rotate(probe_.gripFromObject().rotation, up_of_object));
  view_ = &view;
  const BasePlace start = baseOf(state);
  const Joints carried = carriedOf(state);
  const std::optional<ArmPath> folding = liftAndFold(start, state.joint_positions, carried);
  if (!folding) return {{}, ScriptedTrouble::kNoFold};
  Plan plan;
  append(start, *folding, plan);
  std::optional<ArmPath> reaching;
  const FloorSearch::Target target{.point = state.goal.translation};
  const FloorSearch::Answer answer =
      floor_search_.search(start, carried, target, [&](const BasePlace& stance) {
        reaching = reachGoal(stance, carried);
        return reaching.has_value();
      });
  if (!reaching) {
    return {
        {},
        troubleOf(answer.outcome, ScriptedTrouble::kNoWayToGoal, ScriptedTrouble::kNoPlacement)};
  }
  append(answer.route, plan);
  const BasePlace stance = answer.route.back();
  append(stance, *reaching, plan);
  plan.steps.push_back({PlanStep::Kind::kRelease, stance, {}});
  return plan;
}

}  // namespace galactic::scripted
