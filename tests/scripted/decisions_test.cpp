// Which values of actions decide something, by the thresholds of a task.
#include "scripted/decisions.h"

#include <gtest/gtest.h>

#include <string>

namespace galactic::test::decisions_test {
namespace {

using scripted::Decisions;
using scripted::decisionsBy;

TEST(Decisions, AreOnTheirSidesOfTheThresholds) {
  for (const float threshold : {-0.9F, -0.5F, 0.0F, 0.001F, 0.5F, 1.0F}) {
    const ActionOptions action{.grasp = threshold, .release = threshold, .terminate = threshold};
    const auto decisions = decisionsBy(action, {});
    ASSERT_TRUE(decisions) << threshold;
    EXPECT_LT(decisions->stay_open, threshold);
    EXPECT_GE(decisions->grasp, threshold);
    EXPECT_GE(decisions->keep, threshold);
    EXPECT_LT(decisions->release, threshold);
    EXPECT_LT(decisions->go_on, threshold);
    EXPECT_GE(decisions->terminate, threshold);
    for (const float value : {decisions->stay_open, decisions->grasp, decisions->keep,
                              decisions->release, decisions->go_on, decisions->terminate}) {
      EXPECT_LE(value, 1);
      EXPECT_GE(value, -1);
    }
  }
}

std::string refusal(const ActionOptions& action, const TaskOptions& task = {}) {
  const auto decisions = decisionsBy(action, task);
  if (decisions) return "";
  EXPECT_EQ(decisions.error().code, ErrorCode::kUnsupported);
  return decisions.error().message;
}

TEST(Decisions, AreRefusedWhereNoValueDecidesOrEachDoes) {
  const std::string advice = "; use a number above -1 that is 1 at most";
  const std::string so = ", so that no action from -1 to 1 ";
  EXPECT_EQ(refusal({.grasp = 1.5F}), "grasp-from is 1.5" + so + "closes the hand" + advice);
  EXPECT_EQ(refusal({.grasp = -1}), "grasp-from is -1" + so + "leaves it open" + advice);
  EXPECT_EQ(refusal({.release = 2}),
            "release-below is 2" + so + "keeps what the hand holds" + advice);
  EXPECT_EQ(refusal({.release = -1}), "release-below is -1" + so + "lets it go" + advice);
  EXPECT_EQ(refusal({.terminate = 1.25F}),
            "terminate-from is 1.25" + so + "ends the episode" + advice);
  EXPECT_EQ(refusal({.terminate = -2}), "terminate-from is -2" + so + "lets it go on" + advice);
}

TEST(Decisions, AreThoseThatTheTaskAsksFor) {
  EXPECT_EQ(refusal({.terminate = 2}, {.needs_terminate = false}), "");
  const ActionOptions grasps_only{.release = -1, .terminate = -1};
  EXPECT_EQ(refusal(grasps_only, {.kind = TaskKind::kMobilePick}), "");
  EXPECT_NE(refusal({.grasp = 2}, {.kind = TaskKind::kMobilePick}), "");
}

}  // namespace
}  // namespace galactic::test::decisions_test
