#include "galactic/episode_set.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/packs/episode_pack_builder.h"
#include "support/packs/robot_pack_builder.h"

namespace galactic::test::episode_set_test {
namespace {

template <class Views>
std::vector<std::string> copied(const Views& views) {
  return {views.begin(), views.end()};
}

TEST(EpisodeSet, ShowsWhatThePackHolds) {
  const EpisodePackFields fields = smallEpisodes();
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "tidy.pack");
  ASSERT_TRUE(pack.has_value()) << pack.error().message;
  const Result<EpisodeSet> set = EpisodeSet::from(*pack);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_EQ(set->name(), "tidy");
  EXPECT_EQ(set->robotName(), "helper");
  EXPECT_EQ(copied(set->sceneNames()), fields.scenes);
  EXPECT_EQ(copied(set->objectNames()), fields.objects);
  EXPECT_EQ(copied(set->startJoints()), fields.start_joints);
  ASSERT_EQ(set->episodes().size(), fields.episodes.size());
  for (std::size_t n = 0; n < fields.episodes.size(); ++n) {
    const Episode& made = fields.episodes[n];
    const Episode& episode = set->episodes()[n];
    EXPECT_EQ(episode.scene, made.scene);
    EXPECT_EQ(episode.first_placement, made.first_placement);
    EXPECT_EQ(episode.placement_count, made.placement_count);
    EXPECT_EQ(episode.target, made.target);
    EXPECT_EQ(episode.base_position, made.base_position);
    EXPECT_EQ(episode.base_yaw, made.base_yaw);
    EXPECT_EQ(episode.goal, made.goal);
  }
}

TEST(EpisodeSet, GivesEachEpisodeItsObjectsAndStartPositions) {
  const EpisodePackFields fields = smallEpisodes();
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "tidy.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<EpisodeSet> set = EpisodeSet::from(*pack);
  ASSERT_TRUE(set.has_value());
  std::size_t next = 0;
  for (std::size_t n = 0; n < set->episodes().size(); ++n) {
    for (const Placement& placement : set->placements(set->episodes()[n])) {
      EXPECT_EQ(placement.object, fields.placements[next].object);
      EXPECT_EQ(placement.pose, fields.placements[next].pose);
      ++next;
    }
    ASSERT_EQ(set->startPositions(n).size(), 2U);
    EXPECT_EQ(set->startPositions(n)[0], fields.start_positions[2 * n]);
    EXPECT_EQ(set->startPositions(n)[1], fields.start_positions[2 * n + 1]);
  }
  EXPECT_EQ(next, fields.placements.size());
}

TEST(EpisodeSet, PointsIntoThePackWithoutCopying) {
  const AlignedBytes bytes = buildPack(smallEpisodes());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "tidy.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<EpisodeSet> set = EpisodeSet::from(*pack);
  ASSERT_TRUE(set.has_value());
  const auto inside = [&](const void* address) {
    const auto* byte = static_cast<const std::byte*>(address);
    return byte >= bytes.bytes().data() && byte < bytes.bytes().data() + bytes.size();
  };
  EXPECT_TRUE(inside(set->name().data()));
  EXPECT_TRUE(inside(set->objectNames()[0].data()));
  EXPECT_TRUE(inside(set->episodes().data()));
  EXPECT_TRUE(inside(set->placements(set->episodes()[1]).data()));
  EXPECT_TRUE(inside(set->startPositions(1).data()));
}

TEST(EpisodeSet, RefusesAPackOfAnotherKind) {
  const AlignedBytes bytes = buildPack(smallRobotPack());
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "helper.pack");
  ASSERT_TRUE(pack.has_value());
  const Result<EpisodeSet> set = EpisodeSet::from(*pack);
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(set.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(set.error().where, "helper.pack");
  EXPECT_EQ(set.error().message,
            "is a pack of kind RBOT, expected episodes (EPIS); give the pack of an episode set");
}

TEST(EpisodeSet, RefusesATrustedPackWhoseHeaderLies) {
  RobotPackFields fields = smallRobotPack();
  fields.kind = PackKind::kEpisodes;
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "helper.pack", Trust::kTrusted);
  ASSERT_TRUE(pack.has_value());
  EXPECT_FALSE(EpisodeSet::from(*pack).has_value());
}

}  // namespace
}  // namespace galactic::test::episode_set_test
