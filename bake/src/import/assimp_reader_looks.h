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

/// Readers of the library, by its names, that deliver looks in ways of their own.
inline constexpr std::string_view kGltf2Reader = "glTF2 Importer";
inline constexpr std::string_view kObjReader = "Wavefront Object Importer";
inline constexpr std::string_view kOffReader = "OFF Importer";
inline constexpr std::string_view kPlyReader = "Stanford Polygon Library (PLY) Importer";

/// What the surfaces look like of a scene that the library has read: its materials and images, and
/// the texture coordinates and colors of its meshes.
class SceneLooks {
 public:
  /// `reader`: the library's name of the one that made `scene`, which has to live as long.
  SceneLooks(const aiScene& scene, std::string_view reader);

  /// One for each vertex of a mesh of the scene, or none; as SourceMesh has them.
  [[nodiscard]] std::vector<std::array<float, 2>> uvsOf(const aiMesh& mesh) const;
  [[nodiscard]] std::vector<std::array<float, 4>> colorsOf(const aiMesh& mesh) const;

  /// What is not used of them is told in `warnings`.
  [[nodiscard]] std::vector<SourceMaterial> materials(std::vector<std::string>& warnings) const;
  [[nodiscard]] std::vector<EmbeddedTexture> textures(std::vector<std::string>& warnings) const;

 private:
  [[nodiscard]] std::string imageOf(const aiString& texture) const;
  void convertAlpha(const aiMaterial& material, SourceMaterial& converted,
                    std::vector<std::string>& warnings) const;

  const aiScene& scene_;
  std::string_view reader_;
  /// Whether some mesh of the material has colors of its own, for each material.
  std::vector<bool> has_vertex_colors_;
};

}  // namespace galactic::bake
