#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/kinematics.h"
#include "galactic/world_views.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/small_home_models.h"

namespace galactic::test {

/// Floats along chains of five links, meters from the origin.
inline constexpr float kPlaceTolerance = 1e-5F;

inline float farApart(const Vec3& a, const Vec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

/// Of axes and origin.
inline float difference(const RigidTransform& a, const RigidTransform& b) {
  return std::max({farApart(a.x_axis, b.x_axis), farApart(a.y_axis, b.y_axis),
                   farApart(a.z_axis, b.z_axis), farApart(a.origin, b.origin)});
}

/// The small home with models, and envs that carry its objects about.
class ViewedHome : public testing::Test {
 protected:
  static constexpr std::uint32_t kEnvs = 3;

  void SetUp() override { open({.safe_drop = true}); }

  struct HomeOptions {
    bool safe_drop = true;
    bool distractors = true;
  };

  void open(const HomeOptions& home) {
    const std::filesystem::path path = writeWorld(folder_, smallHomeWorldWithModels());
    Result<World> world = World::open(std::span(&path, 1));
    ASSERT_TRUE(world) << world.error().text();
    world_ = std::make_unique<World>(std::move(*world));
    Result<WorldModels> models = WorldModels::from(*world_);
    ASSERT_TRUE(models) << models.error().message;
    models_ = std::make_unique<WorldModels>(std::move(*models));
    SimulationOptions options;
    options.envs = kEnvs;
    options.threads = 1;
    options.order = EpisodeOrder::kLinear;
    options.body_transforms = true;
    options.task.drop_fails = !home.safe_drop;
    options.task.distractors = home.distractors;
    Result<BatchSimulator> simulator = BatchSimulator::create(*world_, options);
    ASSERT_TRUE(simulator) << simulator.error().message;
    simulator_ = std::make_unique<BatchSimulator>(std::move(*simulator));
  }

  /// One step of each env towards its goal.
  void step() {
    std::vector<float> actions;
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const SmallHomeRow row = solve(simulator_->envState(env));
      actions.insert(actions.end(), row.begin(), row.end());
    }
    simulator_->step(actions);
  }

  /// world_from_link of all links of an env.
  [[nodiscard]] std::vector<Pose> links(std::size_t env) const {
    const EnvState state = simulator_->envState(env);
    std::vector<Pose> links(world_->robot().links().size());
    forwardKinematics(world_->robot().links(), state.world_from_root, state.joint_positions, links);
    return links;
  }

  [[nodiscard]] std::uint32_t objectModel(std::size_t env, std::size_t number) const {
    const EnvObjects objects = simulator_->envObjects(env);
    return models_->objectModel(objects.present.placements[number].object).value();
  }

  ScratchFolder folder_;
  std::unique_ptr<World> world_;
  std::unique_ptr<WorldModels> models_;
  std::unique_ptr<BatchSimulator> simulator_;
};

}  // namespace galactic::test
