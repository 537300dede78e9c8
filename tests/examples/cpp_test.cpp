// The C++ programs of examples/cpp/ in a small home.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/build_paths.h"
#include "support/homes/policy_networks.h"
#include "support/homes/small_home_models.h"
#include "support/program_run.h"
#include "support/scratch_folder.h"

namespace galactic::test::cpp_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;

/// A policy for the small home's robot, of which actions move four joints.
PolicyContent homePolicy() {
  constexpr std::uint32_t kJoints = 4;
  PolicyBuilder b(3);
  b.content.interface.name = "wanderer";
  b.content.interface.robot = "helper";
  b.content.interface.options = {{.name = "task", .value = "pick"}};
  b.content.interface.observation = plainObservation(kJoints);
  const std::uint32_t x = b.add({{}, layer::Observation{}});
  b.heads(b.gru(x, 19 + kJoints, 12), 12, kJoints + 2);
  return std::move(b.content);
}

class CppExamples : public testing::Test {
 protected:
  void SetUp() override { world_ = writeWorld(folder_, smallHomeWorldWithModels()); }

  [[nodiscard]] ProgramRun run(const std::string& name, std::vector<std::string> arguments) const {
    return runProgram(builtProgram(name), folder_.path(), std::move(arguments));
  }
  /// What a program says that ends well.
  [[nodiscard]] std::string said(const std::string& name,
                                 std::vector<std::string> arguments) const {
    const ProgramRun done = run(name, std::move(arguments));
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return done.out;
  }

  ScratchFolder folder_;
  std::filesystem::path world_;
};

TEST_F(CppExamples, QuerySceneAsksAGrid) {
  const std::filesystem::path room = sourceFolder() / "packs/golden/room-column.pack";
  EXPECT_THAT(said("query_scene", {room.string()}), HasSubstr("outside the grid\n"));
}

TEST_F(CppExamples, PlanMotionFindsMotions) {
  const std::string found = said("plan_motion", {world_.string()});
  EXPECT_THAT(found, AllOf(HasSubstr(" motions, shortened from "), HasSubstr("\nfound 8 of 8, "),
                           HasSubstr(" questions, ")));
}

TEST_F(CppExamples, StepHomesStepsAndSaysWhereThingsAre) {
  EXPECT_THAT(said("step_homes", {world_.string()}),
              AllOf(HasSubstr("reward "), HasSubstr("the robot is at "), HasSubstr(" m high\n"),
                    HasSubstr("half a meter to the side is ")));
}

TEST_F(CppExamples, DrawViewsDraws) {
  EXPECT_THAT(said("draw_views", {world_.string()}),
              MatchesRegex(".*: farthest [1-9]\\.[0-9] m\n"));
}

TEST_F(CppExamples, PlayPolicyPlays) {
  const std::filesystem::path policy = folder_.path() / "policy.pack";
  ASSERT_TRUE(writePolicyPack(policy, homePolicy(), smallPolicyProvenance()).has_value());
  EXPECT_THAT(said("play_policy", {world_.string(), policy.string()}),
              HasSubstr(" envs, 100 steps\n"));
}

TEST_F(CppExamples, ProgramsSayWhatTheyWereNotGivenAndWhatTheyCannotOpen) {
  const std::string missing = (folder_.path() / "missing.pack").string();
  for (const char* name :
       {"query_scene", "plan_motion", "step_homes", "draw_views", "play_policy"}) {
    const ProgramRun without = run(name, {});
    EXPECT_EQ(without.exit_code, 1);
    EXPECT_THAT(without.err, HasSubstr("usage: " + std::string(name)));
    std::vector<std::string> arguments{missing};
    if (name == std::string("play_policy")) arguments.push_back(missing);
    const ProgramRun absent = run(name, arguments);
    EXPECT_EQ(absent.exit_code, 2);
    EXPECT_THAT(absent.err, HasSubstr("missing.pack"));
  }
}

}  // namespace
}  // namespace galactic::test::cpp_test
