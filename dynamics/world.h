#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "dynamics/sources/robot_model.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/pose.h"
#include "galactic/robot.h"

namespace galactic::dynamics {

// Bullet's side of things; what is implemented with Bullet lies in bullet/.

/// A scene's triangles with the tree over them. Immutable: worlds on several threads share it.
class SceneShape;
[[nodiscard]] std::shared_ptr<const SceneShape> makeSceneShape(const bake::TriangleMesh& mesh);

/// A movable object: convex pieces with mass.
struct ObjectSource {
  /// In the object's frame, meters; at least one piece of at least four points.
  std::vector<HullPoints> hulls;
  /// Kilograms, of even density.
  double mass = 0.5;
  /// Of the surface; none: that of the world.
  std::optional<double> friction = {};
};
class ObjectShape;
[[nodiscard]] std::shared_ptr<const ObjectShape> makeObjectShape(const ObjectSource& source);

/// The hulls of a robot's links.
class RobotShape;
[[nodiscard]] std::shared_ptr<const RobotShape> makeRobotShape(const RobotParts& parts);

/// How the joints follow what the actions ask for.
enum class ArmDrive : std::uint8_t {
  kMotors,     ///< Position motors move bodies with mass.
  kKinematic,  ///< The joints are where they are asked to be.
};

inline constexpr std::array<std::string_view, 2> kArmDriveNames{"motors", "kinematic"};

/// How the base follows what the actions ask for.
enum class BaseDrive : std::uint8_t {
  kKinematic,  ///< It drives and turns as far as it is asked to, at once.
  kVelocity,   ///< Its speeds follow those that it is asked for.
};
inline constexpr std::array<std::string_view, 2> kBaseDriveNames{"kinematic", "velocity"};

/// The numbers are those of Habitat 2.0 (Szot et al. 2021, section 4) where it has any.
struct WorldOptions {
  ArmDrive arm = ArmDrive::kMotors;
  BaseDrive base = BaseDrive::kKinematic;
  /// With BaseDrive::kVelocity: the share of the speeds' errors that is gone after each substep.
  double base_gain = 0.3;
  /// Share of the position's and of the speed's error that a motor takes away in each substep, and
  /// the most impulse that it gives, N s or N m s.
  double position_gain = 0.3;
  double velocity_gain = 0.3;
  double most_impulse = 10;
  /// Of one control step, and their length in seconds.
  std::uint32_t substeps = 4;
  double substep = 1.0 / 120;
  /// Of every surface that has none of its own; that of a pair is the product.
  double friction = 0.8;
  /// Down, m/s^2.
  double gravity = 9.81;
};

/// A robot for a world.
struct RobotSetup {
  /// Must outlive the world.
  const Robot& robot;
  std::shared_ptr<const RobotShape> shape;
  std::span<const RobotBody> bodies;
  Pose world_from_root;
  std::span<const float> positions;
};

/// The world frame, meters.
struct PlacedObject {
  std::shared_ptr<const ObjectShape> shape;
  Pose world_from_object;
};

/// On the way from one pose to the other: `share` of it, 0 to 1.
[[nodiscard]] Pose between(const Pose& from, const Pose& to, float share);

/// One home with gravity: the scene does not move, objects are rigid bodies, the robot's base goes
/// where it is told and its arm is driven. Deterministic: what it does depends on the calls only.
/// Not safe to use from several threads; several worlds are.
class DynamicsWorld {
 public:
  DynamicsWorld(std::shared_ptr<const SceneShape> scene, std::span<const PlacedObject> objects,
                const WorldOptions& options);
  ~DynamicsWorld();
  DynamicsWorld(DynamicsWorld&&) noexcept;
  DynamicsWorld& operator=(DynamicsWorld&&) = delete;
  DynamicsWorld(const DynamicsWorld&) = delete;
  DynamicsWorld& operator=(const DynamicsWorld&) = delete;

  /// Once at most.
  void addRobot(const RobotSetup& setup);

  /// Where the root is to be, and what the joint positions are to be, at the end of the next step.
  /// The base gets there in equal parts; motors may take longer.
  void drive(const Pose& world_from_root, std::span<const float> positions);
  /// One control step.
  void step();

  [[nodiscard]] Pose worldFromRoot() const;
  [[nodiscard]] const WorldOptions& options() const;
  /// One per position of the robot. Those of unmoved joints stay as they were given.
  [[nodiscard]] std::vector<float> positions() const;
  [[nodiscard]] Pose objectPose(std::size_t object) const;
  /// m/s and rad/s, world frame; about the center of mass.
  [[nodiscard]] Vec3 objectVelocity(std::size_t object) const;
  /// Kinetic and potential energy of the robot's bodies, joules.
  [[nodiscard]] double robotEnergy() const;

  /// The object that is nearest to the middle of the sphere, of those that touch it.
  [[nodiscard]] std::optional<std::size_t> objectWithin(const Vec3& center, float radius) const;
  /// Holds the object where it is, against the link. Nothing may be held.
  void grasp(std::size_t object, std::uint32_t link);
  /// Lets go. Something must be held.
  void release();
  [[nodiscard]] std::optional<std::size_t> held() const;
  /// Lets an object that is not held rest as it is until something comes near it.
  void sleep(std::size_t object);

  /// How deep the base's hulls would be in the scene with the root there, meters, and the way out
  /// along the ground. The ground under `ground_height` does not count.
  struct BaseContact {
    float depth = 0;
    Vec3 away;
  };
  [[nodiscard]] BaseContact baseContact(const Pose& world_from_root, float ground_height) const;
  /// Height of the scene under `from`, at most `depth` meters below it.
  [[nodiscard]] std::optional<float> floorBelow(const Vec3& from, float depth) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// A link of the robot in something.
struct RobotContact {
  std::uint32_t link = 0;
  /// Index of an object; -1 for the scene.
  std::int32_t object = -1;
  /// Meters, > 0 where they overlap.
  float depth = 0;
  /// World frame.
  Vec3 point;
  /// Unit vector out of the thing, world frame.
  Vec3 away;
  /// The point of the robot that is deepest in the thing, world frame.
  Vec3 on_robot;
};

/// Whether a contact is with the ground, which carries the base and does not stop it: low (`point`
/// is under `height`) and from below.
[[nodiscard]] constexpr bool isGround(const Vec3& point, const Vec3& away, float height) {
  constexpr float kSteepest = 0.7F;
  return point.y < height && away.y > kSteepest;
}

/// Says what a robot would touch in a pose that may be anything: geometry, without motion.
class ContactProbe {
 public:
  ContactProbe(std::shared_ptr<const SceneShape> scene, std::span<const PlacedObject> objects,
               const RobotSetup& setup);
  ~ContactProbe();
  ContactProbe(ContactProbe&&) noexcept;
  ContactProbe& operator=(ContactProbe&&) = delete;
  ContactProbe(const ContactProbe&) = delete;
  ContactProbe& operator=(const ContactProbe&) = delete;

  void moveObject(std::size_t object, const Pose& world_from_object);
  /// The deepest contact of each pair of a link and a thing that overlap, by link, then by thing.
  /// `ignored`: an object that does not count, as one that is held.
  [[nodiscard]] std::vector<RobotContact> contacts(const Pose& world_from_root,
                                                   std::span<const float> positions,
                                                   std::optional<std::size_t> ignored) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic::dynamics
