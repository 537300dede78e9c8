#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "galactic/bake/render_textures.h"
#include "galactic/bake/source_asset.h"
#include "support/files/mapped_file.h"

namespace galactic::bake {

/// An encoded image that materials name, or why there is none.
struct TextureSource {
  /// As the first material names it.
  std::string name;
  /// Name of the first material that uses it, for warnings.
  std::string material;
  std::optional<MappedFile> file;
  std::span<const std::byte> bytes;
  /// End of a sentence that begins "the image"; empty when there are bytes.
  std::string fault;
  /// The importer has told of the fault.
  bool fault_is_known = false;
};

/// The distinct images of a list of materials: equal files under several names count once.
struct TextureSources {
  std::vector<TextureSource> sources;
  /// For each material the index of its image; none where it has no texture.
  std::vector<std::optional<std::size_t>> of_material;
};

/// Opens what the materials name. What is embedded must outlive the result.
[[nodiscard]] TextureSources openTextures(std::span<const SourceMaterial> materials,
                                          const TextureFiles& files);

}  // namespace galactic::bake
