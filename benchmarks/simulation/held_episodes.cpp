// Writes the episodes of a world with the target of each in the robot's hand at the start, so that
// the first grasp of an episode succeeds: the load "an object always held" of batch_steps.
//
//   held_episodes WORLD.pack OUT.pack
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/packs.h"
#include "galactic/batch_simulator.h"
#include "galactic/world.h"

namespace {

using galactic::EnvState;
using galactic::Episode;
using galactic::EpisodeSet;
using galactic::Error;
using galactic::Placement;
using galactic::Pose;
using galactic::Result;
using galactic::World;

std::vector<std::string> textOf(const std::vector<std::string_view>& names) {
  return {names.begin(), names.end()};
}

galactic::bake::SourceEpisodes sourceOf(const EpisodeSet& set) {
  galactic::bake::SourceEpisodes source{.name = std::string(set.name()) + "_held",
                                        .scenes = textOf(set.sceneNames()),
                                        .objects = textOf(set.objectNames()),
                                        .robot = std::string(set.robotName()),
                                        .start_joints = textOf(set.startJoints()),
                                        .start_positions = {},
                                        .placements = {},
                                        .episodes = {},
                                        .warnings = {}};
  for (std::size_t n = 0; n < set.episodes().size(); ++n) {
    const Episode& episode = set.episodes()[n];
    source.episodes.push_back(episode);
    const auto positions = set.startPositions(n);
    source.start_positions.insert(source.start_positions.end(), positions.begin(), positions.end());
    const auto placements = set.placements(episode);
    source.placements.insert(source.placements.end(), placements.begin(), placements.end());
  }
  return source;
}

Result<std::uint64_t> writeHeld(const std::filesystem::path& world_path,
                                const std::filesystem::path& out) {
  const Result<World> world = World::open(std::span(&world_path, 1));
  if (!world) return tl::unexpected<Error>(world.error());
  galactic::bake::SourceEpisodes source = sourceOf(world->episodes());
  galactic::SimulationOptions options;
  options.envs = static_cast<std::uint32_t>(source.episodes.size());
  options.order = galactic::EpisodeOrder::kPartition;
  const auto simulator = galactic::BatchSimulator::create(*world, options);
  if (!simulator) return tl::unexpected<Error>(simulator.error());
  for (std::size_t env = 0; env < options.envs; ++env) {
    const EnvState state = simulator->envState(env);
    const Episode& episode = source.episodes[state.episode];
    Placement& target = source.placements[episode.first_placement + episode.target];
    const Pose& object_from_box = world->objectOf(target).box.pose;
    target.pose.translation = state.world_from_grip.translation -
                              rotate(target.pose.rotation, object_from_box.translation);
  }
  galactic::bake::Provenance provenance;
  provenance.tool = "held_episodes";
  provenance.tool_version = "1";
  return galactic::bake::writeEpisodePack(out, source, provenance);
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int kArguments = 3;
  if (argc != kArguments) {
    fmt::print(stderr, "usage: held_episodes WORLD.pack OUT.pack\n");
    return galactic::kExitUsage;
  }
  const Result<std::uint64_t> bytes = writeHeld(argv[1], argv[2]);
  if (bytes) return galactic::kExitOk;
  fmt::print(stderr, "held_episodes: {}: {}\n", bytes.error().where, bytes.error().message);
  return static_cast<int>(bytes.error().code);
}
