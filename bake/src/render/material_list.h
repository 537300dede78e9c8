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

/// Whether the file of a mesh says what it looks like: by a named material, a texture or vertex
/// colors.
[[nodiscard]] bool hasLooks(const SourceAsset& asset, const SourceMesh& mesh);

/// The materials of a RenderSource while its meshes are placed: those that are used, once each.
class MaterialList {
 public:
  explicit MaterialList(RenderSource& source) : source_(source) {}

  /// The material of a mesh of `asset`; without its texture when the mesh does not say where on it.
  std::uint32_t add(const SourceAsset& asset, const SourceMesh& mesh);

  /// A plain color, linear RGBA.
  std::uint32_t addColor(const std::array<float, 4>& color, bool two_sided);

  /// An image on a mesh of texture coordinates, tinted by a linear RGBA; its path is relative to
  /// the folder of the robot's file.
  std::uint32_t addImage(const std::string& image, const std::array<float, 4>& tint,
                         bool two_sided);

  /// Bakes what was added since the last call, as bakeMaterials does; `files`: the images of the
  /// asset that it came from.
  Result<void> bake(const TextureFiles& files, const TextureBakeOptions& options, unsigned threads,
                    TextureLibrary* library);

 private:
  std::uint32_t append(SourceMaterial material);

  RenderSource& source_;
  std::map<std::pair<std::array<float, 4>, bool>, std::uint32_t> colors_;
  std::map<std::tuple<std::string, std::array<float, 4>, bool>, std::uint32_t> images_;
  /// Of the asset at hand: by material, and whether without its texture.
  std::map<std::pair<std::uint32_t, bool>, std::uint32_t> of_asset_;
};

}  // namespace galactic::bake
