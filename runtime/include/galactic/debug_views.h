#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "galactic/batch_renderer.h"
#include "galactic/batch_simulator.h"
#include "galactic/debug_models.h"
#include "galactic/world_views.h"

namespace galactic {

/// The debug view of the first envs of a batch: WorldViews of what the simulation knows.
class DebugViews {
 public:
  /// `world` and `models` must outlive the views. `simulator` must have been made with
  /// SimulationOptions::body_transforms. Of the first `envs` envs, at most all.
  DebugViews(const World& world, const DebugModels& models, const BatchSimulator& simulator,
             const CameraMount& camera, std::size_t envs);

  /// Copies the state after the last step. Does not allocate.
  void update(const BatchSimulator& simulator) noexcept;

  /// Of the last update. Shape: envs.
  [[nodiscard]] std::span<const RenderView> views() const { return views_; }

 private:
  /// A sphere of the robot on the body that carries it.
  struct PlacedSphere {
    std::uint32_t model = 0;
    std::size_t body = 0;
    Vec3 center;
  };

  void updateEnv(const BatchSimulator& simulator, std::size_t env) noexcept;

  const World* world_;
  const DebugModels* models_;
  MountedCamera camera_;
  std::vector<PlacedSphere> spheres_;
  /// Room for the instances of one env.
  std::size_t stride_ = 0;
  std::vector<RenderInstance> instances_;
  std::vector<RenderView> views_;
};

}  // namespace galactic
