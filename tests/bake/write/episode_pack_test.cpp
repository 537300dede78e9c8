#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "galactic/bake/packs.h"
#include "galactic/episode_set.h"
#include "galactic/pack.h"
#include "support/packs/episode_pack_builder.h"
#include "support/scratch_folder.h"

namespace galactic::test::episode_pack_test {
namespace {

using bake::encodeEpisodePack;
using bake::SourceEpisodes;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The same episodes for the writer and for the pack that tests make by hand.
SourceEpisodes sourceOf(const EpisodePackFields& fields) {
  return {.name = fields.name,
          .scenes = fields.scenes,
          .objects = fields.objects,
          .robot = fields.robot,
          .start_joints = fields.start_joints,
          .start_positions = fields.start_positions,
          .placements = fields.placements,
          .episodes = fields.episodes,
          .warnings = {}};
}

EpisodePackFields fieldsOf(const SourceEpisodes& source) {
  EpisodePackFields fields;
  fields.name = source.name;
  fields.scenes = source.scenes;
  fields.objects = source.objects;
  fields.robot = source.robot;
  fields.start_joints = source.start_joints;
  fields.start_positions = source.start_positions;
  fields.placements = source.placements;
  fields.episodes = source.episodes;
  return fields;
}

bake::Provenance provenance() {
  bake::Provenance made;
  made.tool_version = "0.1.0";
  made.options = {{"as", "episodes"}};
  made.sources.push_back(
      {.name = "tidy.episode_set.json", .bytes = 12, .hash_low = 1, .hash_high = 2});
  return made;
}

bool samePlaces(const Episode& a, const Episode& b) {
  return a.base_position == b.base_position && a.base_yaw == b.base_yaw && a.goal == b.goal;
}

TEST(EpisodePack, IsReadAsItWasWritten) {
  const SourceEpisodes source = sourceOf(smallEpisodes());
  const ScratchFolder folder;
  const auto path = folder.path() / "tidy.pack";
  const auto bytes = writeEpisodePack(path, source, provenance());
  ASSERT_TRUE(bytes.has_value()) << bytes.error().text();
  EXPECT_EQ(*bytes, std::filesystem::file_size(path));
  const auto pack = PackFile::open(path);
  ASSERT_TRUE(pack.has_value()) << pack.error().text();
  EXPECT_EQ(pack->kind(), PackKind::kEpisodes);
  const auto set = EpisodeSet::from(*pack);
  ASSERT_TRUE(set.has_value()) << set.error().message;
  EXPECT_EQ(set->name(), "tidy");
  EXPECT_EQ(set->robotName(), "helper");
  EXPECT_THAT(set->sceneNames(), testing::ElementsAre("kitchen"));
  EXPECT_THAT(set->objectNames(), testing::ElementsAre("bowl", "mug"));
  EXPECT_THAT(set->startJoints(), testing::ElementsAre("elbow", "lift"));
  ASSERT_EQ(set->episodes().size(), source.episodes.size());
  for (std::size_t n = 0; n < source.episodes.size(); ++n) {
    const Episode& episode = set->episodes()[n];
    EXPECT_EQ(episode.target, source.episodes[n].target);
    EXPECT_TRUE(samePlaces(episode, source.episodes[n]));
    EXPECT_EQ(set->startPositions(n)[1], source.start_positions[2 * n + 1]);
    ASSERT_EQ(set->placements(episode).size(), source.episodes[n].placement_count);
    for (std::size_t p = 0; p < episode.placement_count; ++p) {
      const Placement& wanted = source.placements[episode.first_placement + p];
      EXPECT_EQ(set->placements(episode)[p].object, wanted.object);
      EXPECT_EQ(set->placements(episode)[p].pose, wanted.pose);
    }
  }
}

TEST(EpisodePack, HasTheSameBytesEachTime) {
  const auto first = encodeEpisodePack(sourceOf(smallEpisodes()), provenance());
  const auto second = encodeEpisodePack(sourceOf(smallEpisodes()), provenance());
  ASSERT_TRUE(first.has_value() && second.has_value());
  EXPECT_TRUE(*first == *second);
}

TEST(EpisodePack, MayGiveNoStartPositions) {
  SourceEpisodes source = sourceOf(smallEpisodes());
  source.start_joints.clear();
  source.start_positions.clear();
  source.robot.clear();
  const auto payload = encodeEpisodePack(source, provenance());
  ASSERT_TRUE(payload.has_value()) << payload.error().message;
  const AlignedBytes bytes = packFile(PackKind::kEpisodes, *payload);
  EXPECT_TRUE(PackFile::view(bytes.bytes(), "tidy.pack").has_value());
}

struct Change {
  const char* where;
  std::function<void(SourceEpisodes&)> apply;
};

/// One thing wrong each, and some that only look so.
std::vector<Change> changes() {
  return {
      {"name", [](auto& set) { set.name.clear(); }},
      {"scenes", [](auto& set) { set.scenes.clear(); }},
      {"scenes[0]", [](auto& set) { set.scenes[0].clear(); }},
      {"objects[1]", [](auto& set) { set.objects[1] = "ant"; }},
      {"objects[1]", [](auto& set) { set.objects[1] = "bowl"; }},
      {"start_joints", [](auto& set) { set.start_joints[1] = "elbow"; }},
      {"start_joints", [](auto& set) { set.start_joints[0].clear(); }},
      {"start_positions", [](auto& set) { set.start_positions.pop_back(); }},
      {"start_positions", [](auto& set) { set.start_positions[2] = kNan; }},
      {"placements[3]", [](auto& set) { set.placements[3].object = 2; }},
      {"placements[0]", [](auto& set) { set.placements[0].pose.translation.y = kNan; }},
      {"placements[0]", [](auto& set) { set.placements[0].pose.rotation.w = 1.1F; }},
      {"placements[0]",
       [](auto& set) {
         set.placements[0].pose.rotation = {0, 0, 0, 0};
       }},
      {"placements", [](auto& set) { set.placements.push_back(set.placements[0]); }},
      {"episodes[0].scene", [](auto& set) { set.episodes[0].scene = 1; }},
      {"episodes[0].first_placement", [](auto& set) { set.episodes[0].first_placement = 1; }},
      {"episodes[1].first_placement", [](auto& set) { set.episodes[1].placement_count = 2; }},
      {"episodes[1].first_placement",
       [](auto& set) { set.episodes[1].placement_count = 0xffffffffU; }},
      {"episodes[1].first_placement", [](auto& set) { set.episodes[1].placement_count = 0; }},
      {"episodes[0].target", [](auto& set) { set.episodes[0].target = 3; }},
      {"episodes[1].base_position", [](auto& set) { set.episodes[1].base_position.z = kNan; }},
      {"episodes[1].base_position", [](auto& set) { set.episodes[1].base_yaw = HUGE_VALF; }},
      {"episodes[0].goal", [](auto& set) { set.episodes[0].goal.rotation.x = 1; }},
      {"episodes",
       [](auto& set) {
         set.episodes.clear();
         set.placements.clear();
         set.start_positions.clear();
       }},
      {"", [](auto& set) { set.robot.clear(); }},
      {"", [](auto& set) { set.robot = "another"; }},
      {"", [](auto& set) { set.objects[1] = "zebra"; }},
      {"", [](auto& set) { set.episodes[0].target = 2; }},
      {"",
       [](auto& set) {
         set.placements[3].pose.rotation = {0, -0.6F, 0, -0.8F};
       }},
      {"", [](auto& set) { set.episodes[1].base_yaw = 1000; }},
      {"", [](auto& set) { set.start_positions[2] = -7; }},
  };
}

TEST(EpisodePack, RefusesExactlyWhatReadersRefuse) {
  std::size_t refused = 0;
  const auto all = changes();
  for (std::size_t n = 0; n < all.size(); ++n) {
    SCOPED_TRACE(fmt::format("change {}: {}", n, all[n].where));
    SourceEpisodes source = sourceOf(smallEpisodes());
    all[n].apply(source);
    const AlignedBytes file = buildPack(fieldsOf(source));
    const auto payload = encodeEpisodePack(source, provenance());
    EXPECT_EQ(payload.has_value(), PackFile::view(file.bytes(), "tidy.pack").has_value());
    const std::string where = all[n].where;
    EXPECT_EQ(payload.has_value(), where.empty());
    if (payload) continue;
    ++refused;
    EXPECT_EQ(payload.error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(payload.error().where, where);
    EXPECT_FALSE(payload.error().message.empty());
  }
  EXPECT_GE(10 * refused, all.size());
  EXPECT_LE(10 * refused, 9 * all.size());
}

TEST(EpisodePack, LeavesTheOldFileWhenTheEpisodesAreRefused) {
  const ScratchFolder folder;
  const auto path = folder.write("tidy.pack", "old");
  EXPECT_FALSE(writeEpisodePack(path, {}, provenance()).has_value());
  EXPECT_EQ(std::filesystem::file_size(path), 3U);
}

}  // namespace
}  // namespace galactic::test::episode_pack_test
