#include "support/packs/episode_pack_builder.h"

#include "support/packs/schema_parts.h"

namespace galactic::test {

EpisodePackFields smallEpisodes() {
  const Quat tilted{0, 0.6F, 0, 0.8F};
  EpisodePackFields fields;
  fields.start_positions = {0.5F, 0.125F, -0.5F, 0.25F};
  fields.placements = {{0, {{0.5F, 1, 0.5F}, {}}},
                       {1, {{1.5F, 1, 0.5F}, tilted}},
                       {1, {{2.5F, 1, 0.5F}, {}}},
                       {0, {{0.5F, 1.5F, 1.5F}, tilted}}};
  fields.episodes.resize(2);
  fields.episodes[0] = {.scene = 0,
                        .first_placement = 0,
                        .placement_count = 3,
                        .target = 1,
                        .base_position = {0.5F, 1, 0.25F},
                        .base_yaw = 1.5F,
                        .goal = {{2.5F, 1.25F, 1.5F}, tilted}};
  fields.episodes[1] = {.scene = 0,
                        .first_placement = 3,
                        .placement_count = 1,
                        .target = 0,
                        .base_position = {1.5F, 1, 0.75F},
                        .base_yaw = -3,
                        .goal = {{3.5F, 1.25F, 1.5F}, {}}};
  return fields;
}

AlignedBytes buildPack(const EpisodePackFields& fields) {
  flatbuffers::FlatBufferBuilder builder;
  const auto name = builder.CreateString(fields.name);
  const auto scenes = builder.CreateVectorOfStrings(fields.scenes);
  const auto objects = builder.CreateVectorOfStrings(fields.objects);
  const auto robot = builder.CreateString(fields.robot);
  const auto start_joints = builder.CreateVectorOfStrings(fields.start_joints);
  const auto start_positions = alignedNumbers(builder, fields.start_positions);
  std::vector<schema::Placement> placements;
  for (const Placement& placement : fields.placements) {
    placements.emplace_back(placement.object, stored(placement.pose));
  }
  const auto placement_vector = alignedStructs(builder, placements);
  std::vector<schema::Episode> episodes;
  for (const Episode& episode : fields.episodes) {
    episodes.emplace_back(episode.scene, episode.first_placement, episode.placement_count,
                          episode.target, stored(episode.base_position), episode.base_yaw,
                          stored(episode.goal));
  }
  const auto episode_vector = alignedStructs(builder, episodes);
  const auto set = schema::CreateEpisodeSet(builder, name, scenes, objects, robot, start_joints,
                                            start_positions, placement_vector, episode_vector);
  return finishFile(builder, fields.kind, schema::Asset::EpisodeSet, set.Union());
}

}  // namespace galactic::test
