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
  /// For kBase: whether the camera turns about the robot, or comes nearer, if something in the
  /// scene stands between the two, as far as the column grids show.
  bool keeps_sight = false;
  /// How far the camera may deviate from all of this.
  CameraJitter jitter = {};
  /// NoiseSource::camera: cameras with the same number have the same jitter and noise. For kWorld,
  /// those that also stand in the same place.
  std::uint64_t number = 0;
};

/// The camera of the robot's recipe, if it has one.
[[nodiscard]] std::optional<CameraMount> robotCamera(const Robot& robot);

/// The camera of each env of a batch.
class MountedCamera {
 public:
  /// Throws ErrorException with kInvalidInput if the robot has no link CameraMount::link, or if
  /// place() would refuse CameraMount::world_from_camera.
  MountedCamera(const BatchSimulator& simulator, const CameraMount& mount);

  /// Moves cameras of CameraFrame::kWorld: to one place for all envs, or one for each. Throws
  /// ErrorException with kInvalidInput for cameras on the robot, for other numbers of places, and
  /// for places that checkPlaces() refuses; the cameras then stay where they are.
  void place(std::span<const RigidTransform> world_from_camera);

  /// The camera of env number `env`. `bodies`: the env's BatchSimulator::bodyTransforms(). `scene`:
  /// the env is in World::scenes()[scene]. `moment`: its BatchSimulator::envMoment(). Called for
  /// each env and image, so nothing is checked.
  [[nodiscard]] RenderCamera at(std::size_t env, std::span<const RigidTransform> bodies,
                                std::uint32_t scene, const EnvMoment& moment) const noexcept;
  /// The NoiseSource::camera from which the noise of the env's images is derived.
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
  /// Height of the root link above the floor, meters.
  float root_height_;
  CameraJitter jitter_;
  /// CameraMount::number.
  std::uint64_t number_;
  /// As many elements as world_from_camera_, or one.
  std::vector<std::uint64_t> numbers_;
};

/// What the semantic ids of objects distinguish.
enum class ObjectIds : std::uint8_t {
  kNames,    ///< Objects of the same name have the same id: an index into
             //< RenderLibrary::semanticNames().
  kObjects,  ///< Object n of an env has the id n above all of these.
};

/// Which parts of a world are visible, and with which semantic ids.
struct ViewContent {
  ObjectIds ids = ObjectIds::kNames;
  /// Whether the robot is visible. What it holds always is.
  bool robot = true;
};

/// What the cameras of a batch see: one view per env, copied from the simulator's state. The views
/// stay valid while that state changes, so that a renderer can draw one step while the next is
/// simulated. Movable.
class WorldViews {
 public:
  /// Throws ErrorException with kInvalidInput if `models` are not of the simulator's world
  /// (World::hash()), if the simulator was created without SimulationOptions::body_transforms, if
  /// MountedCamera does, and between the simulator's beginStep() and endStep().
  WorldViews(const WorldModels& models, const BatchSimulator& simulator, const CameraMount& camera,
             const ViewContent& content = {});

  WorldViews(const WorldViews&) = delete;
  WorldViews& operator=(const WorldViews&) = delete;
  WorldViews(WorldViews&&) noexcept = default;
  WorldViews& operator=(WorldViews&&) noexcept = default;

  /// Copies the state after the last step of the simulator that the views were created for, or of
  /// another one of the same world. Does not allocate. Throws ErrorException with kInvalidInput if
  /// the simulator is of another world, has fewer envs or has no body transforms, and between
  /// beginStep() and endStep().
  void update(const BatchSimulator& simulator);

  /// MountedCamera::place(). Views show it after the next update.
  void placeCamera(std::span<const RigidTransform> world_from_camera) {
    camera_.place(world_from_camera);
  }

  /// The views as of the last update(). Shape: envs.
  [[nodiscard]] std::span<const RenderView> views() const { return views_; }

 private:
  void updateEnv(const BatchSimulator& simulator, std::size_t env) noexcept;

  WorldModels models_;
  MountedCamera camera_;
  /// For each scene its model, if it has one.
  std::vector<std::vector<RenderInstance>> scenes_;
  /// Shared by all views.
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

/// A camera and the distance of its near clipping plane.
struct ChosenCamera {
  CameraMount mount;
  /// Meters.
  float near = 0.05F;
};

/// The names that error messages use for the options of a CameraWish.
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

/// A camera as a user describes it.
struct CameraWish {
  /// "head": the camera of the robot's recipe. "follow": behind and above the base, moved to where
  /// nothing blocks its view of the robot. "top": straight down on the base; everything higher than
  /// a robot is cut off, such as ceilings. Or a link of the robot ("NAME", or "link:NAME" if the
  /// link has one of these names), looking along the link's +X. Empty with world_from_camera.
  std::string name;
  /// Field of view between the lower and the upper edge of the image, degrees, kLeastFovDegrees to
  /// kMostFovDegrees; 0: the camera's default.
  float fov_degrees = 0;
  /// Its position relative to that camera or link: meters ahead, to the left and up, as in a
  /// robot's recipe.
  std::array<float, 3> position{};
  /// Its rotation there, degrees: roll, pitch (down is positive), yaw, each -360 to 360.
  std::array<float, 3> rpy_degrees{};
  /// Where it stands in the world, instead of on the robot: one place for all envs, or one for
  /// each. `position` and `rpy_degrees` must then be 0, and the default field of view is 90
  /// degrees.
  std::vector<RigidTransform> world_from_camera = {};
  /// Distance of the near clipping plane, meters, kLeastNear to kMostNear; 0: the camera's default.
  float near = 0;
  /// How far it may deviate from this. Its field of view stays within kLeastFovDegrees and
  /// kMostFovDegrees.
  CameraJitter jitter = {};
  CameraOptionNames options = {};
};
/// Limits of the field of view: narrower views show next to nothing, wider ones little but their
/// edges.
inline constexpr float kLeastFovDegrees = 1;
inline constexpr float kMostFovDegrees = 175;
/// Limit of camera positions in any direction, meters.
inline constexpr float kFarthestCamera = 100;
/// Limit of roll, pitch and yaw, either way, degrees.
inline constexpr float kMostCameraTurn = 360;
/// Limit of the places of cameras that stand in the world, from its origin along each axis, meters.
inline constexpr float kFarthestPlace = 10000;
/// How far the dot products of a camera's axes may be from those of a rotation's axes, 0 and 1.
/// This tolerates poses that are written with four digits.
inline constexpr float kMostSkew = 1e-3F;
inline constexpr float kLeastNear = 0.01F;
inline constexpr float kMostNear = 100;

/// Fails with kInvalidInput, with `where` in the error, if one of the places is not a rigid
/// transform to within kMostSkew, is mirrored, is farther away than kFarthestPlace, or is not
/// finite.
[[nodiscard]] Result<void> checkPlaces(const std::string& where,
                                       std::span<const RigidTransform> world_from_camera);

/// Fails with kInvalidInput if the robot has no such link, if its recipe has no camera, if a number
/// is out of range, if checkPlaces() fails, or if the camera is both on the robot and in the world.
[[nodiscard]] Result<ChosenCamera> chooseCamera(const Robot& robot, const CameraWish& wish);

}  // namespace galactic
