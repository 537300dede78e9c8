#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/pose.h"
#include "galactic/robot.h"
#include "galactic/sensor_noise.h"
#include "galactic/world_models.h"

namespace galactic {

/// What a camera moves with.
enum class CameraFrame : std::uint8_t {
  kLink,   ///< A link of the robot.
  kBase,   ///< The robot's base: on the floor under the root, turned by the yaw.
  kWorld,  ///< Nothing.
};

/// Where every env's camera is: mounted on its robot, or standing in the world.
struct CameraMount {
  CameraFrame frame = CameraFrame::kLink;
  /// For kLink: index into Robot::links().
  std::uint32_t link = 0;
  /// For kLink and kBase. The camera looks along +X of its own frame, +Y is up in the image.
  Pose frame_from_camera;
  /// For kWorld: one for all envs, or one for each.
  std::vector<RigidTransform> world_from_camera = {};
  /// Radians between the lower and the upper edge of the image.
  float vertical_fov = 1.57079633F;
  /// For kBase: the camera turns about the robot, or comes nearer, where something of the scene
  /// stands between the two, as the column grids can tell.
  bool keeps_sight = false;
  /// How far it may be from all of this.
  CameraJitter jitter = {};
  /// NoiseSource::camera: cameras with the same number have the same jitter and noise. For kWorld,
  /// those that also stand in the same place.
  std::uint64_t number = 0;
};

/// The camera of the robot's recipe; none when it has none.
[[nodiscard]] std::optional<CameraMount> robotCamera(const Robot& robot);

/// The camera of each env of a batch.
class MountedCamera {
 public:
  /// Throws ErrorException with kInvalidInput where the robot has no link CameraMount::link, and
  /// for CameraMount::world_from_camera as place() does.
  MountedCamera(const BatchSimulator& simulator, const CameraMount& mount);

  /// Has cameras of CameraFrame::kWorld stand elsewhere: one place for all envs, or one for each.
  /// Throws ErrorException with kInvalidInput for cameras on the robot, for other numbers of
  /// places, and for those that checkPlaces() refuses; then they stay where they are.
  void place(std::span<const RigidTransform> world_from_camera);

  /// Of the env with the number `env`. `bodies`: its BatchSimulator::bodyTransforms(); it is in
  /// World::scenes()[scene]; `moment`: its BatchSimulator::envMoment(). Made for each env and
  /// image, and so not checked.
  [[nodiscard]] RenderCamera at(std::size_t env, std::span<const RigidTransform> bodies,
                                std::uint32_t scene, const EnvMoment& moment) const noexcept;
  /// What the noise of the env's images follows from: NoiseSource::camera.
  [[nodiscard]] std::uint64_t number(std::size_t env) const {
    return numbers_[numbers_.size() == 1 ? 0 : env];
  }

 private:
  [[nodiscard]] RigidTransform withoutJitter(std::size_t env,
                                             std::span<const RigidTransform> bodies,
                                             std::uint32_t scene) const noexcept;

  World world_;
  CameraFrame frame_;
  bool keeps_sight_;
  /// The camera's link; the root for kBase.
  LinkOnBody on_body_;
  RigidTransform frame_from_camera_;
  std::size_t env_count_;
  /// For kWorld: one, or one for each env.
  std::vector<RigidTransform> world_from_camera_;
  float vertical_fov_;
  /// Of the root link above the floor, meters.
  float root_height_;
  CameraJitter jitter_;
  /// CameraMount::number.
  std::uint64_t number_;
  /// As many as world_from_camera_, or one.
  std::vector<std::uint64_t> numbers_;
};

/// What the semantic ids of objects tell apart.
enum class ObjectIds : std::uint8_t {
  kNames,    ///< Objects of one name have one id: an index into RenderLibrary::semanticNames().
  kObjects,  ///< Object n of an env has the id n above all of these.
};

/// What is seen of a world, and as what.
struct ViewContent {
  ObjectIds ids = ObjectIds::kNames;
  /// Whether the robot is there to be seen; what it holds is, in any case.
  bool robot = true;
};

/// What the cameras of a batch see: one view per env, filled from the simulator's state and valid
/// while that changes, so that a renderer can draw one step while the next is simulated. Movable.
class WorldViews {
 public:
  /// Throws ErrorException with kInvalidInput where `models` are not of the simulator's world
  /// (World::hash()), where the simulator was made without SimulationOptions::body_transforms,
  /// where MountedCamera does, and between its beginStep() and endStep().
  WorldViews(const WorldModels& models, const BatchSimulator& simulator, const CameraMount& camera,
             const ViewContent& content = {});

  WorldViews(const WorldViews&) = delete;
  WorldViews& operator=(const WorldViews&) = delete;
  WorldViews(WorldViews&&) noexcept = default;
  WorldViews& operator=(WorldViews&&) noexcept = default;

  /// Copies the state after the last step of the simulator that the views were made for, or of
  /// another one of the same world. Does not allocate. Throws ErrorException with kInvalidInput on
  /// a simulator of another world, of fewer envs or without body transforms, and between
  /// beginStep() and endStep().
  void update(const BatchSimulator& simulator);

  /// MountedCamera::place(). Views show it after the next update.
  void placeCamera(std::span<const RigidTransform> world_from_camera) {
    camera_.place(world_from_camera);
  }

  /// As of the last update. Shape: envs.
  [[nodiscard]] std::span<const RenderView> views() const { return views_; }

 private:
  void updateEnv(const BatchSimulator& simulator, std::size_t env) noexcept;

  WorldModels models_;
  MountedCamera camera_;
  /// By scene: its model, if it has one.
  std::vector<std::vector<RenderInstance>> scenes_;
  /// Of all views.
  std::vector<AttachedModel> links_;
  /// Room for the objects of one env.
  std::size_t stride_ = 0;
  std::vector<PosedModel> posed_;
  /// Their ids; empty with ObjectIds::kNames.
  std::vector<std::uint32_t> posed_semantics_;
  /// Shape: envs * bodies of the simulator.
  std::vector<RigidTransform> bodies_;
  std::vector<RenderView> views_;
};

/// A camera and what is cut off in front of it.
struct ChosenCamera {
  CameraMount mount;
  /// Meters.
  float near = 0.05F;
};

/// What errors call the options of a CameraWish.
struct CameraOptionNames {
  std::string camera = "--camera";
  std::string fov = "--fov";
  std::string position = "--camera-position";
  std::string rpy = "--camera-rpy";
  std::string places = "world_from_camera";
  std::string near = "--near";
  std::string jitter = "--camera-jitter";
  std::string jitter_degrees = "--camera-jitter-degrees";
  std::string jitter_fov = "--camera-jitter-fov";
};

/// A camera as a user asks for it.
struct CameraWish {
  /// "head": that of the robot's recipe. "follow": behind and above the base, moved to where
  /// nothing stands between. "top": straight down on the base; what is higher than a robot is cut
  /// off, ceilings above all. Or a link of the robot ("NAME", or "link:NAME" where it has one of
  /// these names), looking along its +X. Empty with world_from_camera.
  std::string name;
  /// Between the lower and the upper edge, kLeastFovDegrees to kMostFovDegrees; 0: what belongs to
  /// the camera.
  float fov_degrees = 0;
  /// Where it is, seen from where that camera or link has it: meters ahead, to the left and up, as
  /// in a robot's recipe.
  std::array<float, 3> position{};
  /// How it is turned there, degrees: roll, pitch (down is positive), yaw, each -360 to 360.
  std::array<float, 3> rpy_degrees{};
  /// Where it stands in the world, instead of on the robot: one place for all envs, or one for
  /// each. `position` and `rpy_degrees` are 0 then, and its own field of view is 90 degrees.
  std::vector<RigidTransform> world_from_camera = {};
  /// Meters in front of it that are cut off, kLeastNear to kMostNear; 0: what belongs to the
  /// camera.
  float near = 0;
  /// How far it may be from there. Its field of view stays kLeastFovDegrees to kMostFovDegrees.
  CameraJitter jitter = {};
  CameraOptionNames options = {};
};
/// Narrower views than these show next to nothing, wider ones little but their edges.
inline constexpr float kLeastFovDegrees = 1;
inline constexpr float kMostFovDegrees = 175;
/// Of camera positions, in any direction, meters.
inline constexpr float kFarthestCamera = 100;
/// Of roll, pitch and yaw, either way, degrees.
inline constexpr float kMostCameraTurn = 360;
/// Of cameras that stand in the world, from its origin along each axis, meters.
inline constexpr float kFarthestPlace = 10000;
/// How far the products of a camera's axes may be from those of a rotation's, 0 and 1: what poses
/// lose that are written with four digits.
inline constexpr float kMostSkew = 1e-3F;
inline constexpr float kLeastNear = 0.01F;
inline constexpr float kMostNear = 100;

/// Fails with kInvalidInput, and says `where`, when one of the places is no rigid transform, which
/// is off by up to kMostSkew, or mirrored, or farther away than kFarthestPlace, or not finite.
[[nodiscard]] Result<void> checkPlaces(const std::string& where,
                                       std::span<const RigidTransform> world_from_camera);

/// Fails with kInvalidInput when the robot has no such link, or its recipe no camera, when a number
/// is out of range, when checkPlaces() does, and for a camera both on the robot and in the world.
[[nodiscard]] Result<ChosenCamera> chooseCamera(const Robot& robot, const CameraWish& wish);

}  // namespace galactic
