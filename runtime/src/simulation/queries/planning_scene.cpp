#include "galactic/planning_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "galactic/error.h"
#include "galactic/kinematics.h"
#include "galactic/option_text.h"
#include "galactic/robot.h"
#include "galactic/self_collision.h"
#include "simulation/collision/collision.h"
#include "simulation/collision/floor_query.h"
#include "simulation/collision/grasp_query.h"
#include "simulation/collision/resting_objects.h"
#include "simulation/phases/object_placement.h"
#include "simulation/queries/checked_state.h"
#include "simulation/queries/sphere_cloud.h"
#include "simulation/state/plain_numbers.h"
#include "support/call_check.h"
#include "support/random_stream.h"

namespace galactic {
namespace {

constexpr std::size_t kBitsPerWord = 64;

/// One bit for each sphere.
std::size_t wordsFor(const simulation::SphereCloud& cloud) {
  return (cloud.paddedCount() + kBitsPerWord - 1) / kBitsPerWord;
}

/// Whether a bit is set that is not ignored.
bool anyCounts(std::span<const std::uint64_t> bits, std::span<const std::uint64_t> ignored) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < bits.size(); ++w) any |= bits[w] & ~ignored[w];
  return any != 0;
}

/// Bits that are not among `bits` are no more; whether some are left.
bool keepOf(std::span<const std::uint64_t> bits, std::span<std::uint64_t> kept) {
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < kept.size(); ++w) any |= kept[w] &= bits[w];
  return any != 0;
}

using simulation::SphereCloud;

SphereCloud cloudOf(const Robot& robot) {
  std::vector<SphereCloud::Sphere> spheres;
  spheres.reserve(robot.spheres().size());
  for (const SphereGroup& group : robot.groups()) {
    for (const SetSphere& sphere : group.spheres) spheres.push_back({group.link, sphere});
  }
  return {spheres, robot.radii()};
}

/// Options in their ranges; throws for others.
const SimulationOptions& checked(const SimulationOptions& options) {
  orThrow(checkOptions(options));
  return options;
}

// Out of the way of calls that are in order.
[[noreturn]] void refuseWithoutEnv(const char* call) {
  detail::refuseCall(call, "found no env; take one over first, with update()");
}
[[noreturn]] void refuseWithoutJoints(const char* call) {
  detail::refuseCall(call, "found no joint positions; choose them first, with setJoints()");
}

std::size_t mostSpheres(const World& world) {
  const std::size_t most = std::max(world.robot().spheres().size(), world.mostObjectSpheres());
  return simulation::paddedToLanes(most) + simulation::kLanes * world.radii().size();
}

}  // namespace

Vec3 headingOf(float yaw) { return {std::cos(yaw), 0, -std::sin(yaw)}; }

class PlanningScene::Impl {
 public:
  Impl(const World& world, const SimulationOptions& options)
      : world_(world),
        options_(checked(options)),
        root_height_(world.robot().base()->root_height),
        joints_(world.robot().positionCount()),
        links_(world.robot().links().size()),
        robot_(cloudOf(world.robot())),
        self_collision_(world_.robot()),
        // Whatever asks for objects: spheres, and the hand.
        resting_(world.mostObjects(),
                 std::max(world.radii().back(), world.robot().endEffector()->grasp_radius)),
        collision_(mostSpheres(world)),
        placement_(mostSpheres(world), world.radii()) {
    // A jitter is random; what is planned shall not be.
    options_.placement.attempts = 1;
    overlapping_.resize(wordsFor(robot_));
  }

  void update(const EnvState& state);
  void setJoints(std::span<const float> positions);
  void hold(std::uint32_t object, const BasePlace& base);
  void putBack();

  [[nodiscard]] Pose rootFromGrip() const {
    const EndEffector& hand = *world_.robot().endEffector();
    return links_[hand.link] * Pose{hand.grasp_point, {}};
  }
  [[nodiscard]] Pose worldFromRoot(const BasePlace& base) const {
    return {base.position + Vec3{0, root_height_, 0}, rotationOfYaw(base.yaw)};
  }

  [[nodiscard]] bool isFree(const BasePlace& base);
  [[nodiscard]] bool isRobotFreeOfScene(const BasePlace& base);
  [[nodiscard]] bool isFreeOfAllElse(const BasePlace& base);

  void ignorePenetrating(const BasePlace& base);
  void countFree(const BasePlace& base);

  [[nodiscard]] std::optional<Pose> landing(const BasePlace& base);

  [[nodiscard]] BasePlace baseOf(const EnvState& state) const {
    return {state.world_from_root.translation - Vec3{0, root_height_, 0},
            yawOf(state.world_from_root.rotation)};
  }

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const SimulationOptions& options() const { return options_; }
  /// Of an env that was taken over.
  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] std::span<const Pose> links() const { return links_; }
  [[nodiscard]] float reach() const { return reach_; }
  [[nodiscard]] bool touchesItself(float margin) const {
    return self_collision_.touches(links_, margin);
  }
  [[nodiscard]] const simulation::RestingObjects& resting() const { return resting_; }
  [[nodiscard]] const std::vector<const ObjectModel*>& models() const { return models_; }
  [[nodiscard]] const Pose& poseOf(std::size_t object) const { return poses_[object]; }
  [[nodiscard]] bool isHolding() const { return held_ != nullptr; }
  [[nodiscard]] const Pose& gripFromObject() const { return grip_from_object_; }

  // What calls ask of those before them: they throw where that is missing.
  void requireUpdated(const char* call) const {
    if (scene_ == nullptr) [[unlikely]]
      refuseWithoutEnv(call);
  }
  void requireJoints(const char* call) const {
    if (!has_joints_) [[unlikely]]
      refuseWithoutJoints(call);
  }
  /// Both: one branch, as planners ask millions of times.
  void requireReady(const char* call) const {
    if (is_ready_) [[likely]]
      return;
    requireUpdated(call);
    requireJoints(call);
  }
  void requireHeld(const char* call) const {
    requireUpdated(call);
    if (!isHolding()) {
      detail::refuseCall(call, "found an empty hand, expected one that holds an object");
    }
  }
  void requireObject(const char* call, std::size_t object) const {
    requireUpdated(call);
    detail::checkIndex(call, "object", object, models_.size());
  }

 private:
  [[nodiscard]] simulation::Obstacles obstacles() const { return {scene(), resting_}; }
  /// Whether an object's bounds lie within the robot's, over a base at `position`.
  [[nodiscard]] bool isAnyNear(const Vec3& position) const;
  /// Puts links and spheres to where these joints have them.
  void assemble(std::span<const float> positions);
  void assembleHeld();
  void take(std::uint32_t object, const Pose& grip_from_object);
  /// What penetrates something as the robot of an env is does not count from now on.
  void ignoreAsIn(const EnvState& state);
  /// The robot's spheres that penetrate resting objects here do not count against these.
  void leavePenetrating(const BasePlace& base);
  /// Finds the held object's spheres that penetrate something.
  [[nodiscard]] std::span<const std::uint64_t> findPenetrating(const BasePlace& base);
  [[nodiscard]] bool touchesResting(const BasePlace& base);
  [[nodiscard]] bool isHeldFree(const BasePlace& base);

  World world_;
  SimulationOptions options_;
  float root_height_ = 0;
  /// The current joints, and root_from_link for these.
  std::vector<float> joints_;
  std::vector<Pose> links_;
  SphereCloud robot_;
  SelfCollision self_collision_;
  float reach_ = 0;

  /// None before update().
  const Scene* scene_ = nullptr;
  bool has_joints_ = false;
  /// Whether there are both, as questions about places want it.
  bool is_ready_ = false;
  simulation::RestingObjects resting_;
  std::vector<const ObjectModel*> models_;
  std::vector<Pose> poses_;

  const ObjectModel* held_ = nullptr;
  std::uint32_t held_number_ = 0;
  /// Whether hold() took it, not the robot of the env.
  bool is_pretended_ = false;
  Pose grip_from_object_;
  SphereCloud held_spheres_;
  /// One bit per sphere of the held object.
  std::vector<std::uint64_t> penetrating_;
  std::vector<std::uint64_t> ignored_;

  /// A resting object that the robot leaves, and which of its spheres do not count against it.
  struct Left {
    std::uint32_t object = 0;
    std::vector<std::uint64_t> spheres;
  };
  std::vector<Left> left_;
  /// One bit per sphere of the robot.
  std::vector<std::uint64_t> overlapping_;

  simulation::CollisionScratch collision_;
  simulation::PlacementScratch placement_;
};

void PlanningScene::Impl::update(const EnvState& state) {
  constexpr const char* kCall = "PlanningScene::update";
  const std::span<const Placement> placements = simulation::checkedObjects(kCall, world_, state);
  const Episode& episode = world_.episodes().episodes()[state.episode];
  detail::checkLength(
      kCall, "objects", placements.size(),
      world_.episodes().present(episode, options_.task.distractors).placements.size());
  scene_ = &world_.scenes()[state.scene];
  is_ready_ = has_joints_;
  models_.clear();
  resting_.clear();
  held_ = nullptr;
  for (std::uint32_t n = 0; n < placements.size(); ++n) {
    models_.push_back(&world_.objectOf(placements[n]));
    if (static_cast<std::int32_t>(n) == state.held) continue;
    resting_.insert(n, simulation::restingBox(models_[n]->box, state.objects[n]));
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

void PlanningScene::Impl::ignoreAsIn(const EnvState& state) {
  assemble(state.joint_positions);
  const BasePlace base = baseOf(state);
  ignorePenetrating(base);
  leavePenetrating(base);
  if (has_joints_) assemble(joints_);
}

void PlanningScene::Impl::leavePenetrating(const BasePlace& base) {
  const simulation::SphereBatch spheres = robot_.at(base, root_height_);
  if (!resting_.touches(spheres)) return;
  for (std::uint32_t n = 0; n < resting_.capacity(); ++n) {
    if (!resting_.isResting(n)) continue;
    if (!simulation::overlapping(resting_.box(n), spheres, overlapping_)) continue;
    left_.push_back({n, overlapping_});
  }
}

void PlanningScene::Impl::setJoints(std::span<const float> positions) {
  constexpr const char* kCall = "PlanningScene::setJoints";
  detail::checkLength(kCall, "positions", positions.size(), world_.robot().positionCount());
  for (std::size_t n = 0; n < positions.size(); ++n) {
    if (simulation::isPlain(positions[n])) continue;
    detail::refuseCall(kCall, fmt::format("found positions[{}] {:g}, expected a finite number of "
                                          "at most {:g}",
                                          n, positions[n], simulation::kLargestPlain));
  }
  has_joints_ = true;
  is_ready_ = scene_ != nullptr;
  std::ranges::copy(positions, joints_.begin());
  assemble(joints_);
}

void PlanningScene::Impl::assemble(std::span<const float> positions) {
  forwardKinematics(world_.robot().links(), {}, positions, links_);
  robot_.assemble(links_);
  reach_ = robot_.reach();
  if (held_ != nullptr) assembleHeld();
}

void PlanningScene::Impl::take(std::uint32_t object, const Pose& grip_from_object) {
  held_number_ = object;
  held_ = models_[object];
  grip_from_object_ = grip_from_object;
  std::vector<SphereCloud::Sphere> spheres;
  spheres.reserve(held_->spheres.size());
  for (const SetSphere& sphere : held_->spheres) spheres.push_back({0, sphere});
  held_spheres_ = SphereCloud(spheres, world_.radii());
  penetrating_.assign(wordsFor(held_spheres_), 0);
  ignored_.assign(wordsFor(held_spheres_), 0);
  assembleHeld();
}

void PlanningScene::Impl::assembleHeld() {
  const Pose root_from_object = rootFromGrip() * grip_from_object_;
  held_spheres_.assemble(std::span(&root_from_object, 1));
}

void PlanningScene::Impl::hold(std::uint32_t object, const BasePlace& base) {
  constexpr const char* kCall = "PlanningScene::hold";
  requireReady(kCall);
  requireObject(kCall, object);
  if (isHolding()) {
    detail::refuseCall(kCall, fmt::format("found object {} in the hand already, expected an empty "
                                          "one",
                                          held_number_));
  }
  if (!simulation::isPlain(base.position) || !simulation::isPlain(base.yaw)) {
    detail::refuseCall(
        kCall, fmt::format("found a base at ({:g}, {:g}, {:g}) with the yaw {:g}, expected finite "
                           "numbers of at most {:g}",
                           base.position.x, base.position.y, base.position.z, base.yaw,
                           simulation::kLargestPlain));
  }
  const Pose world_from_grip = worldFromRoot(base) * rootFromGrip();
  resting_.remove(object);
  take(object, inverse(world_from_grip) * poses_[object]);
  ignorePenetrating(base);
  is_pretended_ = true;
}

void PlanningScene::Impl::putBack() {
  if (!is_pretended_) {
    detail::refuseCall("PlanningScene::putBack",
                       "found no object in the hand that hold() has taken, and no other goes back");
  }
  held_ = nullptr;
  is_pretended_ = false;
  resting_.insert(held_number_,
                  simulation::restingBox(models_[held_number_]->box, poses_[held_number_]));
}

bool PlanningScene::Impl::isFree(const BasePlace& base) {
  requireReady("PlanningScene::isFree");
  if (left_.empty()) {
    if (simulation::penetrates(obstacles(), robot_.at(base, root_height_))) return false;
  } else if (!isRobotFreeOfScene(base) || touchesResting(base)) {
    return false;
  }
  return isHeldFree(base);
}

bool PlanningScene::Impl::isRobotFreeOfScene(const BasePlace& base) {
  requireReady("PlanningScene::isRobotFreeOfScene");
  const simulation::SphereBatch spheres = robot_.at(base, root_height_);
  return std::ranges::all_of(spheres.ranges, [&](const simulation::RadiusRange& range) {
    const std::size_t count = simulation::paddedToLanes(range.count);
    const SphereCenters centers{{spheres.x + range.first, count},
                                {spheres.y + range.first, count},
                                {spheres.z + range.first, count}};
    return scene().grids()[range.radius_index].firstNotFree(centers) == count;
  });
}

bool PlanningScene::Impl::isFreeOfAllElse(const BasePlace& base) {
  requireReady("PlanningScene::isFreeOfAllElse");
  if (isAnyNear(base.position) && touchesResting(base)) return false;
  return isHeldFree(base);
}

bool PlanningScene::Impl::touchesResting(const BasePlace& base) {
  const simulation::SphereBatch spheres = robot_.at(base, root_height_);
  if (!resting_.touches(spheres)) return false;
  if (left_.empty()) return true;
  for (std::uint32_t n = 0; n < resting_.capacity(); ++n) {
    if (!resting_.isResting(n)) continue;
    if (!simulation::overlapping(resting_.box(n), spheres, overlapping_)) continue;
    const auto left = std::ranges::find(left_, n, &Left::object);
    if (left == left_.end() || anyCounts(overlapping_, left->spheres)) return true;
  }
  return false;
}

bool PlanningScene::Impl::isAnyNear(const Vec3& position) const {
  for (std::uint32_t n = 0; n < resting_.capacity(); ++n) {
    if (!resting_.isResting(n)) continue;
    const simulation::RestingBox& box = resting_.box(n);
    const Vec3 half = box.half_extents;
    const float x = box.center.x - position.x;
    const float z = box.center.z - position.z;
    const float far = reach_ + std::sqrt(dot(half, half));
    if (x * x + z * z < far * far) return true;
  }
  return false;
}

bool PlanningScene::Impl::isHeldFree(const BasePlace& base) {
  if (held_ == nullptr) return true;
  if (!simulation::penetrates(obstacles(), held_spheres_.at(base, root_height_))) return true;
  return !anyCounts(findPenetrating(base), ignored_);
}

std::span<const std::uint64_t> PlanningScene::Impl::findPenetrating(const BasePlace& base) {
  simulation::penetrating(obstacles(), held_spheres_.at(base, root_height_), collision_,
                          penetrating_);
  return penetrating_;
}

void PlanningScene::Impl::ignorePenetrating(const BasePlace& base) {
  if (held_ == nullptr) return;
  std::ranges::copy(findPenetrating(base), ignored_.begin());
}

void PlanningScene::Impl::countFree(const BasePlace& base) {
  if (held_ != nullptr) keepOf(findPenetrating(base), ignored_);
  if (left_.empty()) return;
  const simulation::SphereBatch spheres = robot_.at(base, root_height_);
  std::erase_if(left_, [&](Left& left) {
    // One in the hand is back where it rested after putBack().
    if (!resting_.isResting(left.object)) return false;
    simulation::overlapping(resting_.box(left.object), spheres, overlapping_);
    return !keepOf(overlapping_, left.spheres);
  });
}

std::optional<Pose> PlanningScene::Impl::landing(const BasePlace& base) {
  constexpr const char* kCall = "PlanningScene::landing";
  requireReady(kCall);
  requireHeld(kCall);
  const Pose released = worldFromRoot(base) * (rootFromGrip() * grip_from_object_);
  RandomStream random(0, 0, 0, 0);
  const simulation::Landing landing = simulation::placeObject(obstacles(), *held_, released, random,
                                                              options_.placement, placement_);
  if (!landing.placed) return std::nullopt;
  return landing.pose;
}

PlanningScene::PlanningScene(const World& world, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(world, options)) {}
PlanningScene::~PlanningScene() = default;
PlanningScene::PlanningScene(PlanningScene&&) noexcept = default;
PlanningScene& PlanningScene::operator=(PlanningScene&&) noexcept = default;

void PlanningScene::update(const EnvState& state) { impl_->update(state); }
const Scene& PlanningScene::scene() const {
  impl_->requireUpdated("PlanningScene::scene");
  return impl_->scene();
}
void PlanningScene::setJoints(std::span<const float> positions) { impl_->setJoints(positions); }
std::span<const Pose> PlanningScene::rootFromLinks() const {
  impl_->requireJoints("PlanningScene::rootFromLinks");
  return impl_->links();
}
Pose PlanningScene::rootFromGrip() const {
  impl_->requireJoints("PlanningScene::rootFromGrip");
  return impl_->rootFromGrip();
}
float PlanningScene::reach() const {
  impl_->requireJoints("PlanningScene::reach");
  return impl_->reach();
}

bool PlanningScene::touchesItself(float margin) const {
  impl_->requireJoints("PlanningScene::touchesItself");
  return impl_->touchesItself(margin);
}

BasePlace PlanningScene::baseOf(const EnvState& state) const { return impl_->baseOf(state); }

Pose PlanningScene::worldFromRoot(const BasePlace& base) const {
  return impl_->worldFromRoot(base);
}

std::optional<float> PlanningScene::floorAt(float x, float z, float from) const {
  impl_->requireUpdated("PlanningScene::floorAt");
  const simulation::FloorUnder under =
      simulation::floorUnder(impl_->scene(), {x, from, z}, impl_->options().ground);
  if (under.floor != simulation::Floor::kCarries) return std::nullopt;
  return under.height;
}

bool PlanningScene::isFree(const BasePlace& base) { return impl_->isFree(base); }
bool PlanningScene::isRobotFreeOfScene(const BasePlace& base) {
  return impl_->isRobotFreeOfScene(base);
}
bool PlanningScene::isFreeOfAllElse(const BasePlace& base) { return impl_->isFreeOfAllElse(base); }

std::size_t PlanningScene::objectCount() const {
  impl_->requireUpdated("PlanningScene::objectCount");
  return impl_->models().size();
}

OrientedBox PlanningScene::objectBox(std::size_t object) const {
  impl_->requireObject("PlanningScene::objectBox", object);
  const OrientedBox& own = impl_->models()[object]->box;
  const Pose& pose = impl_->poseOf(object);
  const simulation::RestingBox box = simulation::restingBox(own, pose);
  return {{box.center, pose.rotation * own.pose.rotation}, box.half_extents};
}

float PlanningScene::squaredGraspDistance(std::size_t object, const Vec3& point) const {
  impl_->requireObject("PlanningScene::squaredGraspDistance", object);
  const ObjectModel& model = *impl_->models()[object];
  const Pose& pose = impl_->poseOf(object);
  return simulation::squaredGraspDistance(model, simulation::restingBox(model.box, pose), pose,
                                          point, impl_->options().action.grasp_shape);
}

std::optional<std::uint32_t> PlanningScene::graspedAt(const BasePlace& base) const {
  impl_->requireReady("PlanningScene::graspedAt");
  const Pose world_from_grip = impl_->worldFromRoot(base) * impl_->rootFromGrip();
  const auto model_of = [this](std::uint32_t index) -> const ObjectModel& {
    return *impl_->models()[index];
  };
  const auto pose_of = [this](std::uint32_t index) -> const Pose& { return impl_->poseOf(index); };
  const OptionalIndex grasped = simulation::nearestToGrasp(
      impl_->resting(),
      {world_from_grip.translation, impl_->world().robot().endEffector()->grasp_radius},
      impl_->options().action.grasp_shape, model_of, pose_of);
  return grasped ? std::optional(*grasped) : std::nullopt;
}

void PlanningScene::hold(std::uint32_t object, const BasePlace& base) { impl_->hold(object, base); }
void PlanningScene::putBack() { impl_->putBack(); }
bool PlanningScene::isHolding() const { return impl_->isHolding(); }
const Pose& PlanningScene::gripFromObject() const {
  impl_->requireHeld("PlanningScene::gripFromObject");
  return impl_->gripFromObject();
}
void PlanningScene::ignorePenetrating(const BasePlace& base) {
  impl_->requireReady("PlanningScene::ignorePenetrating");
  impl_->ignorePenetrating(base);
}
void PlanningScene::countFree(const BasePlace& base) {
  impl_->requireReady("PlanningScene::countFree");
  impl_->countFree(base);
}
std::optional<Pose> PlanningScene::landing(const BasePlace& base) { return impl_->landing(base); }

}  // namespace galactic
