// Any bytes as a configuration of a scene dataset: the first byte picks which file they are.
// Reading and composing have to give an error, or a scene that the bakers can take.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "dataset/scene_dataset.h"
#include "finding.h"
#include "support/scratch_folder.h"

namespace {

using galactic::bake::ComposedScene;
using galactic::test::expectGoodError;
using galactic::test::reportFinding;

void checkFinite(const galactic::bake::Affine& affine) {
  for (const double value : affine) {
    if (!std::isfinite(value)) reportFinding("a transform that is not finite");
  }
}

void checkScene(const ComposedScene& composed) {
  const auto& scene = composed.scene;
  for (const auto& instance : scene.instances) {
    if (instance.mesh >= scene.meshes.size()) reportFinding("an instance of no mesh");
    if (instance.name.empty()) reportFinding("an instance without a name");
    checkFinite(instance.world_from_mesh);
  }
  for (std::size_t i = 1; i < scene.read.files.size(); ++i) {
    if (scene.read.files[i - 1].name >= scene.read.files[i].name)
      reportFinding("files out of order");
  }
}

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr std::string_view kDataset = R"({
  "stages": {"paths": {".json": ["."]}}, "objects": {"paths": {".json": ["."]}},
  "articulated_objects": {"paths": {".urdf": ["."]}},
  "scene_instances": {"paths": {".json": ["."]}}})";
constexpr std::string_view kScene = R"({
  "stage_instance": {"template_name": "room"},
  "object_instances": [{"template_name": "box", "motion_type": "STATIC"}, {"template_name": "box"}],
  "articulated_object_instances": [{"template_name": "door"}]})";
/// A URDF of nothing but a root: what it says is the business of another target.
constexpr std::string_view kUrdf = R"(<robot name="door"><link name="root"/></robot>)";

struct Place {
  const char* file;
  std::string_view good;
};
constexpr std::array<Place, 5> kPlaces{{
    {"home.scene_dataset_config.json", kDataset},
    {"home.scene_instance.json", kScene},
    {"box.object_config.json", R"({"render_asset": "box.obj", "COM": [0, 0, 0]})"},
    {"room.stage_config.json", R"({"render_asset": "box.obj"})"},
    {"door.ao_config.json", R"({"urdf_filepath": "door.urdf"})"},
}};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const galactic::test::ScratchFolder folder;
  // The mesh and the URDF are read once: the fuzzer is about what surrounds them.
  static galactic::bake::MeshLibrary meshes(galactic::bake::datasetMeshOptions());
  static_cast<void>(folder.write("box.obj", kTriangle));
  static_cast<void>(folder.write("door.urdf", kUrdf));
  for (const Place& place : kPlaces) static_cast<void>(folder.write(place.file, place.good));
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  // A pattern may lead anywhere: not above the folder, which would be slow, and not repeatable.
  const std::size_t which = data[0] % kPlaces.size();
  if (which == 0 && text.find_first_of("*?[/\\") != std::string_view::npos) return 0;
  static_cast<void>(folder.write(kPlaces[which].file, text));
  const auto dataset =
      galactic::bake::SceneDataset::read(folder.path() / "home.scene_dataset_config.json");
  if (!dataset) {
    expectGoodError(dataset.error());
    return 0;
  }
  for (const std::string& name : dataset->scenes()) {
    const auto scene = dataset->compose(name, meshes);
    if (scene) {
      checkScene(*scene);
    } else {
      expectGoodError(scene.error());
    }
  }
  return 0;
}
