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

/// What a PlanningScene knows of an env, and its answers about one pose; see there. Only update(),
/// setJoints(), hold() and putBack() check their arguments and throw as PlanningScene does; other
/// calls do not check their preconditions.
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

  /// isFree() with other joints, which remain assembled.
  [[nodiscard]] bool isPoseFree(const RobotPose& pose);
  /// Places links and spheres for these joint positions.
  void assemble(std::span<const float> positions);
  [[nodiscard]] std::optional<float> floorAt(const Vec3& base) const;

  [[nodiscard]] BasePlace baseOf(const EnvState& state) const {
    return {state.world_from_root.translation - Vec3{0, root_height_, 0},
            yawOf(state.world_from_root.rotation)};
  }

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const SimulationOptions& options() const { return options_; }
  /// The scene of the env that update() has loaded.
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
  /// Whether both are true.
  [[nodiscard]] bool isReady() const { return is_ready_; }

 private:
  friend class PlannerClearance;
  friend class PlannerMotion;
  /// A resting object that the robot is leaving, and the spheres of the robot that do not count
  /// against it.
  struct Left {
    std::uint32_t object = 0;
    std::vector<std::uint64_t> spheres;
  };

  [[nodiscard]] Obstacles obstacles() const { return {scene(), *resting_}; }
  /// Whether any resting object is within reach of the robot when its base is at `position`.
  [[nodiscard]] bool isAnyNear(const Vec3& position) const;
  void assembleHeld();
  void take(std::uint32_t object, const Pose& grip_from_object);
  /// Ignores the spheres that penetrate something with the robot as it is in `state`.
  void ignoreAsIn(const EnvState& state);
  /// Ignores the robot's spheres that penetrate resting objects here, against these objects only.
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
  /// The joint positions of setJoints(), and root_from_link for those last assembled.
  std::vector<float> joints_;
  std::vector<Pose> links_;
  SphereCloud robot_;
  SelfCollision self_collision_;
  float reach_ = 0;

  /// Null before update().
  const Scene* scene_ = nullptr;
  bool has_joints_ = false;
  /// Whether there are an env and joints, which questions about places need.
  bool is_ready_ = false;
  OwnObjects resting_;
  std::vector<const ObjectModel*> models_;
  std::vector<Pose> poses_;

  const ObjectModel* held_ = nullptr;
  std::uint32_t held_number_ = 0;
  /// Whether hold() took the held object; false if the env's robot holds it.
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

/// Throws, in the name of `call`, unless all joint positions are finite and not too large.
void checkPositions(const char* call, const char* name, std::span<const float> positions);

/// Throws, in the name of `call`, unless all numbers of the place are finite and not too large.
void checkPlace(const char* call, const char* name, const BasePlace& base);

}  // namespace galactic::simulation
