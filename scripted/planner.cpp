#include "scripted/planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scripted/carries.h"

namespace galactic::scripted {
namespace {

constexpr std::uint32_t kReachSamples = 20000;
/// Seeds of the inverse kinematics for each reach.
constexpr std::size_t kSeeds = 3;
/// A sample is no seed when its grip is further away than this, meters.
constexpr float kSeedReach = 0.15F;
/// Motions of the arm that are searched for in vain before a plan is given up.
constexpr int kMostFailedMotions = 12;
/// Distance of grip and target, as a share of the radius in which the hand grasps.
constexpr float kGraspShare = 0.5F;
/// The share of the distance of success that a planned release may use up.
constexpr float kLandingShare = 0.7F;

/// See handFreedoms.
constexpr int kAllFreedoms = 5;
/// Half of what lies between the headings that the search of the floor offers, radians.
constexpr float kMostTurn = 0.22F;

/// What tells the random numbers of plans of one attempt apart.
constexpr std::uint32_t kPickDraw = 0;
constexpr std::uint32_t kPickFromHereDraw = 250;
constexpr std::uint32_t kPlaceDraw = 500;
constexpr std::uint32_t kPlaceFromHereDraw = 750;

constexpr Vec3 kUp{0, 1, 0};

Vec3 unit(const Vec3& v) { return v * (1 / std::sqrt(dot(v, v))); }

/// The point on the line from `inside` an object against `way` that is `distance` off what the hand
/// touches of it.
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

/// A goal of the world in the frame of the robot's root.
HandGoal seenFrom(const Pose& root_from_world, const HandGoal& goal) {
  HandGoal result = goal;
  result.place = root_from_world * goal.place;
  result.toward = rotate(root_from_world.rotation, goal.toward);
  return result;
}

/// See handFreedoms; about the table's samples.
int mostFreedoms(Arm& arm, const ReachTable& table, const Joints& others, Movers movers) {
  constexpr std::size_t kLooks = 32;
  int freedoms = 0;
  for (std::size_t n = 0; n < std::min(kLooks, table.size()); ++n) {
    freedoms = std::max(freedoms, handFreedoms(arm, table.joints(arm, n, others), movers));
  }
  return freedoms;
}

ScriptedTrouble troubleOf(FloorSearch::Outcome outcome, ScriptedTrouble no_way,
                          ScriptedTrouble not_accepted) {
  return outcome == FloorSearch::Outcome::kNoWay ? no_way : not_accepted;
}

}  // namespace

Planner::Planner(const World& world, const SimulationOptions& options)
    : world_(world),
      options_(options),
      scene_(world, options),
      arm_(world.robot()),
      arm_planner_(scene_, arm_),
      floor_search_(scene_, world.robot()),
      reach_table_(arm_,
                   {world.robot().startPositions().begin(), world.robot().startPositions().end()},
                   kReachSamples),
      pick_view_(reach_table_, {}, {1, 0, 0}),
      carries_(chooseCarries(scene_, arm_, reach_table_)) {
  const Joints start{world.robot().startPositions().begin(), world.robot().startPositions().end()};
  const auto is_stiff_with = [&](Movers movers) {
    return mostFreedoms(arm_, reach_table_, start, movers) < kAllFreedoms;
  };
  if (is_stiff_with(Movers::kArm)) most_turn_ = kMostTurn;
  is_stiff_ = is_stiff_with(Movers::kArmAndTurnOfBase);
}

std::uint64_t Planner::nextSeed() { return seed_++; }

Stance Planner::stanceAt(const BasePlace& base, const Joints& joints) {
  const Pose world_from_grip = scene_.worldFromRoot(base) * gripAt(joints);
  return {base, world_from_grip.translation, rotate(world_from_grip.rotation, {1, 0, 0})};
}

bool Planner::hasFailed(const Stance& stance) const {
  // Meters, and the cosine of half a radian: the ways from which hands come are farther apart.
  constexpr float kNearBase = 0.15F;
  constexpr float kNearGrip = 0.1F;
  constexpr float kAlike = 0.88F;
  const auto is_near = [](const Vec3& a, const Vec3& b, float distance) {
    return dot(a - b, a - b) < distance * distance;
  };
  return std::ranges::any_of(failed_, [&](const Stance& failed) {
    return is_near(stance.base.position, failed.base.position, kNearBase) &&
           is_near(stance.grip, failed.grip, kNearGrip) &&
           dot(stance.approach, failed.approach) > kAlike;
  });
}

template <class MakePlan>
Plan Planner::anew(const MakePlan& plan) {
  Plan result = plan();
  if (result.trouble == ScriptedTrouble::kNone || failed_.empty()) return result;
  failed_ = {};
  return plan();
}

Plan Planner::planTo(const BasePlace& start, const BaseRoute& route, const ArmPath& path,
                     PlanStep::Kind last) {
  Plan plan = planOf(start, route, path, last);
  plan.stance = stanceAt(plan.steps.back().base, path.back());
  return plan;
}

std::vector<Joints> Planner::carriesOf(const EnvState& state) const {
  std::vector<Joints> result;
  result.reserve(carries_.size());
  for (const Joints& carry : carries_) {
    Joints joints = state.joint_positions;
    for (const ControlledJoint& joint : world_.robot().controlledJoints()) {
      joints[joint.position] = carry[joint.position];
    }
    result.push_back(std::move(joints));
  }
  return result;
}

ArmPath Planner::retreatFrom(const BasePlace& base, const Joints& there, const Reach& reach) {
  const Pose root_from_world = inverse(scene_.worldFromRoot(base));
  const HandGoal goal = seenFrom(root_from_world, reach.goal);
  ArmPlanner::Slide slide{.length = reach.retreat_length,
                          .way = rotate(root_from_world.rotation, reach.retreat),
                          .direction_tolerance = hand_options_.direction_tolerance};
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
std::optional<ArmPath> Planner::reach(BasePlace& base, const Joints& carried, const Reach& reach,
                                      const IsRight& is_right) {
  std::array<std::uint32_t, kSeeds> seeds{};
  const Pose root_from_world = inverse(scene_.worldFromRoot(base));
  const HandGoal goal = seenFrom(root_from_world, reach.goal);
  const std::size_t count = view_->nearest(goal, kSeedReach, seeds);
  InverseKinematicsOptions options = hand_options_;
  if (reach.any_direction) options.direction_tolerance = -1;
  for (const std::uint32_t sample : std::span(seeds).first(count)) {
    const Joints seed = reach_table_.joints(arm_, sample, carried);
    const std::optional<TurnedHand> hand = solveHandAndTurn(arm_, goal, seed, most_turn_, options);
    if (!hand) continue;
    const Joints& there = hand->joints;
    const BasePlace turned{base.position, base.yaw + hand->turn};
    if (hasFailed(stanceAt(turned, there))) continue;
    scene_.setJoints(there);
    if (!scene_.isFree(turned) || !is_right(turned)) continue;
    ArmPath path = retreatFrom(turned, there, reach);
    if (path.empty()) continue;
    std::ranges::reverse(path);
    path.push_back(there);
    std::optional<ArmPath> begin = arm_planner_.plan(turned, carried, path.front(), nextSeed());
    if (!begin) {
      ++failed_motions_;
      continue;
    }
    begin->insert(begin->end(), path.begin() + 1, path.end());
    base = turned;
    return begin;
  }
  return std::nullopt;
}

std::optional<ArmPath> Planner::reachTarget(BasePlace& base, const Joints& carried) {
  const std::uint32_t target = state_->target;
  const Vec3 center = scene_.objectBox(target).pose.translation;
  const float radius = world_.robot().endEffector()->grasp_radius;
  const Vec3 to_target = center - base.position;
  const Vec3 ahead = unit({to_target.x, 0, to_target.z});
  // Somewhat under the top: a thick hand that comes from the side does not get lower.
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
  for (const auto& [way, inside, any_direction] : std::span(ways).first(is_thorough_ ? 5 : 3)) {
    const Vec3 grip = pointBefore(scene_, target, inside, way, kGraspShare * radius);
    const Reach goal{.goal = {.point = {}, .direction = {1, 0, 0}, .place = grip, .toward = way},
                     .retreat = way * -1.0F,
                     .any_direction = any_direction};
    const auto is_right = [&](const BasePlace& place) { return scene_.graspedAt(place) == target; };
    BasePlace turned = base;
    std::optional<ArmPath> path = reach(turned, carried, goal, is_right);
    if (!path || !comesAway(turned, path->back(), carried)) continue;
    base = turned;
    return path;
  }
  return std::nullopt;
}

bool Planner::comesAway(const BasePlace& base, const Joints& positions, const Joints& carried) {
  scene_.setJoints(positions);
  scene_.hold(state_->target, base);
  const bool result = liftAndFold(base, positions, carried).has_value();
  scene_.putBack();
  if (!result) ++failed_motions_;
  return result;
}

std::optional<ArmPath> Planner::reachGoal(BasePlace& base, const Joints& carried) {
  const Pose& goal_pose = state_->goal;
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
  if (arm_.distance(from, carried) < kThere) return ArmPath{};
  return arm_planner_.plan(base, from, carried, nextSeed());
}

std::optional<ArmPath> Planner::liftAndFold(const BasePlace& base, const Joints& from,
                                            const Joints& carried) {
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
    const std::optional<ArmPath> rest = fold(base, path.empty() ? from : path.back(), carried);
    if (!rest) continue;
    path.insert(path.end(), rest->begin(), rest->end());
    return path;
  }
  return std::nullopt;
}

void Planner::takeOver(const EnvState& state, const Attempt& attempt, std::uint32_t draw) {
  state_ = &state;
  failed_ = attempt.failed;
  seed_ = (std::uint64_t{state.episode} << 32U) + std::uint64_t{attempt.number} * 1000 + draw;
  scene_.update(state);
}

template <class Fold, class MakePlan>
Plan Planner::folded(std::span<const Joints> carries, const Fold& fold, const MakePlan& plan) {
  const BasePlace start = scene_.baseOf(*state_);
  Plan result = troubled(ScriptedTrouble::kNoFold);
  for (const Joints& carried : carries) {
    failed_motions_ = 0;
    const std::optional<ArmPath> folding = fold(start, carried);
    if (!folding) continue;
    result = plan(start, carried);
    if (result.trouble == ScriptedTrouble::kNone) {
      prepend(start, *folding, result);
      break;
    }
    // What the arm does not reach it does not reach from another fold.
    const bool is_reached = result.trouble != ScriptedTrouble::kNoGrasp &&
                            result.trouble != ScriptedTrouble::kNoPlacement;
    if (!is_reached && failed_motions_ == 0) break;
  }
  return result;
}

void Planner::intendToPick() {
  view_ = &pick_view_;
  hand_options_ = {};
  is_thorough_ = is_stiff_;
  failed_motions_ = 0;
}

Plan Planner::planPick(const EnvState& state, const Attempt& attempt) {
  takeOver(state, attempt, kPickDraw);
  return anew([&] { return pick(); });
}

Plan Planner::pick() {
  intendToPick();
  std::vector<Joints> carries = carriesOf(*state_);
  // Where there is no room to fold the arm it may still be driven as it is.
  carries.push_back(state_->joint_positions);
  const auto pick_folded = [&] {
    return folded(
        carries,
        [&](const BasePlace& start, const Joints& carried) {
          return fold(start, state_->joint_positions, carried);
        },
        [&](const BasePlace& start, const Joints& carried) { return pickWith(start, carried); });
  };
  Plan plan = pick_folded();
  if (plan.trouble != ScriptedTrouble::kNoGrasp || is_thorough_) return plan;
  is_thorough_ = true;
  return pick_folded();
}

Plan Planner::planPickFromHere(const EnvState& state, const Attempt& attempt, std::uint32_t reach) {
  takeOver(state, attempt, kPickFromHereDraw + reach);
  intendToPick();
  Plan plan = pickFromHere();
  if (plan.trouble == ScriptedTrouble::kNone || is_thorough_) return plan;
  is_thorough_ = true;
  failed_motions_ = 0;
  return pickFromHere();
}

Plan Planner::pickFromHere() {
  BasePlace base = scene_.baseOf(*state_);
  const std::optional<ArmPath> reaching = reachTarget(base, state_->joint_positions);
  return planFromHere(reaching, base, PlanStep::Kind::kGrasp, ScriptedTrouble::kNoGrasp);
}

Plan Planner::planFromHere(const std::optional<ArmPath>& reaching, const BasePlace& turned,
                           PlanStep::Kind last, ScriptedTrouble not_reached) {
  if (!reaching) return troubled(not_reached);
  const BasePlace start = scene_.baseOf(*state_);
  if (turned.yaw == start.yaw) return planTo(start, {}, *reaching, last);
  scene_.setJoints(state_->joint_positions);
  if (!floor_search_.canTurn(start, turned.yaw)) return troubled(not_reached);
  return planTo(start, {turned}, *reaching, last);
}

FloorSearch::Verdict Planner::verdictOn(const std::optional<ArmPath>& reaching) const {
  using Verdict = FloorSearch::Verdict;
  if (reaching) return Verdict::kAccepted;
  return failed_motions_ < kMostFailedMotions ? Verdict::kRejected : Verdict::kEnough;
}

FloorSearch::Target Planner::standsFor(const Vec3& point) const {
  // An object is reached at its edge.
  constexpr float kObject = 0.1F;
  FloorSearch::Target target{.point = point, .bearing = reach_table_.bearing()};
  // A long arm need not be stretched; a short one has to be near.
  target.farthest = std::min(target.farthest, reach_table_.farthest() + kObject);
  target.nearest = std::min(target.nearest, 0.5F * target.farthest);
  return target;
}

Plan Planner::pickWith(const BasePlace& start, const Joints& carried) {
  std::optional<ArmPath> reaching;
  const FloorSearch::Target target = standsFor(scene_.objectBox(state_->target).pose.translation);
  const FloorSearch::Answer answer =
      floor_search_.search(start, carried, target, [&](BasePlace& stance) {
        reaching = reachTarget(stance, carried);
        return verdictOn(reaching);
      });
  if (!reaching) {
    return troubled(
        troubleOf(answer.outcome, ScriptedTrouble::kNoWayToTarget, ScriptedTrouble::kNoGrasp));
  }
  return planTo(start, answer.route, *reaching, PlanStep::Kind::kGrasp);
}

ReachView Planner::placeView() const {
  const Vec3 up_of_object = rotate(conjugate(state_->goal.rotation), kUp);
  return {reach_table_, scene_.gripFromObject().translation,
          rotate(scene_.gripFromObject().rotation, up_of_object)};
}

Plan Planner::planPlaceFromHere(const EnvState& state, const Attempt& attempt,
                                std::uint32_t reach) {
  takeOver(state, attempt, kPlaceFromHereDraw + reach);
  const ReachView view = placeView();
  view_ = &view;
  return leaning([&] {
    BasePlace base = scene_.baseOf(state);
    const std::optional<ArmPath> reaching = reachGoal(base, state.joint_positions);
    return planFromHere(reaching, base, PlanStep::Kind::kRelease, ScriptedTrouble::kNoPlacement);
  });
}

Plan Planner::planPlace(const EnvState& state, const Attempt& attempt) {
  takeOver(state, attempt, kPlaceDraw);
  const ReachView view = placeView();
  view_ = &view;
  return anew([&] { return place(); });
}

Plan Planner::place() {
  return folded(
      carriesOf(*state_),
      [&](const BasePlace& start, const Joints& carried) {
        return liftAndFold(start, state_->joint_positions, carried);
      },
      [&](const BasePlace& start, const Joints& carried) {
        return leaning([&] { return placeWith(start, carried); });
      });
}

template <class MakePlan>
Plan Planner::leaning(const MakePlan& plan) {
  Plan result;
  // Upright, else leaning, else as it comes, radians.
  for (const float tolerance : {0.15F, 0.6F, -1.0F}) {
    hand_options_.direction_tolerance = tolerance;
    failed_motions_ = 0;
    result = plan();
    if (result.trouble != ScriptedTrouble::kNoPlacement) break;
  }
  return result;
}

Plan Planner::placeWith(const BasePlace& start, const Joints& carried) {
  std::optional<ArmPath> reaching;
  const FloorSearch::Target target = standsFor(state_->goal.translation);
  const FloorSearch::Answer answer =
      floor_search_.search(start, carried, target, [&](BasePlace& stance) {
        reaching = reachGoal(stance, carried);
        return verdictOn(reaching);
      });
  if (!reaching) {
    return troubled(
        troubleOf(answer.outcome, ScriptedTrouble::kNoWayToGoal, ScriptedTrouble::kNoPlacement));
  }
  return planTo(start, answer.route, *reaching, PlanStep::Kind::kRelease);
}

}  // namespace galactic::scripted
