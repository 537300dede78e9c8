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

// The dynamics world. Its implementation with Bullet is in bullet/.

/// A scene's triangles with a tree over them. Immutable: worlds on several threads share it.
class SceneShape;
[[nodiscard]] std::shared_ptr<const SceneShape> makeSceneShape(const bake::TriangleMesh& mesh);

/// A movable object: convex pieces with mass.
struct ObjectSource {
  /// In the object's frame, meters; at least one piece of at least four points.
  std::vector<HullPoints> hulls;
  /// Kilograms, evenly distributed.
  double mass = 0.5;
  /// Friction of the surface; none: that of the world.
  std::optional<double> friction = {};
};
class ObjectShape;
[[nodiscard]] std::shared_ptr<const ObjectShape> makeObjectShape(const ObjectSource& source);

/// The hulls of a robot's links.
class RobotShape;
[[nodiscard]] std::shared_ptr<const RobotShape> makeRobotShape(const RobotParts& parts);

/// How the joints follow the actions.
enum class ArmDrive : std::uint8_t {
  kMotors,     ///< Position motors move bodies with mass.
  kKinematic,  ///< The joints are always at their targets.
};

inline constexpr std::array<std::string_view, 2> kArmDriveNames{"motors", "kinematic"};

/// How the base follows the actions.
enum class BaseDrive : std::uint8_t {
  kKinematic,  ///< Drives and turns exactly as far as the actions say.
  kVelocity,   ///< Its speeds approach those that the actions ask for.
};
inline constexpr std::array<std::string_view, 2> kBaseDriveNames{"kinematic", "velocity"};

/// Options of a dynamics world. Defaults are from Habitat 2.0 (Szot et al. 2021, section 4) if it
/// states them.
struct WorldOptions {
  ArmDrive arm = ArmDrive::kMotors;
  BaseDrive base = BaseDrive::kKinematic;
  /// With BaseDrive::kVelocity: the share of the speed error that each substep removes.
  double base_gain = 0.3;
  /// Shares of the position error and the speed error that a motor removes in each substep, and its
  /// largest impulse, N s or N m s.
  double position_gain = 0.3;
  double velocity_gain = 0.3;
  double most_impulse = 10;
  /// The number of substeps in a control step, and their length in seconds.
  std::uint32_t substeps = 4;
  double substep = 1.0 / 120;
  /// Friction of every surface that has none of its own; the friction of a pair is the product.
  double friction = 0.8;
  /// Down, m/s^2.
  double gravity = 9.81;
};

/// A robot to be added to a world.
struct RobotSetup {
  /// Must outlive the world.
  const Robot& robot;
  std::shared_ptr<const RobotShape> shape;
  std::span<const RobotBody> bodies;
  Pose world_from_root;
  std::span<const float> positions;
};

/// An object and its pose in the world frame, meters.
struct PlacedObject {
  std::shared_ptr<const ObjectShape> shape;
  Pose world_from_object;
};

/// Interpolates between two poses: `share` of the way, 0 to 1.
[[nodiscard]] Pose between(const Pose& from, const Pose& to, float share);

/// One home with gravity: the scene does not move, objects are rigid bodies, the robot's base is
/// placed and its arm is driven. Deterministic: the result depends only on the calls. A world is
/// not thread-safe, but threads may use different worlds.
class DynamicsWorld {
 public:
  DynamicsWorld(std::shared_ptr<const SceneShape> scene, std::span<const PlacedObject> objects,
                const WorldOptions& options);
  ~DynamicsWorld();
  DynamicsWorld(DynamicsWorld&&) noexcept;
  DynamicsWorld& operator=(DynamicsWorld&&) = delete;
  DynamicsWorld(const DynamicsWorld&) = delete;
  DynamicsWorld& operator=(const DynamicsWorld&) = delete;

  /// At most once.
  void addRobot(const RobotSetup& setup);

  /// Sets the targets of the root and of the joint positions for the end of the next step. The base
  /// gets there in equal parts; motors may take longer.
  void drive(const Pose& world_from_root, std::span<const float> positions);
  /// One control step.
  void step();

  [[nodiscard]] Pose worldFromRoot() const;
  [[nodiscard]] const WorldOptions& options() const;
  /// One per position of the robot. Joints that actions do not move keep their initial positions.
  [[nodiscard]] std::vector<float> positions() const;
  [[nodiscard]] Pose objectPose(std::size_t object) const;
  /// m/s and rad/s, world frame; about the center of mass.
  [[nodiscard]] Vec3 objectVelocity(std::size_t object) const;
  /// Kinetic and potential energy of the robot's bodies, joules.
  [[nodiscard]] double robotEnergy() const;

  /// Of the objects that touch a sphere, the one nearest to its center.
  [[nodiscard]] std::optional<std::size_t> objectWithin(const Vec3& center, float radius) const;
  /// Fixes the object to the link where it is. The hand must be empty.
  void grasp(std::size_t object, std::uint32_t link);
  /// Releases the held object. Something must be held.
  void release();
  [[nodiscard]] std::optional<std::size_t> held() const;
  /// Puts an object that is not held to sleep: it rests until something comes near it.
  void sleep(std::size_t object);

  /// How deep the base's hulls would penetrate the scene with the root at a pose, meters, and the
  /// direction out. Contacts with the ground under `ground_height` do not count.
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

/// A link of the robot that overlaps something.
struct RobotContact {
  std::uint32_t link = 0;
  /// Index of an object; -1 for the scene.
  std::int32_t object = -1;
  /// Meters, > 0 where they overlap.
  float depth = 0;
  /// World frame.
  Vec3 point;
  /// Unit vector pointing out of the thing, world frame.
  Vec3 away;
  /// The point of the robot that is deepest in the thing, world frame.
  Vec3 on_robot;
};

/// Whether a contact is with the ground, which carries the base and does not stop it: it is low
/// (`point` is under `height`) and comes from below.
[[nodiscard]] constexpr bool isGround(const Vec3& point, const Vec3& away, float height) {
  constexpr float kSteepest = 0.7F;
  return point.y < height && away.y > kSteepest;
}

/// Finds what a robot would touch in any pose: pure geometry, without motion.
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
  /// The deepest contact of each overlapping pair of a link and a thing, ordered by link, then by
  /// thing. `ignored`: an object that does not count, such as a held one.
  [[nodiscard]] std::vector<RobotContact> contacts(const Pose& world_from_root,
                                                   std::span<const float> positions,
                                                   std::optional<std::size_t> ignored) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace galactic::dynamics
