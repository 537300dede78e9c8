#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "galactic/bake/render_baker.h"

namespace galactic::bake {

/// Whether the mesh's file defines its look by a named material, a texture or vertex colors.
[[nodiscard]] bool hasLooks(const SourceAsset& asset, const SourceMesh& mesh);

/// Collects the materials that a RenderSource uses, once each, while its meshes are placed.
class MaterialList {
 public:
  explicit MaterialList(RenderSource& source) : source_(source) {}

  /// Adds the material of a mesh of `asset`, without its texture if the mesh has no texture
  /// coordinates.
  std::uint32_t add(const SourceAsset& asset, const SourceMesh& mesh);

  /// Adds a plain color, linear RGBA.
  std::uint32_t addColor(const std::array<float, 4>& color, bool two_sided);

  /// Adds an image for meshes with texture coordinates, tinted by a linear RGBA. The path is
  /// relative to the folder of the robot's file.
  std::uint32_t addImage(const std::string& image, const std::array<float, 4>& tint,
                         bool two_sided);

  /// Bakes the materials added since the last call, like bakeMaterials. `files`: the images of the
  /// asset that they came from.
  Result<void> bake(const TextureFiles& files, const TextureBakeOptions& options, unsigned threads,
                    TextureLibrary* library);

 private:
  std::uint32_t append(SourceMaterial material);

  RenderSource& source_;
  std::map<std::pair<std::array<float, 4>, bool>, std::uint32_t> colors_;
  std::map<std::tuple<std::string, std::array<float, 4>, bool>, std::uint32_t> images_;
  /// Materials of the current asset, by material and whether its texture is left out.
  std::map<std::pair<std::uint32_t, bool>, std::uint32_t> of_asset_;
};

}  // namespace galactic::bake
