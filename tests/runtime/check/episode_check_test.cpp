// One wrong value per field of an episode pack whose hash is right: each has its own message.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "galactic/episode_set.h"
#include "galactic/pack.h"
#include "runtime/check/pack_damage.h"
#include "runtime/check/pack_offence.h"
#include "support/packs/episode_pack_builder.h"

namespace galactic::test::episode_check_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Fields = EpisodePackFields;
using Offence = PackOffence<Fields>;

/// An offence in this field of the episode set.
Offence in(const std::string& field, const std::string& message,
           std::function<void(Fields&)> change) {
  return {"episode_set." + field, message, std::move(change)};
}

void refuse(const std::vector<Offence>& offences) { expectRefused(smallEpisodes(), offences); }

void expectAccepted(const Fields& fields) {
  const AlignedBytes bytes = buildPack(fields);
  const Result<PackFile> pack = PackFile::view(bytes.bytes(), "made.pack");
  EXPECT_TRUE(pack.has_value()) << pack.error().text();
}

TEST(EpisodeCheck, AcceptsTheEpisodesThatTheOffencesBelowStartFrom) {
  expectAccepted(smallEpisodes());
}

TEST(EpisodeCheck, AcceptsEpisodesForAnyRobotWithoutStartPositions) {
  Fields fields = smallEpisodes();
  fields.robot.clear();
  fields.start_joints.clear();
  fields.start_positions.clear();
  expectAccepted(fields);
}

TEST(EpisodeCheck, RefusesWrongNames) {
  const std::string order = "does not come after its predecessor, expected ascending names";
  const std::string joint = "is empty or a repeated name, expected each joint's own";
  refuse({
      in("name", "is empty, expected the episodes' name", [](Fields& f) { f.name.clear(); }),
      in("scenes", "is empty, expected at least one scene", [](Fields& f) { f.scenes.clear(); }),
      in("scenes[0]", "is empty, expected the scene's name",
         [](Fields& f) { f.scenes[0].clear(); }),
      in("scenes[1]", order,
         [](Fields& f) {
           f.scenes = {"kitchen", "kitchen"};
         }),
      in("objects", "is empty, expected at least one object", [](Fields& f) { f.objects.clear(); }),
      in("objects[0]", "is empty, expected the object's name",
         [](Fields& f) { f.objects[0].clear(); }),
      in("objects[1]", order, [](Fields& f) { f.objects[0] = "nut"; }),
      in("objects[1]", order, [](Fields& f) { f.objects[1] = "bowl"; }),
      in("start_joints[1]", joint, [](Fields& f) { f.start_joints[1].clear(); }),
      in("start_joints[1]", joint, [](Fields& f) { f.start_joints[1] = "elbow"; }),
  });
}

TEST(EpisodeCheck, RefusesWrongStartPositions) {
  refuse({
      in("start_positions", "has 3 elements, expected 4, one per episode and start joint",
         [](Fields& f) { f.start_positions.pop_back(); }),
      in("start_positions", "has 4 elements, expected 2, one per episode and start joint",
         [](Fields& f) { f.start_joints.pop_back(); }),
      in("start_positions[2]", "is nan, expected a position of up to 1000000000",
         [](Fields& f) { f.start_positions[2] = kNan; }),
      in("start_positions[3]", "is -inf, expected a position of up to 1000000000",
         [](Fields& f) { f.start_positions[3] = -kInfinity; }),
  });
}

TEST(EpisodeCheck, RefusesWrongPlacements) {
  const std::string rigid = "is not a rigid transform, expected up to 800 m and a unit quaternion";
  refuse({
      in("placements[1].object", "is 2, expected one of 2 objects",
         [](Fields& f) { f.placements[1].object = 2; }),
      in("placements[3].object", "is 4294967295, expected one of 2 objects",
         [](Fields& f) { f.placements[3].object = 0xffffffff; }),
      in("placements[0].pose", rigid, [](Fields& f) { f.placements[0].pose.translation.x = kNan; }),
      in("placements[2].pose", rigid,
         [](Fields& f) { f.placements[2].pose.translation.z = kInfinity; }),
      in("placements[2].pose", rigid, [](Fields& f) { f.placements[2].pose.rotation.w = 0.9F; }),
      in("placements[2].pose", rigid, [](Fields& f) { f.placements[2].pose.rotation.y = kNan; }),
      in("placements", "has 5 elements, expected the 4 that the episodes name",
         [](Fields& f) { f.placements.push_back(f.placements[0]); }),
  });
}

TEST(EpisodeCheck, RefusesWrongEpisodes) {
  const std::string rigid = "is not a rigid transform, expected up to 800 m and a unit quaternion";
  refuse({
      in("episodes", "is empty, expected at least one episode",
         [](Fields& f) { f.episodes.clear(); }),
      in("episodes[0].scene", "is 1, expected one of 1 scenes",
         [](Fields& f) { f.episodes[0].scene = 1; }),
      in("episodes[0].first_placement", "and count are 1 and 3, expected 0 and 1 to 4",
         [](Fields& f) { f.episodes[0].first_placement = 1; }),
      in("episodes[1].first_placement", "and count are 2 and 1, expected 3 and 1 to 1",
         [](Fields& f) { f.episodes[1].first_placement = 2; }),
      in("episodes[1].first_placement", "and count are 3 and 0, expected 3 and 1 to 1",
         [](Fields& f) { f.episodes[1].placement_count = 0; }),
      in("episodes[1].first_placement", "and count are 3 and 2, expected 3 and 1 to 1",
         [](Fields& f) { f.episodes[1].placement_count = 2; }),
      in("episodes[0].first_placement", "and count are 0 and 4294967295, expected 0 and 1 to 4",
         [](Fields& f) { f.episodes[0].placement_count = 0xffffffff; }),
      in("episodes[0].target", "is 3, expected one of the episode's 3 placements",
         [](Fields& f) { f.episodes[0].target = 3; }),
      in("episodes[1].base_position", "is farther than 800 m or not finite, expected coordinates",
         [](Fields& f) { f.episodes[1].base_position.y = kNan; }),
      in("episodes[1].base_yaw", "is inf rad, expected an angle of up to 1000000000 rad",
         [](Fields& f) { f.episodes[1].base_yaw = kInfinity; }),
      in("episodes[0].goal", rigid,
         [](Fields& f) { f.episodes[0].goal.translation.y = -kInfinity; }),
      in("episodes[0].goal", rigid, [](Fields& f) { f.episodes[0].goal.rotation.x = 0.5F; }),
  });
}

TEST(DamagedEpisodePack, IsRefusedAtEachLengthOfATruncation) {
  expectEachTruncationRefused(buildPack(smallEpisodes()));
}

TEST(DamagedEpisodePack, IsRefusedWithBytesTooMany) {
  expectBytesTooManyRefused(buildPack(smallEpisodes()));
}

TEST(DamagedEpisodePack, IsRefusedAfterEachFlipOfASingleBit) {
  expectEachBitFlipRefused(buildPack(smallEpisodes()));
}

/// Reads everything that the views show; a sanitizer sees a read outside the pack.
void readEverything(const PackFile& pack) {
  const Result<EpisodeSet> set = EpisodeSet::from(pack);
  ASSERT_TRUE(set.has_value());
  ASSERT_FALSE(set->name().empty());
  ASSERT_FALSE(set->episodes().empty());
  for (std::size_t n = 0; n < set->episodes().size(); ++n) {
    const Episode& episode = set->episodes()[n];
    ASSERT_FALSE(set->sceneNames().at(episode.scene).empty());
    ASSERT_TRUE(std::isfinite(episode.base_position.x) && std::isfinite(episode.base_yaw));
    const std::span<const Placement> placements = set->placements(episode);
    ASSERT_LT(episode.target, placements.size());
    for (const Placement& placement : placements) {
      ASSERT_FALSE(set->objectNames().at(placement.object).empty());
      ASSERT_TRUE(std::isfinite(placement.pose.translation.y));
    }
    ASSERT_EQ(set->startPositions(n).size(), set->startJoints().size());
    for (const float position : set->startPositions(n)) ASSERT_TRUE(std::isfinite(position));
  }
}

TEST(DamagedEpisodePack, WithARecomputedHashIsRefusedOrSafeToReadAfterEachFlip) {
  expectFlipsWithARightHashRefusedOrUsable(buildPack(smallEpisodes()), PackKind::kEpisodes,
                                           readEverything);
}

}  // namespace
}  // namespace galactic::test::episode_check_test
