#include "galactic/world_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "galactic/batch_simulator.h"
#include "galactic/debug_views.h"
#include "galactic/planning_scene.h"
#include "render/render_engine.h"
#include "support/homes/small_home_actor.h"
#include "support/homes/small_home_models.h"
#include "viewed_home.h"

namespace galactic::world_views_test {
namespace {

using test::difference;
using test::EpisodePackFields;
using test::farApart;
using test::kPlaceTolerance;
using test::WorldFields;
using WorldViewsOfAHome = test::ViewedHome;

/// All that a view shows, as instances.
std::vector<RenderInstance> shownIn(const RenderView& view) {
  std::vector<RenderInstance> shown;
  render::forModels(
      view, [&](std::uint32_t model, const RigidTransform& world_from_model, std::uint32_t) {
        shown.push_back({model, world_from_model});
      });
  return shown;
}

TEST_F(WorldViewsOfAHome, AllThatWasMadeOfAWorldLivesOnWithoutIt) {
  const CameraMount mount = robotCamera(world_->robot()).value();
  WorldViews views(*models_, *simulator_, mount);
  DebugModels debug_models = DebugModels::from(*world_, {}).value();
  DebugViews debug_views(debug_models, *simulator_, mount, kEnvs);
  PlanningScene planning(*world_, simulator_->options());
  const auto look = [&] {
    std::vector<float> seen;
    step();
    views.update(*simulator_);
    debug_views.update(*simulator_);
    for (const RenderView& view : views.views()) {
      seen.push_back(view.camera.world_from_camera.origin.x);
      seen.push_back(static_cast<float>(view.posed.size()));
    }
    for (const RenderView& view : debug_views.views()) {
      seen.push_back(static_cast<float>(view.instances.size()));
    }
    const EnvState state = simulator_->envState(0);
    planning.update(state);
    planning.setJoints(state.joint_positions);
    seen.push_back(planning.isFree(planning.baseOf(state)) ? 1 : 0);
    seen.push_back(planning.rootFromGrip().translation.x);
    return seen;
  };
  const std::vector<std::byte> start = simulator_->saveState();
  const std::vector<float> with_world = look();
  world_.reset();
  ASSERT_TRUE(simulator_->restoreState(start));
  EXPECT_EQ(look(), with_world);
}

TEST_F(WorldViewsOfAHome, TheRobotIsLeftOutWhereNobodyWantsIt) {
  const CameraMount mount = robotCamera(world_->robot()).value();
  const WorldViews whole(*models_, *simulator_, mount);
  const WorldViews without(*models_, *simulator_, mount, {.robot = false});
  for (std::size_t env = 0; env < kEnvs; ++env) {
    EXPECT_EQ(whole.views()[env].attached.size(), models_->links().size());
    EXPECT_TRUE(without.views()[env].attached.empty());
    EXPECT_EQ(without.views()[env].posed.size(), whole.views()[env].posed.size());
    EXPECT_EQ(without.views()[env].instances.size(), 1U);
    EXPECT_EQ(test::difference(without.views()[env].camera.world_from_camera,
                               whole.views()[env].camera.world_from_camera),
              0);
  }
}

TEST_F(WorldViewsOfAHome, ObjectsHaveIdsOfTheirNamesOrOfTheirOwn) {
  const CameraMount mount = robotCamera(world_->robot()).value();
  WorldViews of_names(*models_, *simulator_, mount);
  WorldViews of_objects(*models_, *simulator_, mount, {.ids = ObjectIds::kObjects});
  const std::size_t names = models_->library().semanticNames().size();
  for (int n = 0; n < 20; ++n) {  // with one in the hand at last
    step();
    of_names.update(*simulator_);
    of_objects.update(*simulator_);
  }
  for (std::size_t env = 0; env < kEnvs; ++env) {
    const auto objects = of_objects.views()[env].posed;
    ASSERT_EQ(objects.size(), simulator_->envObjects(env).objects.size());
    for (std::size_t n = 0; n < objects.size(); ++n) {
      EXPECT_EQ(of_objects.views()[env].posed_semantics[n], names + n);
      EXPECT_EQ(objects[n].model, objectModel(env, n));
    }
    EXPECT_EQ(of_objects.views()[env].posed_semantics.size(), objects.size());
    EXPECT_TRUE(of_names.views()[env].posed_semantics.empty());
  }
}

TEST_F(WorldViewsOfAHome, SensorsHaveNumbersOfSeedEnvEpisodeAndStepOrOfANamedEpisode) {
  for (std::uint32_t n = 0; n < 3; ++n) {
    for (std::uint32_t env = 0; env < kEnvs; ++env) {
      const EnvMoment moment = simulator_->envMoment(env);
      EXPECT_EQ(moment.seed, simulator_->options().seed);
      EXPECT_EQ(moment.env, env);
      EXPECT_EQ(moment.episode, 1U);
      EXPECT_EQ(moment.step, n);
    }
    step();
  }
  const std::vector<std::byte> saved = simulator_->saveState();
  simulator_->reset(
      std::vector<std::int32_t>{BatchSimulator::kNextEpisode, 0, BatchSimulator::kStays});
  EXPECT_EQ(simulator_->envMoment(0).episode, 2U);
  EXPECT_EQ(simulator_->envMoment(0).step, 0U);
  EXPECT_EQ(simulator_->envMoment(1).episode, ~std::uint64_t{0});
  EXPECT_EQ(simulator_->envMoment(1).env, 0U);
  EXPECT_EQ(simulator_->envMoment(2).episode, 1U);
  EXPECT_EQ(simulator_->envMoment(2).step, 3U);
  ASSERT_TRUE(simulator_->restoreState(saved));
  EXPECT_EQ(simulator_->envMoment(0).episode, 1U);
  EXPECT_EQ(simulator_->envMoment(0).step, 3U);
  simulator_->restart(99);
  EXPECT_EQ(simulator_->envMoment(2).seed, 99U);
  EXPECT_EQ(simulator_->envMoment(2).step, 0U);
  SimulationOptions options = simulator_->options();
  options.rank = 2;
  options.ranks = 3;
  const Result<BatchSimulator> third = BatchSimulator::create(*world_, options);
  ASSERT_TRUE(third);
  EXPECT_EQ(third->envMoment(1).env, 2 * kEnvs + 1);
}

TEST_F(WorldViewsOfAHome, AViewHoldsTheSceneItsObjectsAndTheLinksThatShowSomething) {
  WorldViews views(*models_, *simulator_, robotCamera(world_->robot()).value());
  std::size_t with_held = 0;
  std::size_t cases = 0;
  for (int n = 0; n < 60; ++n) {
    views.update(*simulator_);
    for (std::size_t env = 0; env < kEnvs; ++env) {
      const EnvState state = simulator_->envState(env);
      const std::vector<RenderInstance> shown = shownIn(views.views()[env]);
      ASSERT_EQ(shown.size(), 1 + state.objects.size() + 2);
      EXPECT_EQ(shown[0].model, models_->sceneModel(state.scene));
      EXPECT_EQ(difference(shown[0].world_from_model, {}), 0);
      for (std::size_t object = 0; object < state.objects.size(); ++object) {
        EXPECT_EQ(shown[1 + object].model, objectModel(env, object));
        // envState() has the held object where the grip holds it.
        EXPECT_LT(
            difference(shown[1 + object].world_from_model, rigidTransform(state.objects[object])),
            kPlaceTolerance);
      }
      const std::vector<Pose> poses = links(env);
      for (std::size_t link = 0; link < 2; ++link) {
        const LinkModel& model = models_->links()[link];
        const RenderInstance& instance = shown[1 + state.objects.size() + link];
        EXPECT_EQ(instance.model, model.model);
        EXPECT_LT(difference(instance.world_from_model, rigidTransform(poses[model.link])),
                  kPlaceTolerance);
      }
      ++cases;
      with_held += state.held >= 0 ? 1 : 0;
    }
    step();
  }
  const double share = static_cast<double>(with_held) / static_cast<double>(cases);
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 0.9);
}

TEST_F(WorldViewsOfAHome, WithoutDistractorsTheTargetIsShownAndNothingElse) {
  open({.safe_drop = true, .distractors = false});
  const WorldViews views(*models_, *simulator_, robotCamera(world_->robot()).value());
  const EpisodeSet& episodes = world_->episodes();
  std::size_t not_first = 0;
  for (std::size_t env = 0; env < kEnvs; ++env) {
    const Episode& episode = episodes.episodes()[simulator_->envObjects(env).episode];
    const Placement& target = episodes.placements(episode)[episode.target];
    not_first += episode.target != 0 ? 1 : 0;
    const std::vector<RenderInstance> shown = shownIn(views.views()[env]);
    ASSERT_EQ(shown.size(), 1U + 1 + 2);
    EXPECT_EQ(shown[1].model, models_->objectModel(target.object));
    EXPECT_LT(difference(shown[1].world_from_model, rigidTransform(target.pose)), kPlaceTolerance);
  }
  EXPECT_GT(not_first, 0U);
}

TEST_F(WorldViewsOfAHome, AWorldWithoutRenderMeshesIsRefusedByItsPack) {
  const test::SmallHome bare;
  const auto models = WorldModels::from(bare.world());
  ASSERT_FALSE(models);
  EXPECT_EQ(models.error().code, ErrorCode::kInvalidInput);
  EXPECT_THAT(models.error().message, testing::HasSubstr("was baked without render meshes"));
}

TEST_F(WorldViewsOfAHome, TheDebugViewShowsSpheresBoxesAndTheGoal) {
  const auto models = DebugModels::from(*world_, {});
  ASSERT_TRUE(models) << models.error().message;
  const CameraMount mount{.frame = CameraFrame::kBase, .link = 0, .frame_from_camera = {}};
  DebugViews views(*models, *simulator_, mount, 2);
  ASSERT_EQ(views.views().size(), 2U);
  const auto find = [&](std::size_t env, std::uint32_t model) {
    std::vector<RigidTransform> places;
    for (const RenderInstance& instance : views.views()[env].instances) {
      if (instance.model == model) places.push_back(instance.world_from_model);
    }
    return places;
  };
  std::size_t held_seen = 0;
  for (int n = 0; n < 60; ++n) {
    views.update(*simulator_);
    for (std::size_t env = 0; env < 2; ++env) {
      const EnvState state = simulator_->envState(env);
      const std::vector<Pose> poses = links(env);
      const bool holds = state.held >= 0;
      ASSERT_EQ(views.views()[env].instances.size(),
                1 + state.objects.size() + 1 + world_->robot().spheres().size());
      EXPECT_EQ(find(env, models->sceneModel(0).value()).size(), 1U);
      const std::vector<RigidTransform> hand =
          find(env, models->sphereModel(DebugSpheres::kRobot, 0));
      ASSERT_EQ(hand.size(), 1U);
      EXPECT_LT(farApart(hand[0].origin, poses[4] * Vec3{0.02F, 0, 0}), kPlaceTolerance);
      // One sphere of 5 cm around the middle of the object's box.
      const auto held = find(env, models->sphereModel(DebugSpheres::kHeld, 1));
      ASSERT_EQ(held.size(), holds ? 1U : 0U);
      if (!holds) continue;
      ++held_seen;
      const Pose& object = state.objects[static_cast<std::size_t>(state.held)];
      EXPECT_LT(farApart(held[0].origin, object * Vec3{0, 0.05F, 0}), kPlaceTolerance);
    }
    step();
  }
  EXPECT_GT(held_seen, 10U);
  const EnvObjects objects = simulator_->envObjects(0);
  const Episode& episode = world_->episodes().episodes()[objects.episode];
  const Placement& target = world_->episodes().placements(episode)[episode.target];
  views.update(*simulator_);
  // The target is told apart from all other objects, unless the hand has it.
  const bool is_resting = objects.held != static_cast<std::int32_t>(episode.target);
  const auto resting = find(0, models->targetModel(target.object));
  ASSERT_EQ(resting.size(), is_resting ? 1U : 0U);
  if (is_resting) {
    EXPECT_EQ(difference(resting[0], rigidTransform(objects.objects[episode.target])), 0);
  }
  const auto goal = find(0, models->goalModel(target.object));
  ASSERT_EQ(goal.size(), 1U);
  EXPECT_EQ(difference(goal[0], rigidTransform(episode.goal)), 0);
}

/// What a function that makes all of it hands out.
struct Drawing {
  BatchRenderer renderer;
  WorldViews views;
  DebugViews debug_views;
  BatchRenderer debug_renderer;
};

TEST_F(WorldViewsOfAHome, GoOnWithoutTheModelsTheyWereMadeFromAndWhereTheyAreMovedTo) {
  const CameraMount mount = robotCamera(world_->robot()).value();
  const RenderOptions options{.width = 32, .height = 32, .backend = RenderBackend::kSoft};
  const auto make = [&] {
    const WorldModels models = WorldModels::from(*world_).value();
    const DebugModels debug_models = DebugModels::from(*world_, {}).value();
    return Drawing{BatchRenderer::create(models.library(), options).value(),
                   WorldViews(models, *simulator_, mount),
                   DebugViews(debug_models, *simulator_, mount, kEnvs),
                   BatchRenderer::create(debug_models.library(), options).value()};
  };
  const auto drawn = [&](BatchRenderer& renderer, std::span<const RenderView> views) {
    std::vector<std::uint8_t> color(std::size_t{kEnvs} * 32 * 32 * 4);
    std::vector<float> depth(std::size_t{kEnvs} * 32 * 32);
    renderer.render(views, {.color = color, .depth = depth});
    return std::pair(color, depth);
  };
  Drawing made = make();
  Drawing moved = std::move(made);
  step();
  moved.views.update(*simulator_);
  moved.debug_views.update(*simulator_);
  WorldViews views(*models_, *simulator_, mount);
  BatchRenderer renderer = BatchRenderer::create(models_->library(), options).value();
  EXPECT_EQ(drawn(moved.renderer, moved.views.views()), drawn(renderer, views.views()));
  const DebugModels debug_models = DebugModels::from(*world_, {}).value();
  DebugViews debug_views(debug_models, *simulator_, mount, kEnvs);
  BatchRenderer debug_renderer = BatchRenderer::create(debug_models.library(), options).value();
  EXPECT_EQ(drawn(moved.debug_renderer, moved.debug_views.views()),
            drawn(debug_renderer, debug_views.views()));
}

TEST_F(WorldViewsOfAHome, AreNotMadeOfASimulatorThatKeepsNoBodiesNorFollowAnother) {
  const CameraMount mount = robotCamera(world_->robot()).value();
  SimulationOptions options = simulator_->options();
  options.body_transforms = false;
  const BatchSimulator bare = BatchSimulator::create(*world_, options).value();
  options.body_transforms = true;
  options.envs = kEnvs - 1;
  const BatchSimulator smaller = BatchSimulator::create(*world_, options).value();
  const DebugModels debug_models = DebugModels::from(*world_, {}).value();
  EXPECT_THAT([&] { WorldViews(*models_, bare, mount); },
              testing::ThrowsMessage<ErrorException>(
                  testing::HasSubstr("make it with SimulationOptions::body_transforms")));
  EXPECT_THROW(DebugViews(debug_models, bare, mount, 1), ErrorException);
  EXPECT_THAT([&] { DebugViews(debug_models, *simulator_, mount, kEnvs + 1); },
              testing::ThrowsMessage<ErrorException>(testing::StrEq(
                  "DebugViews: found 4 envs to show, expected at most the simulator's 3")));
  WorldViews views(*models_, *simulator_, mount);
  DebugViews debug_views(debug_models, *simulator_, mount, kEnvs);
  EXPECT_THAT([&] { views.update(smaller); },
              testing::ThrowsMessage<ErrorException>(
                  testing::StrEq("WorldViews::update: found a simulator of 2 envs, expected at "
                                 "least the 3 that the views were made for")));
  EXPECT_THROW(views.update(bare), ErrorException);
  EXPECT_THROW(debug_views.update(smaller), ErrorException);
  views.update(*simulator_);
}

/// A home with the same robot, whose episodes have one object each.
WorldFields emptierHome() {
  WorldFields fields = test::smallHomeWorldWithModels();
  EpisodePackFields& episodes = fields.episodes;
  episodes.episodes.resize(1);
  episodes.episodes[0].target = 0;
  episodes.episodes[0].placement_count = 1;
  episodes.placements.resize(1);
  episodes.start_positions.resize(2);
  return fields;
}

TEST_F(WorldViewsOfAHome, AreMadeOfOneWorldAndFollowItAlone) {
  const test::SmallHome emptier(emptierHome());
  const World& other = emptier.world();
  ASSERT_LT(other.mostObjects(), world_->mostObjects());
  const WorldModels other_models = WorldModels::from(other).value();
  const BatchSimulator other_simulator =
      BatchSimulator::create(other, simulator_->options()).value();
  ASSERT_EQ(other_simulator.bodyCount(), simulator_->bodyCount());
  const DebugModels debug_models = DebugModels::from(*world_, {}).value();
  const DebugModels other_debug_models = DebugModels::from(other, {}).value();
  const CameraMount mount = robotCamera(world_->robot()).value();
  const auto refused = [](const auto& call, const std::string& message) {
    EXPECT_THAT(call, testing::ThrowsMessage<ErrorException>(testing::StartsWith(message)));
  };
  const std::string of_models = ": found models of another world than that of the simulator";
  refused([&] { WorldViews(other_models, *simulator_, mount); }, "WorldViews" + of_models);
  refused([&] { DebugViews(other_debug_models, *simulator_, mount, 1); }, "DebugViews" + of_models);
  refused([&] { MountedCamera(*simulator_, {.link = 99, .frame_from_camera = {}}); },
          "BatchSimulator::linkOnBody: found link 99");
  const std::string of_views =
      "::update: found a simulator of another world than the one that the views were made of";
  WorldViews views(other_models, other_simulator, mount);
  DebugViews debug_views(other_debug_models, other_simulator, mount, kEnvs);
  refused([&] { views.update(*simulator_); }, "WorldViews" + of_views);
  refused([&] { debug_views.update(*simulator_); }, "DebugViews" + of_views);
  EXPECT_EQ(views.views()[0].posed.size(), 1U);

  // The same packs, opened again.
  const std::filesystem::path path = folder_.path() / "world.pack";
  const World again = World::open(std::span(&path, 1)).value();
  BatchSimulator simulator = BatchSimulator::create(again, simulator_->options()).value();
  WorldViews views_of_all(*models_, simulator, mount);
  DebugViews debug_views_of_all(debug_models, simulator, mount, kEnvs);
  simulator.step(std::vector<float>(kEnvs * simulator.actionCount(), 1));
  views_of_all.update(simulator);
  debug_views_of_all.update(simulator);
  EXPECT_EQ(difference(views_of_all.views()[0].camera.world_from_camera,
                       debug_views_of_all.views()[0].camera.world_from_camera),
            0);
}

TEST_F(WorldViewsOfAHome, ReadNoStepThatHasNotEnded) {
  const CameraMount mount = robotCamera(world_->robot()).value();
  const DebugModels debug_models = DebugModels::from(*world_, {}).value();
  WorldViews views(*models_, *simulator_, mount);
  DebugViews debug_views(debug_models, *simulator_, mount, kEnvs);
  const std::vector<float> actions(kEnvs * simulator_->actionCount());
  simulator_->beginStep(actions);
  const auto refused = [](const auto& call, const std::string& name) {
    EXPECT_THAT(call, testing::ThrowsMessage<ErrorException>(testing::StrEq(
                          name + ": found a step that has begun; end it first, with endStep()")));
  };
  refused([&] { WorldViews(*models_, *simulator_, mount); }, "WorldViews");
  refused([&] { DebugViews(debug_models, *simulator_, mount, 1); }, "DebugViews");
  refused([&] { views.update(*simulator_); }, "WorldViews::update");
  refused([&] { debug_views.update(*simulator_); }, "DebugViews::update");
  simulator_->endStep();
  views.update(*simulator_);
  debug_views.update(*simulator_);
  EXPECT_EQ(views.views()[0].noise.moment.step, 1U);
}

TEST_F(WorldViewsOfAHome, HaveNoModelsOfWhatTheWorldDoesNotHave) {
  const DebugModels models = DebugModels::from(*world_, {}).value();
  const auto refused = [](const auto& call, const std::string& message) {
    EXPECT_THAT(call, testing::ThrowsMessage<ErrorException>(testing::StrEq(message)));
  };
  refused([&] { static_cast<void>(models.sceneModel(1)); },
          "DebugModels::sceneModel: found scene 1, expected one below 1");
  refused([&] { static_cast<void>(models.boxModel(2)); },
          "DebugModels::boxModel: found object 2, expected one below 2");
  refused([&] { static_cast<void>(models.targetModel(2)); },
          "DebugModels::targetModel: found object 2, expected one below 2");
  refused([&] { static_cast<void>(models.goalModel(~0U)); },
          "DebugModels::goalModel: found object 4294967295, expected one below 2");
  refused([&] { static_cast<void>(models.sphereModel(DebugSpheres::kHeld, 3)); },
          "DebugModels::sphereModel: found radius 3, expected one below 3");
  refused([&] { static_cast<void>(models_->sceneModel(1)); },
          "WorldModels::sceneModel: found scene 1, expected one below 1");
  refused([&] { static_cast<void>(models_->objectModel(2)); },
          "WorldModels::objectModel: found object 2, expected one below 2");
}

TEST_F(WorldViewsOfAHome, AreDrawnIntoImagesOfTheirSizeAlone) {
  const CameraMount mount = robotCamera(world_->robot()).value();
  const WorldViews views(*models_, *simulator_, mount);
  const RenderOptions options{.width = 8, .height = 4, .backend = RenderBackend::kSoft};
  BatchRenderer renderer = BatchRenderer::create(models_->library(), options).value();
  std::vector<std::uint8_t> color(std::size_t{kEnvs} * 8 * 4 * 4);
  std::vector<float> depth(std::size_t{kEnvs} * 8 * 4);
  std::vector<float> short_depth(depth.size() - 1);
  EXPECT_THAT([&] { renderer.render(views.views(), {.color = color, .depth = short_depth}); },
              testing::ThrowsMessage<ErrorException>(
                  testing::HasSubstr("\"depth\" has the length 95, expected 96")));
  EXPECT_THROW(renderer.render(views.views(), {.depth = depth}), ErrorException);
  EXPECT_THROW(renderer.render(views.views().first(1), {.color = color, .depth = depth}),
               ErrorException);
  EXPECT_THROW(renderer.endRender(), ErrorException);
  renderer.beginRender(views.views(), {.color = color, .depth = depth});
  EXPECT_THROW(renderer.beginRender(views.views(), {.color = color, .depth = depth}),
               ErrorException);
  EXPECT_THROW(static_cast<void>(renderer.renderToDevice(views.views())), ErrorException);
  renderer.endRender();
  EXPECT_GT(*std::ranges::max_element(depth), 0);
}

static_assert(!std::is_copy_constructible_v<WorldViews> && !std::is_copy_assignable_v<WorldViews>);
static_assert(!std::is_copy_constructible_v<DebugViews> && !std::is_copy_assignable_v<DebugViews>);

}  // namespace
}  // namespace galactic::world_views_test
