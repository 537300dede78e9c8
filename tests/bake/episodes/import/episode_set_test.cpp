// Published episode sets: what they become.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "episode_texts.h"

namespace galactic::test::episode_set_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr float kRounding = 1e-6F;

/// A pose of the file, turned by hand: 90 degrees about X stand between its frame and a pack's.
void expectQuat(const Quat& found, const Quat& wanted) {
  EXPECT_NEAR(found.x, wanted.x, kRounding);
  EXPECT_NEAR(found.y, wanted.y, kRounding);
  EXPECT_NEAR(found.z, wanted.z, kRounding);
  EXPECT_NEAR(found.w, wanted.w, kRounding);
}

TEST(EpisodeSets, GiveNamesPlacementsAndEpisodes) {
  const auto set = importText(kSmallEpisodeSet);
  ASSERT_TRUE(set.has_value()) << set.error().text();
  EXPECT_EQ(set->name, "small");
  EXPECT_EQ(set->robot, "");
  EXPECT_THAT(set->scenes, ElementsAre("a_room", "b_room"));
  EXPECT_THAT(set->objects, ElementsAre("can", "mug"));
  EXPECT_THAT(set->start_joints, ElementsAre("pan", "lift"));
  EXPECT_THAT(set->start_positions, ElementsAre(0.125F, -0.5F, 1, 2));
  EXPECT_THAT(set->warnings, IsEmpty());
  ASSERT_EQ(set->episodes.size(), 2U);
  const Episode& first = set->episodes[0];
  EXPECT_EQ(first.scene, 1U);
  EXPECT_EQ(first.first_placement, 0U);
  EXPECT_EQ(first.placement_count, 2U);
  EXPECT_EQ(first.target, 1U);
  EXPECT_EQ(first.base_position, (Vec3{0.5F, 0, -0.25F}));
  EXPECT_EQ(first.base_yaw, 1.5F);
  EXPECT_EQ(first.goal.translation, (Vec3{-1, 1, -2}));
  const Episode& second = set->episodes[1];
  EXPECT_EQ(second.scene, 0U);
  EXPECT_EQ(second.first_placement, 2U);
  EXPECT_EQ(second.placement_count, 2U);
  EXPECT_EQ(second.base_position, (Vec3{2, 0, 3}));
  // The shared spawn stands there twice.
  ASSERT_EQ(set->placements.size(), 4U);
  EXPECT_EQ(set->placements[1].object, 0U);
  EXPECT_EQ(set->placements[2].object, 0U);
  EXPECT_EQ(set->placements[1].pose, set->placements[2].pose);
  EXPECT_EQ(set->placements[0].object, 1U);
  EXPECT_EQ(set->placements[3].pose.translation, (Vec3{7, 8, 9}));
}

TEST(EpisodeSets, TurnObjectsFromTheFrameOfTheirFileToThatOfTheirPack) {
  const auto set = importText(kSmallEpisodeSet);
  ASSERT_TRUE(set.has_value());
  constexpr float kHalf = 0.70710678F;
  expectQuat(set->placements[0].pose.rotation, {kHalf, 0, 0, kHalf});
  // Upright in the file is upright in the pack.
  expectQuat(set->placements[1].pose.rotation, {0, 0, 0, 1});
  expectQuat(set->episodes[0].goal.rotation, {0, 0, 0, 1});
  auto options = twoJoints();
  options.object_up = bake::UpAxis::kY;
  const auto same = importText(kSmallEpisodeSet, options);
  ASSERT_TRUE(same.has_value());
  expectQuat(same->placements[0].pose.rotation, {0, 0, 0, 1});
  expectQuat(same->placements[1].pose.rotation, {-kHalf, 0, 0, kHalf});
}

TEST(EpisodeSets, KeepTheEpisodesThatAreAskedForInTheirOrder) {
  auto options = twoJoints();
  options.only = std::vector<std::uint32_t>{1};
  const auto set = importText(kSmallEpisodeSet, options);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_THAT(set->scenes, ElementsAre("a_room"));
  EXPECT_EQ(set->episodes.size(), 1U);
  EXPECT_EQ(set->placements.size(), 2U);
  EXPECT_EQ(set->episodes[0].first_placement, 0U);
  EXPECT_THAT(set->start_positions, ElementsAre(1, 2));
  options.only = std::vector<std::uint32_t>{1, 0};
  const auto turned = importText(kSmallEpisodeSet, options);
  ASSERT_TRUE(turned.has_value());
  EXPECT_EQ(turned->episodes[1].base_yaw, 1.5F);
  EXPECT_EQ(turned->episodes[1].first_placement, 2U);
}

TEST(EpisodeSets, RenameScenes) {
  auto options = twoJoints();
  options.scene_names = {{"a_room", "z_room"}};
  const auto set = importText(kSmallEpisodeSet, options);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_THAT(set->scenes, ElementsAre("b_room", "z_room"));
  EXPECT_EQ(set->episodes[0].scene, 0U);
  EXPECT_EQ(set->episodes[1].scene, 1U);
}

TEST(EpisodeSets, SwapTheNamesOfTwoScenes) {
  auto options = twoJoints();
  options.scene_names = {{"a_room", "b_room"}, {"b_room", "a_room"}};
  const auto set = importText(kSmallEpisodeSet, options);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_EQ(set->episodes[0].scene, 0U);
  EXPECT_EQ(set->episodes[1].scene, 1U);
}

TEST(EpisodeSets, WarnOncePerKeyThatIsNotUsed) {
  std::string text = kSmallEpisodeSet;
  std::size_t at = 0;
  while ((at = text.find("\"startPos\"", at)) != std::string::npos) {
    const std::string_view more = R"("mass": 1, )";
    text.insert(at, more);
    at += more.size() + 1;
  }
  text = replaced(text, "\"agentStartYaw\"", "\"color\": 7, \"agentStartYaw\"");
  const auto set = importText(text);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_THAT(set->warnings, ElementsAre("episodeSet.freeObjectSpawns[0].mass is not used",
                                         "episodeSet.episodes[0].color is not used"));
}

TEST(EpisodeSets, NormalizeRotations) {
  const auto set = importText(
      replaced(kSmallEpisodeSet, "[0.7071068, -0.7071068, 0, 0]", "[0.7078, -0.7078, 0, 0]"));
  ASSERT_TRUE(set.has_value()) << set.error().message;
  expectQuat(set->placements[1].pose.rotation, {0, 0, 0, 1});
}

TEST(EpisodeSets, AreNamedByTheirFile) {
  const ScratchFolder folder;
  const auto plain = bake::readEpisodeSet(folder.write("x.json", kSmallEpisodeSet), twoJoints());
  ASSERT_TRUE(plain.has_value());
  EXPECT_EQ(plain->name, "x");
  const auto odd =
      bake::readEpisodeSet(folder.write(".episode_set.json", kSmallEpisodeSet), twoJoints());
  ASSERT_TRUE(odd.has_value());
  EXPECT_EQ(odd->name, ".episode_set");
}

}  // namespace
}  // namespace galactic::test::episode_set_test
