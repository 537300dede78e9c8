#include "simulation/queries/planner_env.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "galactic/error.h"
#include "galactic/kinematics.h"
#include "galactic/option_text.h"
#include "galactic/robot.h"
#include "simulation/collision/floor_query.h"
#include "simulation/queries/checked_state.h"
#include "simulation/state/plain_numbers.h"
#include "support/call_check.h"
#include "support/random_stream.h"

namespace galactic::simulation {
namespace {

SphereCloud cloudOf(const Robot& robot) {
  std::vector<SphereCloud::Sphere> spheres;
  spheres.reserve(robot.spheres().size());
  for (const SphereGroup& group : robot.groups()) {
    for (const SetSphere& sphere : group.spheres) spheres.push_back({group.link, sphere});
  }
  return {spheres, robot.radii()};
}

/// Returns the options; throws if one is out of range.
const SimulationOptions& checked(const SimulationOptions& options) {
  orThrow(checkOptions(options));
  return options;
}

std::size_t mostSpheres(const World& world) {
  const std::size_t most = std::max(world.robot().spheres().size(), world.mostObjectSpheres());
  return paddedToLanes(most) + kLanes * world.radii().size();
}

}  // namespace

PlannerEnv::PlannerEnv(const World& world, const SimulationOptions& options)
    : world_(world),
      options_(checked(options)),
      root_height_(world.robot().base()->root_height),
      joints_(world.robot().positionCount()),
      links_(world.robot().links().size()),
      robot_(cloudOf(world.robot())),
      self_collision_(world_.robot()),
      // The largest radius in any query: that of a sphere or of the hand.
      resting_(world.mostObjects(),
               std::max(world.radii().back(), world.robot().endEffector()->grasp_radius)),
      collision_(mostSpheres(world)),
      placement_(mostSpheres(world), world.radii()) {
  // Jitters are random, but plans must not be.
  options_.placement.attempts = 1;
  overlapping_.resize(wordsFor(robot_.paddedCount()));
}

void PlannerEnv::update(const EnvState& state) {
  constexpr const char* kCall = "PlanningScene::update";
  const std::span<const Placement> placements = checkedObjects(kCall, world_, state);
  const Episode& episode = world_.episodes().episodes()[state.episode];
  detail::checkLength(
      kCall, "objects", placements.size(),
      world_.episodes().present(episode, options_.task.distractors).placements.size());
  scene_ = &world_.scenes()[state.scene];
  is_ready_ = has_joints_;
  models_.clear();
  resting_->clear();
  held_ = nullptr;
  for (std::uint32_t n = 0; n < placements.size(); ++n) {
    models_.push_back(&world_.objectOf(placements[n]));
    if (static_cast<std::int32_t>(n) == state.held) continue;
    resting_->insert(n, restingBox(models_[n]->box, state.objects[n]));
  }
  poses_ = state.objects;
  is_pretended_ = false;
  left_.clear();
  if (state.held >= 0) {
    const auto held = static_cast<std::uint32_t>(state.held);
    take(held, inverse(state.world_from_grip) * state.objects[held]);
  }
  ignoreAsIn(state);
}

void PlannerEnv::ignoreAsIn(const EnvState& state) {
  assemble(state.joint_positions);
  const BasePlace base = baseOf(state);
  ignorePenetrating(base);
  leavePenetrating(base);
  if (has_joints_) assemble(joints_);
}

void PlannerEnv::leavePenetrating(const BasePlace& base) {
  const SphereBatch spheres = robotAt(base);
  if (!resting_->touches(spheres)) return;
  for (std::uint32_t n = 0; n < resting_->capacity(); ++n) {
    if (!resting_->isResting(n)) continue;
    if (!overlapping(resting_->box(n), spheres, overlapping_)) continue;
    left_.push_back({n, overlapping_});
  }
}

void PlannerEnv::setJoints(std::span<const float> positions) {
  constexpr const char* kCall = "PlanningScene::setJoints";
  detail::checkLength(kCall, "positions", positions.size(), world_.robot().positionCount());
  checkPositions(kCall, "positions", positions);
  has_joints_ = true;
  is_ready_ = scene_ != nullptr;
  std::ranges::copy(positions, joints_.begin());
  assemble(joints_);
}

void PlannerEnv::assemble(std::span<const float> positions) {
  forwardKinematics(world_.robot().links(), {}, positions, links_);
  robot_.assemble(links_);
  reach_ = robot_.reach();
  if (held_ != nullptr) assembleHeld();
}

void PlannerEnv::take(std::uint32_t object, const Pose& grip_from_object) {
  held_number_ = object;
  held_ = models_[object];
  grip_from_object_ = grip_from_object;
  std::vector<SphereCloud::Sphere> spheres;
  spheres.reserve(held_->spheres.size());
  for (const SetSphere& sphere : held_->spheres) spheres.push_back({0, sphere});
  held_spheres_ = SphereCloud(spheres, world_.radii());
  penetrating_.assign(wordsFor(held_spheres_.paddedCount()), 0);
  ignored_.assign(wordsFor(held_spheres_.paddedCount()), 0);
  assembleHeld();
}

void PlannerEnv::assembleHeld() {
  const Pose root_from_object = rootFromGrip() * grip_from_object_;
  held_spheres_.assemble(std::span(&root_from_object, 1));
}

void PlannerEnv::hold(std::uint32_t object, const BasePlace& base) {
  constexpr const char* kCall = "PlanningScene::hold";
  if (isHolding()) {
    detail::refuseCall(kCall, fmt::format("found object {} in the hand already, expected an empty "
                                          "one",
                                          held_number_));
  }
  checkPlace(kCall, "a base", base);
  const Pose world_from_grip = worldFromRoot(base) * rootFromGrip();
  resting_->remove(object);
  take(object, inverse(world_from_grip) * poses_[object]);
  ignorePenetrating(base);
  is_pretended_ = true;
}

void PlannerEnv::putBack() {
  if (!is_pretended_) {
    detail::refuseCall("PlanningScene::putBack",
                       "found no object in the hand that hold() has taken, and no other goes back");
  }
  held_ = nullptr;
  is_pretended_ = false;
  resting_->insert(held_number_, restingBox(models_[held_number_]->box, poses_[held_number_]));
}

bool PlannerEnv::isFree(const BasePlace& base) {
  if (left_.empty()) {
    if (penetrates(obstacles(), robotAt(base))) return false;
  } else if (!isRobotFreeOfScene(base) || touchesResting(base)) {
    return false;
  }
  return isHeldFree(base);
}

bool PlannerEnv::isRobotFreeOfScene(const BasePlace& base) {
  const SphereBatch spheres = robotAt(base);
  return std::ranges::all_of(spheres.ranges, [&](const RadiusRange& range) {
    const std::size_t count = paddedToLanes(range.count);
    const SphereCenters centers{{spheres.x + range.first, count},
                                {spheres.y + range.first, count},
                                {spheres.z + range.first, count}};
    return scene().grids()[range.radius_index].firstNotFree(centers) == count;
  });
}

bool PlannerEnv::isFreeOfAllElse(const BasePlace& base) {
  if (isAnyNear(base.position) && touchesResting(base)) return false;
  return isHeldFree(base);
}

bool PlannerEnv::touchesResting(const BasePlace& base) {
  const SphereBatch spheres = robotAt(base);
  if (!resting_->touches(spheres)) return false;
  if (left_.empty()) return true;
  for (std::uint32_t n = 0; n < resting_->capacity(); ++n) {
    if (!resting_->isResting(n)) continue;
    if (!overlapping(resting_->box(n), spheres, overlapping_)) continue;
    const auto left = std::ranges::find(left_, n, &Left::object);
    if (left == left_.end() || anyCounts(overlapping_, left->spheres)) return true;
  }
  return false;
}

bool PlannerEnv::isAnyNear(const Vec3& position) const {
  for (std::uint32_t n = 0; n < resting_->capacity(); ++n) {
    if (!resting_->isResting(n)) continue;
    const RestingBox& box = resting_->box(n);
    const Vec3 half = box.half_extents;
    const float x = box.center.x - position.x;
    const float z = box.center.z - position.z;
    const float far = reach_ + std::sqrt(dot(half, half));
    if (x * x + z * z < far * far) return true;
  }
  return false;
}

bool PlannerEnv::isHeldFree(const BasePlace& base) {
  if (held_ == nullptr) return true;
  if (!penetrates(obstacles(), heldAt(base))) return true;
  return !anyCounts(findPenetrating(base), ignored_);
}

std::span<const std::uint64_t> PlannerEnv::findPenetrating(const BasePlace& base) {
  penetrating(obstacles(), heldAt(base), collision_, penetrating_);
  return penetrating_;
}

void PlannerEnv::ignorePenetrating(const BasePlace& base) {
  if (held_ == nullptr) return;
  std::ranges::copy(findPenetrating(base), ignored_.begin());
}

void PlannerEnv::countFree(const BasePlace& base) {
  if (held_ != nullptr && !isEmpty(ignored_)) keepPenetrating(ignored_, findPenetrating(base));
  if (left_.empty()) return;
  const SphereBatch spheres = robotAt(base);
  std::erase_if(left_, [&](Left& left) {
    // Keep an object that is in the hand: putBack() lays it to rest where it was.
    if (!resting_->isResting(left.object)) return false;
    overlapping(resting_->box(left.object), spheres, overlapping_);
    return !keepPenetrating(left.spheres, overlapping_);
  });
}

std::optional<Pose> PlannerEnv::landing(const BasePlace& base) {
  const Pose released = worldFromRoot(base) * (rootFromGrip() * grip_from_object_);
  RandomStream random(0, 0, 0, 0);
  const Landing landing =
      placeObject(obstacles(), *held_, released, random, options_.placement, placement_);
  if (!landing.placed) return std::nullopt;
  return landing.pose;
}

bool PlannerEnv::isPoseFree(const RobotPose& pose) {
  assemble(pose.joints);
  return isFree(pose.base);
}

std::optional<float> PlannerEnv::floorAt(const Vec3& base) const {
  const FloorUnder under = floorUnder(scene(), base, options_.ground);
  if (under.floor != Floor::kCarries) return std::nullopt;
  return under.height;
}

void checkPositions(const char* call, const char* name, std::span<const float> positions) {
  for (std::size_t n = 0; n < positions.size(); ++n) {
    if (isPlain(positions[n])) continue;
    detail::refuseCall(call, fmt::format("found {}[{}] {:g}, expected a finite number of at most "
                                         "{:g}",
                                         name, n, positions[n], kLargestPlain));
  }
}

void checkPlace(const char* call, const char* name, const BasePlace& base) {
  if (isPlain(base.position) && isPlain(base.yaw)) return;
  detail::refuseCall(call, fmt::format("found {} at ({:g}, {:g}, {:g}) with the yaw {:g}, expected "
                                       "finite numbers of at most {:g}",
                                       name, base.position.x, base.position.y, base.position.z,
                                       base.yaw, kLargestPlain));
}

}  // namespace galactic::simulation
