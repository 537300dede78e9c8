// What a PlanningScene answers, against what the simulation then does in the small home.
#include "galactic/planning_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "galactic/self_collision.h"
#include "runtime/simulation/queries/planned_home.h"
#include "support/oracles/task_oracle.h"

namespace galactic::test::planning_scene_test {
namespace {

/// Poses go through quaternions and back, meters and components.
constexpr float kTolerance = 1e-5F;

void expectNear(const Pose& a, const Pose& b) {
  EXPECT_LT(distance(a.translation, b.translation), kTolerance);
  const Quat& p = a.rotation;
  const Quat& q = b.rotation;
  EXPECT_NEAR(std::fabs(p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w), 1, kTolerance);
}

TEST_F(PlanningSceneInTheSmallHome, PutsTheHandWhereTheSimulationHasIt) {
  std::minstd_rand random(1);
  std::uniform_real_distribution<float> number(-1, 1);
  for (int n = 0; n < 100; ++n) {
    SmallHomeRow row{};
    for (const SmallHomeAction action : {kLift, kShoulder, kArm, kWrist, kForward, kTurn}) {
      row[action] = number(random);
    }
    step(row);
    const BasePlace base = scene_.baseOf(state());
    expectNear(scene_.worldFromRoot(base), state().world_from_root);
    expectNear(scene_.worldFromRoot(base) * scene_.rootFromGrip(), state().world_from_grip);
    EXPECT_TRUE(scene_.isFree(base)) << "the simulation accepts free poses only";
  }
}

TEST_F(PlanningSceneInTheSmallHome, SaysWhetherTheRobotTouchesItself) {
  const SelfCollision self_collision(home_.world().robot());
  EXPECT_FALSE(scene_.touchesItself());
  for (const float margin : {0.0F, 0.2F, 1.0F}) {
    EXPECT_EQ(scene_.touchesItself(margin), self_collision.touches(scene_.rootFromLinks(), margin));
  }
}

TEST_F(PlanningSceneInTheSmallHome, SaysWhatTheHandGrasps) {
  int nothing = 0;
  for (int n = 0; n < kPatience && state().held < 0; ++n) {
    const std::optional<std::uint32_t> grasped = scene_.graspedAt(scene_.baseOf(state()));
    SmallHomeRow row{};
    row[kHand] = 1;
    const std::vector<std::byte> before = simulator_.saveState();
    simulator_.step(row);
    EXPECT_EQ(state().held, grasped ? static_cast<std::int32_t>(*grasped) : -1);
    nothing += grasped ? 0 : 1;
    if (grasped) return;
    ASSERT_TRUE(simulator_.restoreState(before));
    SmallHomeRow towards = fetch(state(), state().target);
    towards[kHand] = -1;
    step(towards);
  }
  FAIL() << "after " << nothing << " steps there is still nothing to grasp";
}

TEST_F(PlanningSceneInTheSmallHome, HoldsAnObjectAsTheSimulationDoes) {
  for (int n = 0; n < kPatience && !scene_.graspedAt(scene_.baseOf(state())); ++n) {
    SmallHomeRow towards = fetch(state(), state().target);
    towards[kHand] = -1;
    step(towards);
  }
  const std::uint32_t target = state().target;
  const BasePlace base = scene_.baseOf(state());
  ASSERT_EQ(scene_.graspedAt(base), target);
  const OrientedBox rested = scene_.objectBox(target);
  EXPECT_FALSE(scene_.isHolding());
  scene_.hold(target, base);
  EXPECT_TRUE(scene_.isHolding());
  EXPECT_FALSE(scene_.graspedAt(base)) << "it rests no more";
  const Pose pretended = scene_.gripFromObject();
  scene_.putBack();
  EXPECT_FALSE(scene_.isHolding());
  EXPECT_EQ(scene_.graspedAt(base), target);
  EXPECT_EQ(scene_.objectBox(target), rested);

  SmallHomeRow row{};
  row[kHand] = 1;
  step(row);
  ASSERT_TRUE(scene_.isHolding());
  expectNear(scene_.gripFromObject(), pretended);
}

TEST_F(PlanningSceneInTheSmallHome, SaysWhereAReleasedObjectLands) {
  fetchTarget();
  const Vec3 place = state().goal.translation;
  for (int n = 0; n < kPatience; ++n) {
    if (distance(state().objects[state().target].translation, place) < 0.05) break;
    step(carry(state(), place));
  }
  const std::uint32_t target = state().target;
  const std::optional<Pose> landing = scene_.landing(scene_.baseOf(state()));
  ASSERT_TRUE(landing);
  simulator_.step(SmallHomeRow{});
  EXPECT_EQ(state().held, -1);
  expectNear(state().objects[target], *landing);
}

TEST_F(PlanningSceneInTheSmallHome, FindsNoPlaceForAnObjectAboveNothing) {
  fetchTarget();
  // A base far outside of the room, where no grid knows anything.
  EXPECT_FALSE(scene_.landing({{50, 0, 50}, 0}));
  EXPECT_FALSE(scene_.isFree({{50, 0, 50}, 0}));
  EXPECT_FALSE(scene_.floorAt(50, 50, 0));
}

/// The home in a state of its own, and what its scene says of it.
class AStateThatPenetrates : public PlanningSceneInTheSmallHome {
 protected:
  void set(const EnvState& state) {
    const std::array<std::uint32_t, 1> envs{0};
    ASSERT_EQ(orThrow(simulator_.setStates(envs, std::span(&state, 1))).front(), 1);
    look();
  }
  [[nodiscard]] bool isFreeHere() { return scene_.isFree(scene_.baseOf(state())); }
  /// The joints of the state with another lift.
  void liftBy(float way) {
    std::vector<float> joints = state().joint_positions;
    joints[kLift] += way;
    scene_.setJoints(joints);
  }
  /// Moves the lift as far as steps can, all the way; whether the simulation refused none of them.
  bool liftInSteps(float way, int steps) {
    const std::uint64_t refused = simulator_.statistics().refused;
    SmallHomeRow row{};
    row[kLift] = way;
    row[kHand] = state().held >= 0 ? 1.0F : -1.0F;
    for (int n = 0; n < steps; ++n) step(row);
    return simulator_.statistics().refused == refused;
  }
};

TEST_F(AStateThatPenetrates, IsFreeWhereTheHeldObjectDoesUntilItIsFreeOnce) {
  fetchTarget();
  EnvState low = state();
  low.objects[low.target].translation.y -= 0.03F;
  set(low);
  EXPECT_TRUE(isFreeHere()) << "the simulation lets it be there";
  const BasePlace base = scene_.baseOf(state());
  liftBy(0.2F);
  EXPECT_TRUE(scene_.isFree(base));
  // The simulation and the scene say the same of the way back.
  ASSERT_TRUE(liftInSteps(1, 3));
  EXPECT_TRUE(isFreeHere());
  liftBy(-(state().joint_positions[kLift] - low.joint_positions[kLift]));
  EXPECT_FALSE(scene_.isFree(base));
  EXPECT_FALSE(liftInSteps(-1, 3));
  // Motions count what is free on their way, and leave the scene as it is.
  set(low);
  const std::vector<float> deep = state().joint_positions;
  std::vector<float> high = deep;
  high[kLift] += 0.2F;
  EXPECT_TRUE(scene_.isMotionFree({base, deep}, {base, high}));
  EXPECT_FALSE(scene_.isMotionFree({base, high}, {base, deep}));
  EXPECT_TRUE(isFreeHere());
}

TEST_F(AStateThatPenetrates, IsFreeWhereTheRobotTouchesWhatItHasJustLetGoOf) {
  for (int n = 0; n < kPatience && !scene_.graspedAt(scene_.baseOf(state())); ++n) {
    SmallHomeRow towards = fetch(state(), state().target);
    towards[kHand] = -1;
    step(towards);
  }
  EnvState around = state();
  // Around the sphere of the hand, which is behind the grip.
  around.objects[around.target].translation = around.world_from_grip * Vec3{-0.04F, 0, 0};
  set(around);
  const BasePlace base = scene_.baseOf(state());
  EXPECT_TRUE(isFreeHere());
  EXPECT_TRUE(scene_.isFreeOfAllElse(base));
  // Away and back: it counts from where it is free on.
  liftBy(0.2F);
  EXPECT_TRUE(scene_.isFree(base));
  scene_.countFree(base);
  liftBy(0);
  EXPECT_FALSE(scene_.isFree(base));
  EXPECT_FALSE(scene_.isFreeOfAllElse(base));
  look();
  EXPECT_TRUE(isFreeHere()) << "update() looks anew";
  // What is taken in the hand is in nobody's way, and put back it is left as before.
  scene_.hold(around.target, base);
  EXPECT_TRUE(scene_.isFree(base));
  scene_.putBack();
  EXPECT_TRUE(isFreeHere());
}

TEST_F(PlanningSceneInTheSmallHome, HoldsWhatItWouldGraspInATable) {
  for (int n = 0; n < kPatience && !scene_.graspedAt(scene_.baseOf(state())); ++n) {
    SmallHomeRow towards = fetch(state(), state().target);
    towards[kHand] = -1;
    step(towards);
  }
  EnvState sunken = state();
  sunken.objects[sunken.target].translation.y -= 0.01F;
  scene_.update(sunken);
  const BasePlace base = scene_.baseOf(sunken);
  scene_.hold(sunken.target, base);
  EXPECT_TRUE(scene_.isFree(base)) << "as after a grasp";
}

TEST_F(PlanningSceneInTheSmallHome, IgnoresSpheresThatPenetrateUntilTheyAreFree) {
  fetchTarget();
  // From where all of them are free: lowered into the table, held object and all: the arm's own
  // spheres are higher.
  std::vector<float> low = state().joint_positions;
  std::vector<float> high = low;
  high[kLift] += 0.2F;
  const BasePlace base = scene_.baseOf(state());
  low[kLift] -= 0.03F;
  scene_.setJoints(low);
  ASSERT_TRUE(scene_.isRobotFreeOfScene(base));
  ASSERT_FALSE(scene_.isFree(base)) << "the object is in the table";
  scene_.ignorePenetrating(base);
  EXPECT_TRUE(scene_.isFree(base));
  scene_.setJoints(high);
  EXPECT_TRUE(scene_.isFree(base));
  scene_.countFree(base);
  scene_.setJoints(low);
  EXPECT_FALSE(scene_.isFree(base)) << "it has been free";
}

TEST_F(PlanningSceneInTheSmallHome, IgnoresNoMoreSpheresWhereItLooksWhichAreFree) {
  fetchTarget();
  std::vector<float> low = state().joint_positions;
  low[kLift] -= 0.03F;
  const BasePlace base = scene_.baseOf(state());
  scene_.setJoints(low);
  ASSERT_FALSE(scene_.isFree(base)) << "the object is in the table";
  scene_.countFree(base);
  EXPECT_FALSE(scene_.isFree(base)) << "what penetrates was not ignored before";
}

TEST_F(PlanningSceneInTheSmallHome, MeasuresDistancesToBoxes) {
  const std::uint32_t target = state().target;
  ASSERT_LT(target, scene_.objectCount());
  const OrientedBox box = scene_.objectBox(target);
  EXPECT_EQ(scene_.squaredGraspDistance(target, box.pose.translation), 0);
  const float above = 0.3F;
  const Vec3 point = box.pose.translation + Vec3{0, box.half_extents.y + above, 0};
  EXPECT_NEAR(scene_.squaredGraspDistance(target, point), above * above, kTolerance);
}

/// The small home with octagonal posts in its boxes: planes that leave out the upright edges.
WorldFields homeOfPosts() {
  WorldFields fields = smallHomeWorld();
  constexpr float kDiagonal = 0.70710678F;
  for (ObjectFields& object : fields.objects.objects) {
    object.hull_planes.emplace();
    for (const float x : {-kDiagonal, kDiagonal}) {
      for (const float z : {-kDiagonal, kDiagonal}) {
        object.hull_planes->push_back({{x, 0, z}, 0.05F});
      }
    }
  }
  return fields;
}

/// Puts the grip (its sphere has 15 mm) to this place in the frame of the target's box and closes
/// the hand: what it holds then.
std::optional<std::uint32_t> graspedIn(const World& world, GraspShape shape, const Vec3& beside) {
  SimulationOptions options = oneEnv();
  options.action.grasp_shape = shape;
  BatchSimulator simulator = simulatorOf(world, options);
  PlanningScene scene(world, options);
  const EnvState state = simulator.envState(0);
  scene.update(state);
  scene.setJoints(state.joint_positions);
  const BasePlace base = scene.baseOf(state);
  const Vec3 grip = (scene.worldFromRoot(base) * scene.rootFromGrip()).translation;
  const Vec3 way = scene.objectBox(state.target).pose * beside - grip;
  std::vector<Pose> objects = state.objects;
  for (Pose& pose : objects) pose.translation = pose.translation + Vec3{0, 20, 0};
  objects[state.target] = state.objects[state.target];
  objects[state.target].translation = objects[state.target].translation - way;
  const FollowedState moved{.world_from_root = state.world_from_root,
                            .joint_positions = state.joint_positions,
                            .objects = objects,
                            .held = -1,
                            .was_hindered = false};
  SmallHomeRow row{};
  simulator.follow(row, std::span(&moved, 1));
  scene.update(simulator.envState(0));
  const std::optional<std::uint32_t> expected = scene.graspedAt(base);
  row[kHand] = 1;
  simulator.step(row);
  const std::int32_t held = simulator.envState(0).held;
  EXPECT_EQ(held, expected ? static_cast<std::int32_t>(*expected) : -1);
  return expected;
}

TEST(AGrasp, AsksForTheHullWhereItIsKnownAndForTheBoxWhereThatIsWanted) {
  const SmallHome posts(homeOfPosts());
  const SmallHome boxes;
  // 6 mm off the upright edge of the box, 26 mm off the post.
  const Vec3 corner{0.054F, 0, 0.054F};
  const Vec3 face{0.06F, 0, 0};
  const Vec3 away{0.07F, 0, 0};
  for (const GraspShape shape : {GraspShape::kHull, GraspShape::kBox}) {
    EXPECT_EQ(graspedIn(posts.world(), shape, corner).has_value(), shape == GraspShape::kBox);
    EXPECT_TRUE(graspedIn(boxes.world(), shape, corner)) << "an older pack knows boxes only";
    EXPECT_TRUE(graspedIn(posts.world(), shape, face));
    EXPECT_FALSE(graspedIn(posts.world(), shape, away));
  }
}

TEST(AGrasp, ReachesAsFarAsALargeHand) {
  WorldFields fields = smallHomeWorld();
  // More than the largest sphere has.
  fields.robot.end_effector->grasp_radius = 0.3F;
  const SmallHome home(fields);
  for (const GraspShape shape : {GraspShape::kHull, GraspShape::kBox}) {
    EXPECT_TRUE(graspedIn(home.world(), shape, {0.3F, 0, 0}));
    EXPECT_FALSE(graspedIn(home.world(), shape, {0.4F, 0, 0}));
  }
}

/// A call by its name.
struct NamedCall {
  std::string name;
  std::function<void()> call;
};

/// Questions about an env, whatever the joints.
std::vector<NamedCall> questionsOfEnvs(PlanningScene& scene) {
  return {{"scene", [&] { static_cast<void>(scene.scene()); }},
          {"floorAt", [&] { static_cast<void>(scene.floorAt(0, 0, 0)); }},
          {"objectCount", [&] { static_cast<void>(scene.objectCount()); }},
          {"objectBox", [&] { static_cast<void>(scene.objectBox(0)); }},
          {"squaredGraspDistance", [&] { static_cast<void>(scene.squaredGraspDistance(0, {})); }}};
}
/// Questions about joints, whatever the env.
std::vector<NamedCall> questionsOfJoints(PlanningScene& scene) {
  return {{"rootFromLinks", [&] { static_cast<void>(scene.rootFromLinks()); }},
          {"rootFromGrip", [&] { static_cast<void>(scene.rootFromGrip()); }},
          {"reach", [&] { static_cast<void>(scene.reach()); }},
          {"touchesItself", [&] { static_cast<void>(scene.touchesItself()); }}};
}
/// Questions about places of the robot in an env.
std::vector<NamedCall> questionsOfPlaces(PlanningScene& scene) {
  return {{"isFree", [&] { static_cast<void>(scene.isFree({})); }},
          {"isRobotFreeOfScene", [&] { static_cast<void>(scene.isRobotFreeOfScene({})); }},
          {"isFreeOfAllElse", [&] { static_cast<void>(scene.isFreeOfAllElse({})); }},
          {"graspedAt", [&] { static_cast<void>(scene.graspedAt({})); }},
          {"hold", [&] { scene.hold(0, {}); }},
          {"ignorePenetrating", [&] { scene.ignorePenetrating({}); }},
          {"countFree", [&] { scene.countFree({}); }},
          {"landing", [&] { static_cast<void>(scene.landing({})); }}};
}

TEST_F(PlanningSceneInTheSmallHome, RefusesQuestionsBeforeItKnowsWhatTheyAreAbout) {
  const auto expect = [](const std::vector<NamedCall>& calls, const std::string& message) {
    for (const auto& [name, call] : calls) {
      EXPECT_EQ(refusalOf(call), message.empty() ? "" : "PlanningScene::" + name + message);
    }
  };
  const std::string no_env = ": found no env; take one over first, with update()";
  const std::string no_joints = ": found no joint positions; choose them first, with setJoints()";
  PlanningScene blank(home_.world(), oneEnv());
  EXPECT_FALSE(blank.isHolding());
  std::vector<std::uint8_t> free(1);
  const std::vector<BasePlace> bases(1);
  const std::vector<float> joints(4);
  expect({{"areFree",
           [&] {
             blank.areFree({bases, joints}, free);
           }},
          {"areMotionsFree",
           [&] {
             blank.areMotionsFree({bases, joints}, {bases, joints}, free);
           }},
          {"isMotionFree",
           [&] {
             static_cast<void>(blank.isMotionFree({bases[0], joints}, {bases[0], joints}));
           }}},
         no_env);
  expect(questionsOfEnvs(blank), no_env);
  expect(questionsOfPlaces(blank), no_env);
  expect(questionsOfJoints(blank), no_joints);
  PlanningScene jointless(home_.world(), oneEnv());
  jointless.update(state());
  expect(questionsOfEnvs(jointless), "");
  expect(questionsOfPlaces(jointless), no_joints);
  expect(questionsOfJoints(jointless), no_joints);
  PlanningScene envless(home_.world(), oneEnv());
  envless.setJoints(state().joint_positions);
  expect(questionsOfEnvs(envless), no_env);
  expect(questionsOfPlaces(envless), no_env);
  expect(questionsOfJoints(envless), "");
  // In either order.
  envless.update(state());
  jointless.setJoints(state().joint_positions);
  for (PlanningScene* scene : {&envless, &jointless}) {
    EXPECT_TRUE(scene->isFree(scene->baseOf(state())));
    EXPECT_FALSE(scene->isHolding());
  }
}

TEST_F(PlanningSceneInTheSmallHome, RefusesObjectsThatThereAreNot) {
  EXPECT_EQ(refusalOf([&] { static_cast<void>(scene_.objectBox(2)); }),
            "PlanningScene::objectBox: found object 2, expected one below 2");
  EXPECT_EQ(refusalOf([&] { static_cast<void>(scene_.squaredGraspDistance(9999, {})); }),
            "PlanningScene::squaredGraspDistance: found object 9999, expected one below 2");
  EXPECT_EQ(refusalOf([&] { scene_.hold(2, {}); }),
            "PlanningScene::hold: found object 2, expected one below 2");
  EXPECT_FALSE(scene_.isHolding());
}

TEST_F(PlanningSceneInTheSmallHome, RefusesHandsThatAreEmptyOrFull) {
  const BasePlace base = scene_.baseOf(state());
  const auto refused_empty = [&] {
    const std::string empty = ": found an empty hand, expected one that holds an object";
    EXPECT_EQ(refusalOf([&] { static_cast<void>(scene_.landing(base)); }),
              "PlanningScene::landing" + empty);
    EXPECT_EQ(refusalOf([&] { static_cast<void>(scene_.gripFromObject()); }),
              "PlanningScene::gripFromObject" + empty);
  };
  const auto refused_back = [&] {
    EXPECT_EQ(refusalOf([&] { scene_.putBack(); }),
              "PlanningScene::putBack: found no object in the hand that hold() has taken, and no "
              "other goes back");
  };
  refused_empty();
  refused_back();
  const float nan = std::nanf("");
  for (const BasePlace& nowhere : {BasePlace{{nan, 0, 0}, 0}, BasePlace{{0, 0, 0}, nan}}) {
    EXPECT_THAT(refusalOf([&] { scene_.hold(0, nowhere); }),
                testing::HasSubstr("PlanningScene::hold: found a base at ("));
  }
  EXPECT_FALSE(scene_.isHolding());
  scene_.hold(1, base);
  EXPECT_EQ(refusalOf([&] { scene_.hold(0, base); }),
            "PlanningScene::hold: found object 1 in the hand already, expected an empty one");
  EXPECT_TRUE(scene_.isHolding());
  scene_.putBack();
  refused_empty();
  refused_back();
  EXPECT_TRUE(scene_.isFree(base));
  scene_.hold(1, base);
  look();
  refused_empty();
  refused_back();
  // What the robot itself holds rests nowhere.
  fetchTarget();
  refused_back();
  EXPECT_TRUE(scene_.isHolding());
}

TEST_F(PlanningSceneInTheSmallHome, KeepsWhatItHasWhenWrongStatesAndJointsAreRefused) {
  const BasePlace base = scene_.baseOf(state());
  const Pose grip = scene_.rootFromGrip();
  EnvState wrong = state();
  wrong.held = 99;
  EXPECT_EQ(refusalOf([&] { scene_.update(wrong); }),
            "PlanningScene::update: found held 99, expected -1 or an index below 2");
  wrong = state();
  wrong.objects.resize(1);
  EXPECT_EQ(refusalOf([&] { scene_.update(wrong); }),
            "PlanningScene::update: \"objects\" has the length 1, expected 2");
  EXPECT_EQ(refusalOf([&] { scene_.setJoints(std::vector<float>(3)); }),
            "PlanningScene::setJoints: \"positions\" has the length 3, expected 4");
  EXPECT_EQ(refusalOf([&] { scene_.setJoints({}); }),
            "PlanningScene::setJoints: \"positions\" has the length 0, expected 4");
  std::vector<float> joints = state().joint_positions;
  joints[2] = std::nanf("");
  EXPECT_EQ(refusalOf([&] { scene_.setJoints(joints); }),
            "PlanningScene::setJoints: found positions[2] nan, expected a finite number of at most "
            "1e+06");
  EXPECT_EQ(scene_.objectCount(), 2U);
  EXPECT_EQ(scene_.rootFromGrip(), grip);
  EXPECT_TRUE(scene_.isFree(base));
}

TEST_F(PlanningSceneInTheSmallHome, TakesTheObjectsThatItsOptionsSay) {
  SimulationOptions alone = oneEnv();
  alone.task.distractors = false;
  PlanningScene scene(home_.world(), alone);
  EXPECT_EQ(refusalOf([&] { scene.update(state()); }),
            "PlanningScene::update: \"objects\" has the length 2, expected 1");
  BatchSimulator simulator = simulatorOf(home_.world(), alone);
  scene.update(simulator.envState(0));
  EXPECT_EQ(scene.objectCount(), 1U);
}

TEST_F(PlanningSceneInTheSmallHome, RefusesOptionsOutOfTheirRanges) {
  const auto refused = [&](const auto& change) {
    SimulationOptions options = oneEnv();
    change(options);
    return refusalOf([&] { const PlanningScene scene(home_.world(), options); });
  };
  EXPECT_EQ(refused([](SimulationOptions&) {}), "");
  EXPECT_THAT(refused([](SimulationOptions& o) { o.placement.attempts = 4'000'000'000; }),
              testing::HasSubstr("simulation options: place-attempts is 4000000000, expected"));
  EXPECT_THAT(refused([](SimulationOptions& o) { o.ground.most_rise = std::nanf(""); }),
              testing::HasSubstr("floor-rise is nan, expected"));
}

TEST_F(PlanningSceneInTheSmallHome, FindsNothingFreeAtPlacesThatAreNone) {
  const BasePlace sound = scene_.baseOf(state());
  for (int round = 0; round < 2; ++round) {
    for (const float wrong : {std::nanf(""), std::numeric_limits<float>::infinity(), -1e30F}) {
      for (int part = 0; part < 4; ++part) {
        BasePlace place = sound;
        (part == 0   ? place.position.x
         : part == 1 ? place.position.y
         : part == 2 ? place.position.z
                     : place.yaw) = wrong;
        // Any finite yaw is one.
        if (part == 3 && std::isfinite(wrong)) continue;
        EXPECT_FALSE(scene_.isFree(place));
        EXPECT_FALSE(scene_.isRobotFreeOfScene(place));
        EXPECT_FALSE(scene_.graspedAt(place));
        if (part < 3) {
          EXPECT_FALSE(scene_.floorAt(place.position.x, place.position.z, place.position.y));
        }
        if (scene_.isHolding()) {
          EXPECT_FALSE(scene_.landing(place));
          EXPECT_FALSE(scene_.isFreeOfAllElse(place));
        }
      }
    }
    if (round == 0) fetchTarget();
  }
}

TEST(BasePlace, DrivesAlongItsHeading) {
  EXPECT_NEAR(headingOf(0).x, 1, kTolerance);
  // Counter-clockwise, seen from above.
  EXPECT_NEAR(headingOf(1.57079633F).z, -1, kTolerance);
}

}  // namespace
}  // namespace galactic::test::planning_scene_test
