#include <array>
#include <charconv>
#include <cstdint>
#include <system_error>

#include "episodes/import/episode_readers.h"

namespace galactic::bake {

std::string habitatName(std::string_view path) {
  // The longer ones first.
  constexpr std::array<std::string_view, 11> kEndings{".scene_instance.json",
                                                      ".object_config.json",
                                                      ".stage_config.json",
                                                      ".basis.glb",
                                                      ".json",
                                                      ".glb",
                                                      ".gltf",
                                                      ".obj",
                                                      ".ply",
                                                      ".dae",
                                                      ".stl"};
  path.remove_prefix(path.find_last_of("/\\") + 1);
  for (const std::string_view ending : kEndings) {
    if (path.size() <= ending.size() || !path.ends_with(ending)) continue;
    path.remove_suffix(ending.size());
    break;
  }
  return std::string(path);
}

std::optional<HabitatInstance> habitatInstance(std::string_view handle) {
  constexpr std::string_view kMark = "_:";
  const std::size_t mark = handle.rfind(kMark);
  if (mark == std::string_view::npos) return std::nullopt;
  const std::string_view digits = handle.substr(mark + kMark.size());
  std::uint32_t number = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (problem != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return HabitatInstance{habitatName(handle.substr(0, mark)), number};
}

}  // namespace galactic::bake
