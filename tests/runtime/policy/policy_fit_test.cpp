// Whether a policy fits the batch that it is to act in: every mismatch has its message.
#include <gtest/gtest.h>

#include "galactic/learned_policy.h"
#include "runtime/policy/policy_run.h"
#include "support/packs/policy_pack_builder.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test::policy_fit_test {
namespace {

class PolicyFit : public testing::Test {
 protected:
  PolicyFit()
      : file_(buildPack(PolicyPackFields{})),
        pack_(*PackFile::view(file_.bytes(), "picker.pack")),
        batch_(batchFor(*policyInterface(pack_), 2)) {
    batch_.robot = "helper";
  }

  void expectUnfit(const std::string& message) {
    const auto policy = LearnedPolicy::create(pack_, batch_, {});
    ASSERT_FALSE(policy.has_value());
    EXPECT_EQ(policy.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(policy.error().where, "picker.pack");
    EXPECT_EQ(policy.error().message, message);
  }

  AlignedBytes file_;
  PackFile pack_;
  PolicyBatch batch_;
};

TEST_F(PolicyFit, IsGivenWithTheRobotAndTheObservationOfTheTraining) {
  EXPECT_TRUE(LearnedPolicy::create(pack_, batch_, {}).has_value());
  batch_.robot = "";
  EXPECT_TRUE(LearnedPolicy::create(pack_, batch_, {}).has_value()) << "nobody says which robot";
}

TEST_F(PolicyFit, NeedsTheRobot) {
  batch_.robot = "fetch";
  expectUnfit(
      "moves the robot \"helper\", and the world has \"fetch\"; take a policy that was trained "
      "with this robot");
}

TEST_F(PolicyFit, NeedsAsManyActions) {
  batch_.actions = 4;
  expectUnfit(
      "decides 3 actions, and the robot has 4; take a policy that was trained with this robot");
}

TEST_F(PolicyFit, NeedsEachPartOfTheObservation) {
  batch_.observation[1].name = "laser";
  expectUnfit(
      "reads the observation \"is_holding\", and the simulation has grip_target, laser; switch it "
      "on, or take a policy that was trained without it");
}

TEST_F(PolicyFit, NeedsEachPartInItsSize) {
  batch_.observation[1].size = 2;
  ++batch_.observation_size;
  expectUnfit(
      "reads 1 numbers of the observation \"is_holding\", and the simulation has 2; take the "
      "options and the robot that it was trained with");
}

TEST_F(PolicyFit, TakesItsPartsFromAmongOthersInAnyOrder) {
  auto plain = LearnedPolicy::create(pack_, batch_, {.samples = false, .threads = 1});
  PolicyBatch mixed = batch_;
  mixed.observation = {
      {"time", 0, 3}, {"is_holding", 3, 1}, {"joints", 4, 2}, {"grip_target", 6, 3}};
  mixed.observation_size = 9;
  auto picking = LearnedPolicy::create(pack_, mixed, {.samples = false, .threads = 1});
  ASSERT_TRUE(plain && picking);
  const std::vector<float> few{1, 2, 3, 0.5F, 4, 5, 6, 0.25F};
  const std::vector<float> many{9, 9, 9, 0.5F, 9, 9, 1, 2, 3, 9, 9, 9, 0.25F, 9, 9, 4, 5, 6};
  const std::vector<std::uint8_t> color(2 * 24 * 3, 50);
  const std::vector<float> depth(2 * 24, 1);
  std::vector<float> a(6);
  std::vector<float> b(6);
  plain->act({few, {}, color, depth}, a);
  picking->act({many, {}, color, depth}, b);
  EXPECT_EQ(a, b);
}

TEST(PolicyInterfaceOfAPack, ComesFromPolicyPacksOnly) {
  const AlignedBytes bytes = buildPack(smallScene());
  const auto pack = PackFile::view(bytes.bytes(), "room.pack");
  ASSERT_TRUE(pack.has_value());
  const auto needs = policyInterface(*pack);
  ASSERT_FALSE(needs.has_value());
  EXPECT_EQ(needs.error().where, "room.pack");
  EXPECT_EQ(needs.error().message,
            "is a pack of kind SCEN, expected a policy (PLCY); make one with python -m "
            "galactic.export");
}

}  // namespace
}  // namespace galactic::test::policy_fit_test
