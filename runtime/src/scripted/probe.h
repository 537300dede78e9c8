#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/world.h"
#include "scripted/arm.h"
#include "scripted/sphere_cloud.h"
#include "simulation/collision/collision.h"
#include "simulation/collision/resting_objects.h"
#include "simulation/phases/object_placement.h"

namespace galactic::scripted {

/// What one env's robot may do without penetrating anything, judged by the rules of the simulation:
/// the static scene, the objects at rest, the spheres of the robot and of what it holds. Not safe
/// to share between threads.
class Probe {
 public:
  /// `world`, whose robot has base and end effector, must outlive the probe.
  Probe(const World& world, const SimulationOptions& options);

  /// Takes over the scene, the objects and what is held.
  void look(const EnvState& state);

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const simulation::RestingObjects& objects() const { return resting_; }
  [[nodiscard]] const ObjectModel& object(std::size_t number) const { return *models_[number]; }
  [[nodiscard]] bool isHolding() const { return held_ != nullptr; }
  /// Of the held object.
  [[nodiscard]] const Pose& gripFromObject() const { return grip_from_object_; }

  [[nodiscard]] Arm& arm() { return arm_; }
  [[nodiscard]] static Pose worldFromRoot(const BasePlace& base, float root_height);
  [[nodiscard]] Pose worldFromRoot(const BasePlace& base) const;

  /// The height of the floor under (x, z) for a base that comes from height `from`; none where it
  /// cannot stand.
  [[nodiscard]] std::optional<float> floorAt(float x, float z, float from) const;

  /// Joint positions for the calls of isFreeAt and touching that follow.
  void setArm(std::span<const float> positions);
  /// How far the robot reaches from its root's vertical axis, meters.
  [[nodiscard]] float robotReach() const { return robot_reach_; }
  [[nodiscard]] bool isFreeAt(const BasePlace& base);
  [[nodiscard]] bool isFree(const BasePlace& base, std::span<const float> positions) {
    setArm(positions);
    return isFreeAt(base);
  }
  /// The parts of isFreeAt: the robot and the static scene; the robot and the objects, and what it
  /// holds and both.
  [[nodiscard]] bool isFreeOfScene(const BasePlace& base);
  [[nodiscard]] bool isFreeOfRest(const BasePlace& base);

  /// Takes object `number`, which rests, into the hand as if grasped in this pose; and back to
  /// where it rests.
  void pretendToHold(std::uint32_t number, const BasePlace& base, std::span<const float> positions);
  void pretendNoMore();

  /// Spheres of the held object that penetrate something at this pose do not count from now on: as
  /// in the simulation, which ignores them from the grasp until they get free.
  void ignoreTouching(const BasePlace& base, std::span<const float> positions);
  /// Spheres that are free at this pose count again.
  void keepTouching(const BasePlace& base, std::span<const float> positions);

  /// Where the held object would come to rest, released here; none when it finds no place without
  /// a jitter.
  [[nodiscard]] std::optional<Pose> landing(const BasePlace& base,
                                            std::span<const float> positions);

 private:
  /// Whether an object's bounds lie within the robot's, over a base at `position`.
  [[nodiscard]] bool isAnyNear(const Vec3& position) const;
  void hold(std::uint32_t number, const Pose& grip_from_object);
  [[nodiscard]] bool heldIsFree(const simulation::SphereBatch& spheres);
  void findTouching(const BasePlace& base, std::span<const float> positions);

  const World& world_;
  SimulationOptions options_;
  Arm arm_;
  float root_height_ = 0;
  const Scene* scene_ = nullptr;
  simulation::RestingObjects resting_;
  std::vector<const ObjectModel*> models_;
  SphereCloud robot_;
  float robot_reach_ = 0;
  std::vector<Pose> poses_;
  const ObjectModel* held_ = nullptr;
  std::uint32_t held_number_ = 0;
  Pose grip_from_object_;
  SphereCloud held_spheres_;
  std::vector<std::uint64_t> touching_;
  std::vector<std::uint64_t> ignored_;
  simulation::CollisionScratch collision_;
  simulation::PlacementScratch placement_;
};

}  // namespace galactic::scripted
