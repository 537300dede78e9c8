#pragma once
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/mesh_import.h"
#include "galactic/bake/packs.h"
#include "galactic/bake/robot_import.h"
#include "galactic/bake/robot_recipe.h"
#include "galactic/object_set.h"
#include "galactic/robot.h"
#include "galactic/scene.h"
#include "support/aligned_bytes.h"
#include "support/build_paths.h"
#include "support/packs/pack_parts.h"
#include "support/packs/scene_pack_builder.h"

namespace galactic::test {

/// A pack in memory.
class MemoryPack {
 public:
  MemoryPack(PackKind kind, const std::vector<std::byte>& payload, const std::string& name)
      : MemoryPack(packFile(kind, payload), name) {}

  MemoryPack(AlignedBytes bytes, const std::string& name)
      : bytes_(std::move(bytes)), pack_(opened(PackFile::view(bytes_.bytes(), name))) {}

  [[nodiscard]] const PackFile& pack() const { return pack_; }
  [[nodiscard]] const AlignedBytes& bytes() const { return bytes_; }

  /// What the result holds; throws its error otherwise, which fails the test.
  template <class T>
  static T opened(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().text());
    return std::move(*result);
  }

 private:
  AlignedBytes bytes_;
  PackFile pack_;
};

/// A provenance that a pack is accepted with.
inline bake::Provenance testProvenance(const std::string& input) {
  bake::Provenance provenance;
  provenance.tool_version = "0.1.0";
  provenance.sources.push_back({input, 1234, 1, 2});
  return provenance;
}

/// The apartment of packs/sample as a scene pack; 0.3 s.
inline MemoryPack bakeSampleApartment() {
  const std::filesystem::path folder = test::sourceFolder() / "packs/sample";
  const auto asset = MemoryPack::opened(bake::importMesh(folder / "apartment.glb"));
  bake::SceneBakeOptions options;
  options.check_columns = 0;
  bake::StageTimes times;
  const auto silent = [](std::string_view, double) {};
  const auto scene = MemoryPack::opened(bake::bakeScene(asset, options, times, silent));
  return {PackKind::kScene,
          MemoryPack::opened(bake::encodeScenePack(scene, testProvenance("apartment.glb"))),
          "apartment"};
}

/// The objects of packs/sample as an object pack; some seconds.
inline MemoryPack bakeSampleObjects() {
  const std::filesystem::path folder = test::sourceFolder() / "packs/sample";
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "objects")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  bake::MeshImportOptions import;
  import.smallest_size = 0;
  bake::BakedObjectSet set{.radii = {0.015F, 0.05F, 0.12F}, .objects = {}};
  for (const std::filesystem::path& file : files) {
    const auto asset = MemoryPack::opened(bake::importMesh(file, import));
    bake::ObjectBakeOptions options;
    options.spheres.radii = set.radii;
    set.objects.push_back(MemoryPack::opened(bake::bakeObject(asset, options)));
  }
  return {PackKind::kObjects,
          MemoryPack::opened(bake::encodeObjectPack(set, testProvenance("apple.glb"))), "objects"};
}

/// The robot of packs/sample as a robot pack; some seconds.
inline MemoryPack bakeSampleRobot() {
  const std::filesystem::path folder = test::sourceFolder() / "packs/sample/robot";
  const auto source = MemoryPack::opened(bake::importRobot(folder / "porter.urdf"));
  const auto recipe = MemoryPack::opened(bake::readRobotRecipe(folder / "robot.toml"));
  const auto robot = MemoryPack::opened(bake::bakeRobot(source, &recipe, {}));
  if (!source.warnings.empty() || !robot.warnings.empty()) {
    throw std::runtime_error("the sample robot bakes with warnings");
  }
  return {PackKind::kRobot,
          MemoryPack::opened(bake::encodeRobotPack(robot, testProvenance("porter.urdf"))),
          "porter"};
}

}  // namespace galactic::test
