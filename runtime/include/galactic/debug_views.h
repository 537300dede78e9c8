#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/batch_simulator.h"
#include "galactic/error.h"
#include "galactic/render_library.h"
#include "galactic/world.h"
#include "galactic/world_views.h"

namespace galactic {

struct DebugOptions {
  /// Radius of the column grid that is shown, meters: one of the world's radii, or 0 for the
  /// smallest.
  float radius = 0;
};

/// A color of the debug view (RGBA, R in the lowest byte) and what is drawn in it.
struct DebugColor {
  std::uint32_t color = 0;
  std::string_view meaning;
};
inline constexpr DebugColor kDebugRobot{0xFF48B028, "robot"};
inline constexpr DebugColor kDebugHeld{0xFFE8742E, "held object"};
inline constexpr DebugColor kDebugObject{0xFF1482F0, "object"};
inline constexpr DebugColor kDebugTask{0xFF8C1ED6, "target, and its goal as a frame"};

/// Whose spheres are shown.
enum class DebugSpheres : std::uint8_t {
  kRobot,  ///< Green.
  kHeld,   ///< Blue: spheres of the object in the hand.
};

/// The simulation's view of a world, as models to draw (paper, figures 3 and 13): the free space of
/// the column grid as gray floors, walls and ceilings, seen from inside; spheres of each radius;
/// the oriented box of each object in orange, or in magenta if it is the target; and only the edges
/// of the box, for a goal. Immutable, so safe to share between threads. Copies are cheap and share
/// their content. Indices of scenes, objects or radii that are out of range throw ErrorException
/// with kInvalidInput.
class DebugModels {
 public:
  /// Reads all grids of that radius. Fails with kInvalidInput if `options.radius` is not one of the
  /// world's radii.
  [[nodiscard]] static Result<DebugModels> from(const World& world, const DebugOptions& options);

  /// World::hash() of the world.
  [[nodiscard]] std::uint64_t worldHash() const { return world_hash_; }
  [[nodiscard]] const RenderLibrary& library() const { return *library_; }
  /// The free space of a scene (index into World::scenes()), in the world's frame; none if nothing
  /// is free.
  [[nodiscard]] std::optional<std::uint32_t> sceneModel(std::uint32_t scene) const;
  /// The box of an object (index into EpisodeSet::objectNames()), in the object's frame.
  [[nodiscard]] std::uint32_t boxModel(std::uint32_t object) const;
  /// The same box in magenta: for the object that has to be brought to the goal.
  [[nodiscard]] std::uint32_t targetModel(std::uint32_t object) const;
  /// The same box as a magenta frame of thin beams.
  [[nodiscard]] std::uint32_t goalModel(std::uint32_t object) const;
  /// A sphere about the origin; `radius_index` counts in World::radii().
  [[nodiscard]] std::uint32_t sphereModel(DebugSpheres whose, std::uint32_t radius_index) const;

 private:
  DebugModels() = default;

  [[nodiscard]] std::uint32_t objectCount() const { return first_target_ - first_box_; }

  std::uint64_t world_hash_ = 0;
  std::shared_ptr<const RenderLibrary> library_;
  std::uint32_t first_box_ = 0;
  std::uint32_t first_target_ = 0;
  std::uint32_t first_goal_ = 0;
  std::uint32_t first_robot_sphere_ = 0;
  std::uint32_t first_held_sphere_ = 0;
};

/// The debug view of the first envs of a batch: like WorldViews, but of what the simulation knows.
/// Movable.
class DebugViews {
 public:
  /// Makes views of the first `envs` envs. Throws ErrorException with kInvalidInput if there are
  /// fewer, if `models` are not of the simulator's world (World::hash()), if the simulator was
  /// created without SimulationOptions::body_transforms, and between the simulator's beginStep()
  /// and endStep().
  DebugViews(const DebugModels& models, const BatchSimulator& simulator, const CameraMount& camera,
             std::size_t envs);

  DebugViews(const DebugViews&) = delete;
  DebugViews& operator=(const DebugViews&) = delete;
  DebugViews(DebugViews&&) noexcept = default;
  DebugViews& operator=(DebugViews&&) noexcept = default;

  /// Copies the state after the last step of the simulator that the views were created for, or of
  /// another one of the same world. Does not allocate. Throws ErrorException with kInvalidInput if
  /// the simulator is of another world, has fewer envs or has no body transforms, and between
  /// beginStep() and endStep().
  void update(const BatchSimulator& simulator);

  /// The views as of the last update(). Shape: envs.
  [[nodiscard]] std::span<const RenderView> views() const { return views_; }

 private:
  /// A sphere of the robot on the body that carries it.
  struct PlacedSphere {
    std::uint32_t model = 0;
    std::size_t body = 0;
    Vec3 center;
  };

  void updateEnv(const BatchSimulator& simulator, std::size_t env) noexcept;

  World world_;
  DebugModels models_;
  MountedCamera camera_;
  std::vector<PlacedSphere> spheres_;
  /// BatchSimulator::bodyCount().
  std::size_t body_count_ = 0;
  /// Room for the instances of one env.
  std::size_t stride_ = 0;
  std::vector<RenderInstance> instances_;
  std::vector<RenderView> views_;
};

}  // namespace galactic
