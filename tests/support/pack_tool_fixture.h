#pragma once
#include <filesystem>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include "support/packs/scene_pack_builder.h"
#include "support/scratch_folder.h"

namespace galactic::test {

/// Two grids over 5 x 3 columns whose content these tests know by heart: 11 spans in 5 columns, two
/// of them in overflow cells, and 3 spans in 2 columns.
[[nodiscard]] inline ScenePackFields kitchenScene() {
  ScenePackFields scene;
  scene.grids.emplace_back(GridBuilder(GridSpec{})
                               .column(0, 0, {{1, 2}})
                               .column(1, 0, {{1, 2}, {3, 4}})
                               .column(2, 1, {{1, 2}, {3, 4}, {5, 6}})
                               .column(4, 2, {{0, 8}})
                               .column(3, 2, {{0.5F, 1}, {1.5F, 2}, {2.5F, 3}, {3.5F, 4}})
                               .build());
  scene.grids.emplace_back(GridBuilder(GridSpec{.radius = 0.75F})
                               .column(0, 0, {{1, 2}, {3, 8}})
                               .column(4, 0, {{2, 7}})
                               .build());
  return scene;
}

/// Bytes as the text that ScratchFolder::write takes.
inline std::string_view asText(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Writes a scene pack into the folder and returns its path.
[[nodiscard]] inline std::filesystem::path writePack(const ScratchFolder& folder,
                                                     std::string_view name,
                                                     const ScenePackFields& fields) {
  return folder.write(name, asText(buildPack(fields).bytes()));
}

/// How many files and folders lie in a folder, to see that nothing is left behind.
inline std::size_t countEntries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

}  // namespace galactic::test
