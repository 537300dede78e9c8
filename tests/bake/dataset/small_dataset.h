#pragma once
// A scene dataset written by the tests, with one of everything that configurations may say.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/scene_dataset.h"
#include "support/mesh_files.h"
#include "support/scratch_folder.h"

namespace galactic::test {

/// The dataset's folder lies inside the scratch folder, so that paths may lead out of it.
class SmallDataset {
 public:
  SmallDataset() {
    write("home.scene_dataset_config.json", kConfig);
    write("configs/stages/room.stage_config.json",
          R"({"render_asset": "../../meshes/room.obj", "up": [0, 1, 0], "front": [0, 0, -1]})");
    write(
        "configs/objects/big/table.object_config.json",
        R"({"render_asset": "../../../meshes/box.obj", "COM": [0.25, 0.5, 2], "semantic_id": 7})");
    write("configs/objects/big/shelf.object_config.json",
          R"({"render_asset": "../../../meshes/box.obj", "scale": [0.5, 2, 1.5],
              "up": [0, 0, 1], "front": [0, 1, 0], "unknown_key": {"to": ["us"]}})");
    write("configs/objects/small/cup.object_config.json",
          R"({"collision_asset": "../../../meshes/box.obj", "is_collidable": false})");
    write("configs/objects/small/ghost.object_config.json",
          R"({"render_asset": "../../../meshes/ghost.glb"})");
    write("meshes/box.obj", objFile(unevenBox(), "mtllib box.mtl\nusemtl wood\n"));
    write("meshes/box.mtl", "newmtl wood\nKd 0.5 0.25 0.125\n");
    write("meshes/room.obj", objFile(unevenBox()));
    write("bare/crate.glb", glbFile(unevenBox()));
    write("urdf/cupboard/cupboard.urdf", kCupboard);
    write("urdf/cupboard/door.obj", objFile(unevenBox()));
    write("urdf/cupboard/cupboard.ao_config.json", R"({"uniform_scale": 2})");
    writeScene("a_home", kScene);
  }

  [[nodiscard]] std::filesystem::path folder() const { return scratch_.path() / "home"; }
  [[nodiscard]] std::filesystem::path config() const {
    return folder() / "home.scene_dataset_config.json";
  }
  std::filesystem::path write(std::string_view name, std::string_view content) const {
    return scratch_.write("home/" + std::string(name), content);
  }
  void writeScene(const std::string& name, std::string_view content) const {
    write("scenes/" + name + ".scene_instance.json", content);
  }
  [[nodiscard]] const ScratchFolder& scratch() const { return scratch_; }

  static constexpr std::string_view kConfig = R"({
    "stages": {
      "default_attributes": {"margin": 0.03},
      "paths": {".json": ["configs/stages"]}
    },
    "objects": {
      "default_attributes": {"force_flat_shading": true},
      "paths": {
        ".json": ["configs/objects/*/", "../elsewhere/*.object_config.json"],
        ".glb": ["bare/cr[aeiou]te.glb"]
      },
      "configs": [
        {"original_file": "table.object_config.json", "template_handle": "high_table",
         "attributes": {"scale": [1, 3, 1]}},
        {"template_handle": "made_here",
         "attributes": {"render_asset": "meshes/box.obj", "COM": [0, 0, 0]}},
        {"original_file": "configs/objects/small/cup", "attributes": {"COM": [1, 1, 1]}},
        {"original_file": "nowhere", "attributes": {}}
      ]
    },
    "articulated_objects": {"paths": {".urdf": ["urdf/*/"]}},
    "light_setups": {"paths": {".json": ["lights"]}},
    "scene_instances": {
      "default_attributes": {"translation_origin": "asset_local"},
      "paths": {".json": ["scenes"]}
    },
    "navmesh_instances": {"a_home": "navmeshes/a_home.navmesh"}
  })";

  static constexpr std::string_view kScene = R"({
    "stage_instance": {"template_name": "configs/stages/room"},
    "default_lighting": "lights/day",
    "object_instances": [
      {"template_name": "table", "motion_type": "STATIC", "translation": [1, 0, 2],
       "rotation": [0.7071067811865476, 0, 0.7071067811865476, 0], "translation_origin": "COM"},
      {"template_name": "table", "motion_type": "KINEMATIC", "translation": [3, 0, 2]},
      {"template_name": "crate", "motion_type": "STATIC", "uniform_scale": 0.5},
      {"template_name": "high_table", "motion_type": "STATIC"},
      {"template_name": "made_here", "motion_type": "static"},
      {"template_name": "cup", "motion_type": "DYNAMIC", "translation": [0, 1, 0],
       "translation_origin": "com"},
      {"template_name": "shelf"},
      {"template_name": "ghost", "motion_type": "STATIC"},
      {"template_name": "ghost", "motion_type": "STATIC"},
      {"template_name": "lamp", "motion_type": "STATIC"}
    ],
    "articulated_object_instances": [
      {"template_name": "cupboard", "motion_type": "DYNAMIC", "fixed_base": true,
       "translation": [0, 1, 0], "uniform_scale": 0.5, "translation_origin": "COM"}
    ]
  })";

  /// A base that is a box, and a door that hangs 1 m along x and can open by 0.5 to 1.5 rad about
  /// z.
  static constexpr std::string_view kCupboard = R"(<robot name="cupboard">
    <link name="root"/>
    <link name="base"><visual><origin xyz="0 0 1"/><geometry><box size="1 2 3"/></geometry></visual></link>
    <link name="door"><visual><geometry><mesh filename="door.obj" scale="1 1 2"/></geometry></visual>
      <visual><geometry><mesh filename="handle.glb"/></geometry></visual></link>
    <joint name="fixing" type="fixed"><parent link="root"/><child link="base"/></joint>
    <joint name="hinge" type="revolute"><parent link="base"/><child link="door"/>
      <origin xyz="1 0 0"/><axis xyz="0 0 1"/>
      <limit lower="0.5" upper="1.5" effort="1" velocity="1"/></joint>
  </robot>)";

 private:
  ScratchFolder scratch_;
};

/// The 8 corners that unevenBox() has in its file, in its order.
inline std::vector<std::array<double, 3>> boxCorners() {
  std::vector<std::array<double, 3>> corners;
  for (const auto& p : unevenBox().positions) {
    corners.push_back(
        {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  return corners;
}

/// How far the farthest corner of `mesh` is from the nearest of `corners`, and the other way round.
inline double farthestCorner(const std::vector<std::array<double, 3>>& found,
                             const std::vector<std::array<double, 3>>& wanted) {
  const auto one_way = [](const auto& from, const auto& to) {
    double farthest = from.empty() || to.empty() ? 1e9 : 0;
    for (const auto& a : from) {
      double nearest = 1e9;
      for (const auto& b : to) {
        nearest = std::min(nearest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
      }
      farthest = std::max(farthest, nearest);
    }
    return farthest;
  };
  return std::max(one_way(found, wanted), one_way(wanted, found));
}

/// The vertices that an instance of `scene` places, world frame.
inline std::vector<std::array<double, 3>> placedVertices(const bake::SourceAsset& scene,
                                                         const bake::SourceInstance& instance) {
  std::vector<std::array<double, 3>> placed;
  const bake::Affine& m = instance.world_from_mesh;
  for (const Vec3& p : scene.meshes.at(instance.mesh).positions) {
    std::array<double, 3>& to = placed.emplace_back();
    for (std::size_t row = 0; row < 3; ++row) {
      to[row] = m[4 * row] * static_cast<double>(p.x) + m[4 * row + 1] * static_cast<double>(p.y) +
                m[4 * row + 2] * static_cast<double>(p.z) + m[4 * row + 3];
    }
  }
  return placed;
}

}  // namespace galactic::test
