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

/// An encoded image that materials name, or the reason why it is missing.
struct TextureSource {
  /// The name that the first material gives it.
  std::string name;
  /// Name of the first material that uses it, for warnings.
  std::string material;
  std::optional<MappedFile> file;
  std::span<const std::byte> bytes;
  /// End of a sentence that begins with "the image"; empty if there are bytes.
  std::string fault;
  /// Whether the importer has already reported the fault.
  bool fault_is_known = false;
};

/// The distinct images of a list of materials. Equal files under several names count once.
struct TextureSources {
  std::vector<TextureSource> sources;
  /// For each material, the index of its image; none if it has no texture.
  std::vector<std::optional<std::size_t>> of_material;
};

/// Opens the images that the materials name. Embedded images must outlive the result.
[[nodiscard]] TextureSources openTextures(std::span<const SourceMaterial> materials,
                                          const TextureFiles& files);

}  // namespace galactic::bake
