#include "galactic/planning_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "galactic/robot.h"
#include "simulation/collision/grasp_query.h"
#include "simulation/collision/resting_box.h"
#include "simulation/queries/planner_clearance.h"
#include "simulation/queries/planner_env.h"
#include "simulation/queries/planner_motion.h"
#include "simulation/state/plain_numbers.h"
#include "support/call_check.h"
#include "support/threads/workers.h"

namespace galactic {
namespace {

/// The number of poses that a thread takes at a time.
constexpr std::size_t kPosesOfAPart = 128;

// Separate functions, out of the way of calls that are in order.
[[noreturn]] void refuseWithoutEnv(const char* call) {
  detail::refuseCall(call, "found no env; take one over first, with update()");
}
[[noreturn]] void refuseWithoutJoints(const char* call) {
  detail::refuseCall(call, "found no joint positions; choose them first, with setJoints()");
}

}  // namespace

Vec3 headingOf(float yaw) { return {std::cos(yaw), 0, -std::sin(yaw)}; }

class PlanningScene::Impl : public simulation::PlannerEnv {
 public:
  Impl(const World& world, const SimulationOptions& options)
      : PlannerEnv(world, options), motion_(world.robot()), clearance_(world) {}

  [[nodiscard]] bool isMotionFree(const RobotPose& from, const RobotPose& to) {
    const auto is_place = [](const BasePlace& base) {
      return simulation::isPlain(base.position) && simulation::isPlain(base.yaw);
    };
    return is_place(from.base) && is_place(to.base) && motion_.isFree(*this, from, to);
  }

  [[nodiscard]] std::size_t sphereCount() const { return clearance_.sphereCount(*this); }
  [[nodiscard]] std::span<const SphereClearance> clearances(const BasePlace& base, float most) {
    return clearance_.measure(*this, base, most);
  }
  void clearancesOf(const RobotPose& pose, float most, std::span<SphereClearance> clearances,
                    const ClearanceGradients& gradients) {
    assemble(pose.joints);
    std::ranges::copy(clearance_.measure(*this, pose.base, most), clearances.begin());
    clearance_.derive(*this, pose, gradients);
  }

  // Preconditions of calls: throw if an earlier call is missing.
  void requireUpdated(const char* call) const {
    if (!isUpdated()) [[unlikely]]
      refuseWithoutEnv(call);
  }
  void requireJoints(const char* call) const {
    if (!hasJoints()) [[unlikely]]
      refuseWithoutJoints(call);
  }
  /// Requires both with one branch, because planners ask millions of times.
  void requireReady(const char* call) const {
    if (isReady()) [[likely]]
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
    detail::checkIndex(call, "object", object, models().size());
  }

 private:
  simulation::PlannerMotion motion_;
  simulation::PlannerClearance clearance_;
};

namespace {

/// Poses as rows of joint positions, checked.
class PoseRows {
 public:
  /// Throws, in the name of `call`, if they are not in order. `name`: such as "from.", or "" if
  /// there is only one set of poses.
  PoseRows(const char* call, const std::string& name, const RobotPoses& poses, const Robot& robot)
      : poses_(poses), positions_(robot.positionCount()) {
    const std::string joints = name + "joints";
    detail::checkLength(call, joints.c_str(), poses.joints.size(), poses.bases.size() * positions_);
    simulation::checkPositions(call, joints.c_str(), poses.joints);
  }

  [[nodiscard]] RobotPose operator[](std::size_t n) const {
    return {poses_.bases[n], poses_.joints.subspan(n * positions_, positions_)};
  }

 private:
  RobotPoses poses_;
  std::size_t positions_;
};

/// Calls `ask(copy, n)` for each n below `count` with copies of a scene, one copy per part.
template <class Scene, class Ask>
void askCopies(const Scene& scene, std::size_t count, std::uint32_t threads, const Ask& ask) {
  const std::size_t parts = (count + kPosesOfAPart - 1) / kPosesOfAPart;
  detail::forEachPart(detail::threadCount(threads), parts, [&](std::size_t part) {
    Scene copy(scene);
    const std::size_t end = std::min(count, (part + 1) * kPosesOfAPart);
    for (std::size_t n = part * kPosesOfAPart; n < end; ++n) ask(copy, n);
  });
}

void checkMost(const char* call, float most) {
  if (most > 0 && simulation::isPlain(most)) return;
  detail::refuseCall(call, fmt::format("found most {:g}, expected meters above 0 and at most {:g}",
                                       most, simulation::kLargestPlain));
}

/// Checks the length of an array of derivatives, unless it is empty because it is not wanted.
void checkGradient(const char* call, const char* name, std::span<const float> gradient,
                   std::size_t expected) {
  if (!gradient.empty()) detail::checkLength(call, name, gradient.size(), expected);
}

/// The part of an array that belongs to the n-th of `count` poses; empty if the array is.
template <class Number>
std::span<Number> partOf(std::span<Number> all, std::size_t n, std::size_t count) {
  const std::size_t each = all.size() / count;
  return all.subspan(n * each, each);
}

}  // namespace

PlanningScene::PlanningScene(const World& world, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(world, options)) {}
PlanningScene::~PlanningScene() = default;
PlanningScene::PlanningScene(const PlanningScene& other)
    : impl_(std::make_unique<Impl>(*other.impl_)) {}
PlanningScene& PlanningScene::operator=(const PlanningScene& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
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
  return impl_->floorAt({x, from, z});
}

bool PlanningScene::isFree(const BasePlace& base) {
  impl_->requireReady("PlanningScene::isFree");
  return impl_->isFree(base);
}
bool PlanningScene::isRobotFreeOfScene(const BasePlace& base) {
  impl_->requireReady("PlanningScene::isRobotFreeOfScene");
  return impl_->isRobotFreeOfScene(base);
}
bool PlanningScene::isFreeOfAllElse(const BasePlace& base) {
  impl_->requireReady("PlanningScene::isFreeOfAllElse");
  return impl_->isFreeOfAllElse(base);
}

bool PlanningScene::isMotionFree(const RobotPose& from, const RobotPose& to) {
  constexpr const char* kCall = "PlanningScene::isMotionFree";
  impl_->requireUpdated(kCall);
  const Robot& robot = impl_->world().robot();
  static_cast<void>(PoseRows(kCall, "from.", {std::span(&from.base, 1), from.joints}, robot));
  static_cast<void>(PoseRows(kCall, "to.", {std::span(&to.base, 1), to.joints}, robot));
  return impl_->isMotionFree(from, to);
}

void PlanningScene::areFree(const RobotPoses& poses, std::span<std::uint8_t> free,
                            std::uint32_t threads) const {
  constexpr const char* kCall = "PlanningScene::areFree";
  impl_->requireUpdated(kCall);
  const PoseRows rows(kCall, "", poses, impl_->world().robot());
  detail::checkLength(kCall, "free", free.size(), poses.bases.size());
  askCopies(*impl_, free.size(), threads,
            [&](Impl& scene, std::size_t n) { free[n] = scene.isPoseFree(rows[n]) ? 1 : 0; });
}

void PlanningScene::areMotionsFree(const RobotPoses& from, const RobotPoses& to,
                                   std::span<std::uint8_t> free, std::uint32_t threads) const {
  constexpr const char* kCall = "PlanningScene::areMotionsFree";
  impl_->requireUpdated(kCall);
  const PoseRows begins(kCall, "from.", from, impl_->world().robot());
  const PoseRows ends(kCall, "to.", to, impl_->world().robot());
  detail::checkLength(kCall, "to.bases", to.bases.size(), from.bases.size());
  detail::checkLength(kCall, "free", free.size(), from.bases.size());
  askCopies(*impl_, free.size(), threads, [&](Impl& scene, std::size_t n) {
    free[n] = scene.isMotionFree(begins[n], ends[n]) ? 1 : 0;
  });
}

std::size_t PlanningScene::sphereCount() const {
  impl_->requireUpdated("PlanningScene::sphereCount");
  return impl_->sphereCount();
}

std::span<const SphereClearance> PlanningScene::clearances(const BasePlace& base, float most) {
  constexpr const char* kCall = "PlanningScene::clearances";
  impl_->requireReady(kCall);
  simulation::checkPlace(kCall, "base", base);
  checkMost(kCall, most);
  return impl_->clearances(base, most);
}

void PlanningScene::clearances(const RobotPoses& poses, float most,
                               std::span<SphereClearance> clearances,
                               const ClearanceGradients& gradients, std::uint32_t threads) const {
  constexpr const char* kCall = "PlanningScene::clearances";
  impl_->requireUpdated(kCall);
  const PoseRows rows(kCall, "", poses, impl_->world().robot());
  const std::size_t count = poses.bases.size();
  for (std::size_t n = 0; n < count; ++n) {
    simulation::checkPlace(kCall, fmt::format("bases[{}]", n).c_str(), poses.bases[n]);
  }
  checkMost(kCall, most);
  detail::checkLength(kCall, "clearances", clearances.size(), count * impl_->sphereCount());
  checkGradient(kCall, "gradients.bases", gradients.bases, clearances.size() * 4);
  checkGradient(kCall, "gradients.joints", gradients.joints,
                clearances.size() * impl_->world().robot().positionCount());
  askCopies(*impl_, count, threads, [&](Impl& scene, std::size_t n) {
    scene.clearancesOf(rows[n], most, partOf(clearances, n, count),
                       {partOf(gradients.bases, n, count), partOf(gradients.joints, n, count)});
  });
}

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

void PlanningScene::hold(std::uint32_t object, const BasePlace& base) {
  constexpr const char* kCall = "PlanningScene::hold";
  impl_->requireReady(kCall);
  impl_->requireObject(kCall, object);
  impl_->hold(object, base);
}
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
std::optional<Pose> PlanningScene::landing(const BasePlace& base) {
  constexpr const char* kCall = "PlanningScene::landing";
  impl_->requireReady(kCall);
  impl_->requireHeld(kCall);
  return impl_->landing(base);
}

}  // namespace galactic
