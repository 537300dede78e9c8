#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/planning_scene.h"
#include "galactic/pose.h"
#include "galactic/self_collision.h"
#include "galactic/simulation_options.h"
#include "galactic/world.h"
#include "simulation/collision/collision.h"
#include "simulation/collision/resting_objects.h"
#include "simulation/phases/object_placement.h"
#include "simulation/queries/sphere_cloud.h"

namespace galactic::simulation {

/// Resting objects that can be copied.
class OwnObjects {
 public:
  OwnObjects(std::size_t most_objects, float largest_radius)
      : objects_(most_objects, largest_radius) {}
  OwnObjects(const OwnObjects& other)
      : objects_(other.objects_.capacity(), other.objects_.largestRadius()) {
    for (std::uint32_t n = 0; n < objects_.capacity(); ++n) {
      if (other.objects_.isResting(n)) objects_.insert(n, other.objects_.box(n));
    }
  }
  OwnObjects(OwnObjects&&) = delete;
  OwnObjects& operator=(const OwnObjects&) = delete;
  OwnObjects& operator=(OwnObjects&&) = delete;
  ~OwnObjects() = default;

  [[nodiscard]] RestingObjects& operator*() { return objects_; }
  [[nodiscard]] const RestingObjects& operator*() const { return objects_; }
  RestingObjects* operator->() { return &objects_; }
  const RestingObjects* operator->() const { return &objects_; }

 private:
  RestingObjects objects_;
};

/// What a PlanningScene knows of an env, and what it says of one pose; see there. Calls do not ask
/// for what has to be there, but for update(), setJoints(), hold() and putBack(), which throw as
/// PlanningScene does.
class PlannerEnv {
 public:
  PlannerEnv(const World& world, const SimulationOptions& options);

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

  /// isFree() with other joints, which stay.
  [[nodiscard]] bool isPoseFree(const RobotPose& pose);
  /// Puts links and spheres to where these joints have them.
  void assemble(std::span<const float> positions);
  [[nodiscard]] std::optional<float> floorAt(const Vec3& base) const;

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
  [[nodiscard]] const RestingObjects& resting() const { return *resting_; }
  [[nodiscard]] const std::vector<const ObjectModel*>& models() const { return models_; }
  [[nodiscard]] const Pose& poseOf(std::size_t object) const { return poses_[object]; }
  [[nodiscard]] bool isHolding() const { return held_ != nullptr; }
  [[nodiscard]] const Pose& gripFromObject() const { return grip_from_object_; }

  [[nodiscard]] bool isUpdated() const { return scene_ != nullptr; }
  [[nodiscard]] bool hasJoints() const { return has_joints_; }
  /// Both.
  [[nodiscard]] bool isReady() const { return is_ready_; }

 private:
  friend class PlannerClearance;
  friend class PlannerMotion;
  /// A resting object that the robot leaves, and which of its spheres do not count against it.
  struct Left {
    std::uint32_t object = 0;
    std::vector<std::uint64_t> spheres;
  };

  [[nodiscard]] Obstacles obstacles() const { return {scene(), *resting_}; }
  /// Whether an object's bounds lie within the robot's, over a base at `position`.
  [[nodiscard]] bool isAnyNear(const Vec3& position) const;
  void assembleHeld();
  void take(std::uint32_t object, const Pose& grip_from_object);
  /// What penetrates something as the robot of an env is does not count from now on.
  void ignoreAsIn(const EnvState& state);
  /// The robot's spheres that penetrate resting objects here do not count against these.
  void leavePenetrating(const BasePlace& base);
  /// Finds the held object's spheres that penetrate something.
  [[nodiscard]] std::span<const std::uint64_t> findPenetrating(const BasePlace& base);
  [[nodiscard]] SphereBatch robotAt(const BasePlace& base) { return robot_.at(base, root_height_); }
  [[nodiscard]] SphereBatch heldAt(const BasePlace& base) {
    return held_spheres_.at(base, root_height_);
  }
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
  OwnObjects resting_;
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

  std::vector<Left> left_;
  /// One bit per sphere of the robot.
  std::vector<std::uint64_t> overlapping_;

  CollisionScratch collision_;
  PlacementScratch placement_;
};

/// Joint positions in order; throws, as `call`, for others.
void checkPositions(const char* call, const char* name, std::span<const float> positions);

/// A place of finite numbers; throws, as `call`, for others.
void checkPlace(const char* call, const char* name, const BasePlace& base);

}  // namespace galactic::simulation
