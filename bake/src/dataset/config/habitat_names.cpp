#include "galactic/bake/habitat_names.h"

#include <array>

#include "common/lower_case.h"

namespace galactic::bake {

std::string habitatName(std::string_view path, std::string_view extension) {
  // The longer ones first.
  constexpr std::array<std::string_view, 14> kEndings{
      kSceneSuffix, kObjectSuffix, kStageSuffix, kArticulatedSuffix,
      kBasisSuffix, ".json",       ".glb",       ".gltf",
      ".obj",       ".ply",        ".dae",       ".stl",
      ".fbx",       ".urdf"};
  path.remove_prefix(path.find_last_of("/\\") + 1);
  const auto without = [path](std::string_view ending) {
    return std::string(path.substr(0, path.size() - ending.size()));
  };
  const std::string lower = lowerCase(path);
  for (const std::string_view ending : kEndings) {
    if (lower.size() > ending.size() && lower.ends_with(ending)) return without(ending);
  }
  const bool has_extension = path.size() > extension.size() && path.ends_with(extension);
  return has_extension ? without(extension) : std::string(path);
}

}  // namespace galactic::bake
