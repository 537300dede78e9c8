#pragma once
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include "support/scene_pack_builder.h"
#include "support/scratch_folder.h"

namespace galactic::test {

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

/// The whole content of a file; empty when there is none.
inline std::string readBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// How many files and folders lie in a folder, to see that nothing is left behind.
inline std::size_t countEntries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

}  // namespace galactic::test
