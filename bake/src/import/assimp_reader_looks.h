#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "galactic/bake/source_asset.h"

struct aiMaterial;
struct aiMesh;
struct aiScene;
struct aiString;

namespace galactic::bake {

/// The library's names of the readers that deliver materials or colors in ways of their own.
inline constexpr std::string_view kGltf2Reader = "glTF2 Importer";
inline constexpr std::string_view kObjReader = "Wavefront Object Importer";
inline constexpr std::string_view kOffReader = "OFF Importer";
inline constexpr std::string_view kPlyReader = "Stanford Polygon Library (PLY) Importer";

/// The looks of a scene that the library has read: its materials and images, and the texture
/// coordinates and colors of its meshes.
class SceneLooks {
 public:
  /// `reader` is the library's name of the reader that made `scene`; `scene` must outlive this.
  SceneLooks(const aiScene& scene, std::string_view reader);

  /// One value for each vertex of a mesh of the scene, or none at all; as in SourceMesh.
  [[nodiscard]] std::vector<std::array<float, 2>> uvsOf(const aiMesh& mesh) const;
  [[nodiscard]] std::vector<std::array<float, 4>> colorsOf(const aiMesh& mesh) const;

  /// Adds to `warnings` what is not used of them.
  [[nodiscard]] std::vector<SourceMaterial> materials(std::vector<std::string>& warnings) const;
  [[nodiscard]] std::vector<EmbeddedTexture> textures(std::vector<std::string>& warnings) const;

 private:
  [[nodiscard]] std::string imageOf(const aiString& texture) const;
  void convertAlpha(const aiMaterial& material, SourceMaterial& converted,
                    std::vector<std::string>& warnings) const;

  const aiScene& scene_;
  std::string_view reader_;
  /// For each material, whether any of its meshes has vertex colors.
  std::vector<bool> has_vertex_colors_;
};

}  // namespace galactic::bake
