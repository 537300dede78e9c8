#pragma once
#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "galactic/bake/episode_generator.h"
#include "galactic/bake/episode_set_import.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/triangle_mesh.h"
#include "galactic/batch_simulator.h"
#include "support/homes/sample_world.h"

namespace galactic::test {

/// The objects and the robot of packs/sample, baked once: it takes seconds.
struct SampleThings {
  MemoryPack objects = bakeSampleObjects();
  MemoryPack robot = bakeSampleRobot();
};

/// A scene of triangles, and the published episodes that take place in it; generated ones where
/// there is no such file.
struct HomeFiles {
  std::filesystem::path mesh;
  std::filesystem::path episodes{};
};

/// A world in a scene of triangles, with the things of packs/sample. In every second episode the
/// robot begins with an apple between its fingers.
class Home {
 public:
  Home(const HomeFiles& files, const SampleThings& things)
      : Home(importYUp(files.mesh), files.episodes, things) {}

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] const bake::TriangleMesh& mesh() const { return mesh_; }

 private:
  Home(const bake::SourceAsset& asset, const std::filesystem::path& episodes_file,
       const SampleThings& things)
      : mesh_(MemoryPack::opened(bake::placeAndClean(asset)).mesh),
        things_(things),
        scene_(bakeScenePack(asset)) {
    bake::SourceEpisodes episodes =
        episodes_file.empty() ? generate() : readPublished(episodes_file);
    episodes_.emplace(PackKind::kEpisodes, encoded(episodes), "episodes");
    world_.emplace(open());
    putApplesInHands(episodes);
    world_.reset();
    episodes_.emplace(PackKind::kEpisodes, encoded(episodes), "episodes");
    world_.emplace(open());
  }

  static bake::SourceAsset importYUp(const std::filesystem::path& file) {
    bake::MeshImportOptions options;
    options.up = bake::UpAxis::kY;
    return MemoryPack::opened(bake::importMesh(file, options));
  }

  static MemoryPack bakeScenePack(const bake::SourceAsset& asset) {
    bake::SceneBakeOptions options;
    options.check_columns = 0;
    bake::StageTimes times;
    const auto silent = [](std::string_view, double) {};
    const auto scene = MemoryPack::opened(bake::bakeScene(asset, options, times, silent));
    return {PackKind::kScene,
            MemoryPack::opened(bake::encodeScenePack(scene, testProvenance("scene"))), "scene"};
  }

  static std::vector<std::byte> encoded(const bake::SourceEpisodes& episodes) {
    return MemoryPack::opened(bake::encodeEpisodePack(episodes, testProvenance("episodes")));
  }

  [[nodiscard]] bake::SourceEpisodes generate() const {
    bake::EpisodeInputs inputs;
    inputs.packs = {&scene_.pack(), &things_.objects.pack(), &things_.robot.pack()};
    bake::EpisodeGeneratorOptions options;
    options.episodes = 40;
    return MemoryPack::opened(bake::generateEpisodes(inputs, options)).episodes;
  }

  /// Robots and objects where the file has them, but they are others.
  [[nodiscard]] bake::SourceEpisodes readPublished(const std::filesystem::path& file) const {
    bake::SourceEpisodes episodes = MemoryPack::opened(bake::readEpisodeSet(file));
    const Scene scene = MemoryPack::opened(Scene::from(scene_.pack()));
    const auto objects = MemoryPack::opened(ObjectSet::from(things_.objects.pack()));
    episodes.scenes = {std::string(scene.name())};
    episodes.robot.clear();
    episodes.start_joints.clear();
    episodes.start_positions.clear();
    episodes.objects.clear();
    for (const ObjectModel& object : objects.objects()) {
      episodes.objects.emplace_back(object.name);
    }
    const auto count = static_cast<std::uint32_t>(episodes.objects.size());
    for (Placement& placement : episodes.placements) placement.object %= count;
    return episodes;
  }

  [[nodiscard]] World open() const {
    std::vector<PackFile> packs;
    packs.reserve(4);
    for (const MemoryPack* pack : {&scene_, &things_.objects, &things_.robot, &*episodes_}) {
      packs.push_back(MemoryPack::opened(PackFile::view(pack->bytes().bytes(), "pack")));
    }
    return MemoryPack::opened(World::from(std::move(packs)));
  }

  void putApplesInHands(bake::SourceEpisodes& episodes) const {
    SimulationOptions options;
    options.envs = static_cast<std::uint32_t>(episodes.episodes.size());
    options.threads = 1;
    options.order = EpisodeOrder::kLinear;
    const auto simulator = MemoryPack::opened(BatchSimulator::create(*world_, options));
    const auto apple = std::find(episodes.objects.begin(), episodes.objects.end(), "apple");
    if (apple == episodes.objects.end()) return;
    for (std::size_t env = 0; env < options.envs; env += 2) {
      const EnvState state = simulator.envState(env);
      const Episode& episode = episodes.episodes[state.episode];
      Placement& target = episodes.placements[episode.first_placement + episode.target];
      target.object = static_cast<std::uint32_t>(apple - episodes.objects.begin());
      const Vec3 middle = world_->objectOf(target).box.pose.translation;
      target.pose = {state.world_from_grip.translation - middle, {}};
    }
  }

  bake::TriangleMesh mesh_;
  const SampleThings& things_;
  MemoryPack scene_;
  std::optional<MemoryPack> episodes_;
  std::optional<World> world_;
};

}  // namespace galactic::test
