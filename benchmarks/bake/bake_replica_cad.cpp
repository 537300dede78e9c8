// Composes the ReplicaCAD scene instances of an assets folder (one stage shell for all, every rigid
// object at its place, what is missing left out) and bakes a pack of each: the hundred real grids
// that the query benchmark runs on.
//
//   bake_replica_cad ASSETS/replica_cad OUT_FOLDER
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/scene_baker.h"

namespace galactic::bake {
namespace {

using Json = nlohmann::json;

Json readJson(const std::filesystem::path& path) {
  std::ifstream file(path);
  return Json::parse(file, nullptr, false);
}

/// world_from_object of an instance; its quaternion is (w, x, y, z).
Affine poseOf(const Json& instance) {
  const auto t = instance.value("translation", std::array<double, 3>{0, 0, 0});
  const auto [w, x, y, z] = instance.value("rotation", std::array<double, 4>{1, 0, 0, 0});
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     t[0],
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     t[1],
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), t[2]};
}

Affine compose(const Affine& a, const Affine& b) {
  Affine result{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = column == 3 ? a[row * 4 + 3] : 0;
      for (std::size_t k = 0; k < 3; ++k) sum += a[row * 4 + k] * b[k * 4 + column];
      result[row * 4 + column] = sum;
    }
  }
  return result;
}

class SceneComposer {
 public:
  explicit SceneComposer(std::filesystem::path dataset) : dataset_(std::move(dataset)) {}

  std::optional<SourceAsset> composeScene(const std::filesystem::path& instance_file) {
    const Json json = readJson(instance_file);
    if (!json.is_object()) return {};
    auto scene = importMesh(dataset_ / "stages/Stage_v3_sc1_staging.obj");
    if (!scene) return {};
    scene->name = instance_file.stem().stem().string();
    for (const Json& instance : json.value("object_instances", Json::array())) {
      place(instance, *scene);
    }
    return std::move(*scene);
  }

 private:
  void place(const Json& instance, SourceAsset& scene) {
    const std::filesystem::path name = instance.value("template_name", std::string());
    const auto& object = objectNamed(name.filename().string());
    if (!object) return;
    const auto first_mesh = static_cast<std::uint32_t>(scene.meshes.size());
    scene.meshes.insert(scene.meshes.end(), object->meshes.begin(), object->meshes.end());
    const Affine world_from_object = poseOf(instance);
    for (const SourceInstance& part : object->instances) {
      scene.instances.push_back(
          {part.name, first_mesh + part.mesh, compose(world_from_object, part.world_from_mesh)});
    }
  }

  const std::optional<SourceAsset>& objectNamed(const std::string& name) {
    const auto known = objects_.find(name);
    if (known != objects_.end()) return known->second;
    const std::filesystem::path config =
        dataset_ / "configs/objects" / (name + ".object_config.json");
    const Json json = readJson(config);
    std::optional<SourceAsset> object;
    for (const char* field : {"render_asset", "collision_asset"}) {
      if (object || !json.is_object() || !json.contains(field)) continue;
      auto asset = importMesh(config.parent_path() / json[field].get<std::string>());
      if (asset) object = std::move(*asset);
    }
    return objects_.emplace(name, std::move(object)).first->second;
  }

  std::filesystem::path dataset_;
  std::map<std::string, std::optional<SourceAsset>> objects_;
};

int bakeAll(const std::filesystem::path& dataset, const std::filesystem::path& out) {
  std::vector<std::filesystem::path> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(dataset / "configs/scenes")) {
    scenes.push_back(entry.path());
  }
  std::sort(scenes.begin(), scenes.end());
  std::filesystem::create_directories(out);
  SceneComposer composer(dataset);
  StageTimes times;
  SceneBakeOptions options;
  options.check_columns = 0;
  std::uint64_t bytes = 0;
  std::uint64_t triangles = 0;
  for (const std::filesystem::path& file : scenes) {
    const auto asset = composer.composeScene(file);
    if (!asset) continue;
    const auto scene = bakeScene(*asset, options, times, [](std::string_view, double) {});
    if (!scene) {
      fmt::print(stderr, "{}: {}\n", file.string(), scene.error().message);
      return 1;
    }
    triangles += scene->imported.triangles;
    const Provenance provenance{.tool = "bake_replica_cad",
                                .tool_version = "0.1.0",
                                .options = {},
                                .sources = asset->read.files,
                                .warnings = scene->warnings};
    const auto written = writeScenePack(out / (asset->name + ".pack"), *scene, provenance);
    if (!written) {
      fmt::print(stderr, "{}: {}\n", written.error().where, written.error().message);
      return 1;
    }
    bytes += *written;
  }
  fmt::print(
      "{} scenes, {} triangles, {:.1f} MB; columns {:.2f} s, regions {:.2f} s, encode {:.2f} "
      "s on one thread\n",
      scenes.size(), triangles, static_cast<double>(bytes) / 1e6, times.columns, times.regions,
      times.encode);
  return 0;
}

}  // namespace
}  // namespace galactic::bake

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: bake_replica_cad REPLICA_CAD_FOLDER OUT_FOLDER\n");
    return 1;
  }
  return galactic::bake::bakeAll(argv[1], argv[2]);
}
