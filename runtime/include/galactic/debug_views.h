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
  /// Whose column grid is shown, meters, one of the world's radii; 0: the smallest.
  float radius = 0;
};

/// A color of the debug view: RGBA, R lowest, and what has it.
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
  kHeld,   ///< Blue: of the object in the hand.
};

/// What the simulation knows of a world, as models to draw (paper, figures 3 and 13): the free
/// space of the column grid as gray floors, walls and ceilings, seen from inside; spheres of each
/// radius; the oriented box of each object in orange, that of a target in magenta; its edges alone,
/// for a goal. Immutable, so safe to share between threads. Copies are cheap and share one content.
/// Indices of no scene, object or radius throw ErrorException with kInvalidInput.
class DebugModels {
 public:
  /// Reads all grids of that radius. Fails with kInvalidInput when `options.radius` is none of the
  /// world's.
  [[nodiscard]] static Result<DebugModels> from(const World& world, const DebugOptions& options);

  /// World::hash() of the world.
  [[nodiscard]] std::uint64_t worldHash() const { return world_hash_; }
  [[nodiscard]] const RenderLibrary& library() const { return *library_; }
  /// The free space of a scene (index into World::scenes()), in the world's frame; none when
  /// nothing is free.
  [[nodiscard]] std::optional<std::uint32_t> sceneModel(std::uint32_t scene) const;
  /// The box of an object (index into EpisodeSet::objectNames()), in the object's frame.
  [[nodiscard]] std::uint32_t boxModel(std::uint32_t object) const;
  /// The same box in magenta: of the object that has to go to the goal.
  [[nodiscard]] std::uint32_t targetModel(std::uint32_t object) const;
  /// The same box as a frame of thin beams, magenta.
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

/// The debug view of the first envs of a batch: WorldViews of what the simulation knows. Movable.
class DebugViews {
 public:
  /// Of the first `envs` envs. Throws ErrorException with kInvalidInput where there are fewer,
  /// where `models` are not of the simulator's world (World::hash()), where the simulator was made
  /// without SimulationOptions::body_transforms, and between its beginStep() and endStep().
  DebugViews(const DebugModels& models, const BatchSimulator& simulator, const CameraMount& camera,
             std::size_t envs);

  DebugViews(const DebugViews&) = delete;
  DebugViews& operator=(const DebugViews&) = delete;
  DebugViews(DebugViews&&) noexcept = default;
  DebugViews& operator=(DebugViews&&) noexcept = default;

  /// Copies the state after the last step of the simulator that the views were made for, or of
  /// another one of the same world. Does not allocate. Throws ErrorException with kInvalidInput on
  /// a simulator of another world, of fewer envs or without body transforms, and between
  /// beginStep() and endStep().
  void update(const BatchSimulator& simulator);

  /// As of the last update. Shape: envs.
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
