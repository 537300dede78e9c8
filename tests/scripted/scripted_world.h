#pragma once
#include <string>
#include <utility>
#include <vector>

#include "bake/episodes/made_world.h"
#include "galactic/bake/episode_generator.h"
#include "galactic/bake/packs.h"
#include "galactic/world.h"

namespace galactic::test {

/// A world whose packs lie in memory.
class ScriptedWorld {
 public:
  explicit ScriptedWorld(std::vector<MemoryPack> packs)
      : packs_(std::move(packs)), world_(openAll()) {}

  [[nodiscard]] const World& world() const { return world_; }

 private:
  [[nodiscard]] World openAll() const {
    std::vector<PackFile> files;
    files.reserve(packs_.size());
    for (const MemoryPack& pack : packs_) {
      files.push_back(MemoryPack::opened(PackFile::view(pack.bytes().bytes(), "made pack")));
    }
    return MemoryPack::opened(World::from(std::move(files)));
  }

  std::vector<MemoryPack> packs_;
  World world_;
};

inline MemoryPack episodePackOf(const bake::SourceEpisodes& episodes) {
  return {PackKind::kEpisodes,
          MemoryPack::opened(bake::encodeEpisodePack(episodes, testProvenance("episodes"))),
          "episodes"};
}

/// A made room with `robot`, which is called "stick", at `base`, and a cube at `cube` to be brought
/// to `goal`.
inline ScriptedWorld stickWorld(const bake::TriangleMesh& mesh, const Vec3& base, const Vec3& cube,
                                const Vec3& goal, const RobotPackFields& robot = stickRobot()) {
  Episode episode;
  episode.placement_count = 1;
  episode.base_position = base;
  episode.goal = {goal, {}};
  const bake::SourceEpisodes episodes{.name = "made",
                                      .scenes = {"room"},
                                      .objects = {"cube"},
                                      .robot = "stick",
                                      .start_joints = {},
                                      .start_positions = {},
                                      .placements = {{0, {cube, {}}}},
                                      .episodes = {episode},
                                      .warnings = {}};
  std::vector<MemoryPack> packs;
  packs.reserve(4);
  packs.push_back(scenePackOf(mesh));
  packs.push_back(cubePack());
  packs.emplace_back(buildPack(robot), "stick");
  packs.push_back(episodePackOf(episodes));
  return ScriptedWorld(std::move(packs));
}

/// The sample world with `count` generated episodes; baking takes seconds.
inline ScriptedWorld sampleWorld(std::uint32_t count, std::uint64_t seed) {
  std::vector<MemoryPack> packs;
  packs.reserve(4);
  packs.push_back(bakeSampleApartment());
  packs.push_back(bakeSampleObjects());
  packs.push_back(bakeSampleRobot());
  bake::EpisodeInputs inputs;
  inputs.packs = {&packs[0].pack(), &packs[1].pack(), &packs[2].pack()};
  bake::EpisodeGeneratorOptions options;
  options.episodes = count;
  options.seed = seed;
  packs.push_back(
      episodePackOf(MemoryPack::opened(bake::generateEpisodes(inputs, options)).episodes));
  return ScriptedWorld(std::move(packs));
}

}  // namespace galactic::test
