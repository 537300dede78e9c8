#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace galactic::bake {

/// The name of what a file of Habitat describes: "v3_sc1_staging_05" of
/// "configs/scenes/v3_sc1_staging_05.scene_instance.json", "mesh" of "00001/mesh.basis.glb". Only
/// endings that Habitat's configurations and meshes have are taken off: names may have dots.
[[nodiscard]] std::string habitatName(std::string_view path);

/// Which of several objects is meant by an instance handle: "mug_:0002" is the third of "mug".
struct HabitatInstance {
  std::string object;
  std::size_t number = 0;
};

/// Nothing where `handle` is none.
[[nodiscard]] std::optional<HabitatInstance> habitatInstance(std::string_view handle);

}  // namespace galactic::bake
