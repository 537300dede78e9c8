#include "import/assimp_reader_looks.h"

#include <assimp/GltfMaterial.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "common/srgb.h"

namespace galactic::bake {
namespace {

std::string text(const aiString& string) { return {string.C_Str()}; }

float unitInterval(float value) { return std::isfinite(value) ? std::clamp(value, 0.F, 1.F) : 1.F; }

// The glTF reader delivers base colors as diffuse ones as well, except for materials with
// KHR_materials_pbrSpecularGlossiness: there the diffuse ones are those of the extension, which
// take precedence.

aiColor4D colorOf(const aiMaterial& material, std::string_view reader) {
  aiColor4D color(1, 1, 1, 1);
  const bool is_gltf = reader == kGltf2Reader;
  if (is_gltf && material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS) return color;
  if (material.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS || is_gltf) return color;
  material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  return color;
}

/// A material's color texture is the first of these that it has.
std::pair<aiTextureType, aiTextureType> colorTexturesOf(std::string_view reader) {
  if (reader == kGltf2Reader) return {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR};
  return {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
}

/// Whether `color` cannot be meant as a factor for a texture or vertex colors: it is black, or what
/// the readers of OBJ and OFF set if the file states no color.
bool isNoFactor(const aiColor4D& color, std::string_view reader) {
  if (reader == kGltf2Reader) return false;
  constexpr float kUnstated = 0.6F;
  const auto all = [&](float value) {
    return color.r == value && color.g == value && color.b == value;
  };
  return all(0) || ((reader == kObjReader || reader == kOffReader) && all(kUnstated));
}

/// Whether vertex colors are those on a screen (sRGB), as scanners and viewers write them. In glTF
/// they are linear.
bool storesScreenColors(std::string_view reader) {
  return reader == kPlyReader || reader == kObjReader || reader == kOffReader;
}

/// Makes colors linear that are those on a screen, from 0 to 1 or, if some are larger, from 0 to
/// 255.
void makeLinear(std::vector<std::array<float, 4>>& colors) {
  constexpr float kOneAndRounding = 1.01F;
  const bool are_bytes = std::ranges::any_of(
      colors, [](const auto& color) { return *std::ranges::max_element(color) > kOneAndRounding; });
  const double one = are_bytes ? 255 : 1;
  for (std::array<float, 4>& color : colors) {
    for (float& channel : std::span(color).first(3)) {
      channel =
          static_cast<float>(srgbDecoded(std::clamp(static_cast<double>(channel) / one, 0.0, 1.0)));
    }
    // For files without alpha, readers set 1, even where the colors are bytes.
    if (color[3] > kOneAndRounding) color[3] /= 255;
  }
}

}  // namespace

SceneLooks::SceneLooks(const aiScene& scene, std::string_view reader)
    : scene_(scene), reader_(reader), has_vertex_colors_(scene.mNumMaterials) {
  for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
    const bool has_colors = mesh->HasVertexColors(0);
    if (has_colors && mesh->mMaterialIndex < has_vertex_colors_.size()) {
      has_vertex_colors_[mesh->mMaterialIndex] = true;
    }
  }
}

std::vector<std::array<float, 2>> SceneLooks::uvsOf(const aiMesh& mesh) const {
  std::vector<std::array<float, 2>> uvs;
  if (mesh.mVertices == nullptr || !mesh.HasTextureCoords(0)) return uvs;
  uvs.reserve(mesh.mNumVertices);
  for (const aiVector3D& v : std::span(mesh.mTextureCoords[0], mesh.mNumVertices)) {
    uvs.push_back({v.x, v.y});
  }
  return uvs;
}

std::vector<std::array<float, 4>> SceneLooks::colorsOf(const aiMesh& mesh) const {
  std::vector<std::array<float, 4>> colors;
  if (mesh.mVertices == nullptr || !mesh.HasVertexColors(0)) return colors;
  colors.reserve(mesh.mNumVertices);
  for (const aiColor4D& c : std::span(mesh.mColors[0], mesh.mNumVertices)) {
    colors.push_back({c.r, c.g, c.b, c.a});
  }
  if (storesScreenColors(reader_)) makeLinear(colors);
  return colors;
}

/// A material's texture, named as in SourceMaterial. Some FBX and COLLADA files embed an image and
/// refer to it by its file name; this finds the embedded one. glTF refers to embedded images
/// itself.
std::string SceneLooks::imageOf(const aiString& texture) const {
  std::string name = text(texture);
  if (name.empty() || name.starts_with('*') || reader_ == kGltf2Reader) return name;
  const int embedded = scene_.GetEmbeddedTextureAndIndex(name.c_str()).second;
  return embedded < 0 ? name : fmt::format("*{}", embedded);
}

/// glTF states what its alpha means. For other formats a factor counts only if it is strictly
/// between 0 and 1: files do not agree which end is opaque, and nobody publishes invisible
/// surfaces.
void SceneLooks::convertAlpha(const aiMaterial& material, SourceMaterial& converted,
                              std::vector<std::string>& warnings) const {
  aiString string;
  if (reader_ == kGltf2Reader) {
    if (material.Get(AI_MATKEY_GLTF_ALPHAMODE, string) != AI_SUCCESS) return;
    if (text(string) == "MASK") converted.alpha_mode = AlphaMode::kMask;
    if (text(string) == "BLEND") converted.alpha_mode = AlphaMode::kBlend;
    float cutoff = converted.alpha_cutoff;
    material.Get(AI_MATKEY_GLTF_ALPHACUTOFF, cutoff);
    converted.alpha_cutoff = unitInterval(cutoff);
    return;
  }
  float opacity = 1;
  material.Get(AI_MATKEY_OPACITY, opacity);
  converted.base_color[3] = 1;
  if (opacity > 0 && opacity < 1) {
    converted.base_color[3] = opacity;
    converted.alpha_mode = AlphaMode::kBlend;
  }
  if (material.GetTexture(aiTextureType_OPACITY, 0, &string) != AI_SUCCESS) return;
  if (imageOf(string) == converted.base_color_texture) {
    converted.alpha_mode = AlphaMode::kBlend;
  } else {
    warnings.push_back(fmt::format(
        "the opacity texture '{}' of material '{}' is not used; put opacity into the alpha of "
        "its color texture",
        text(string), converted.name));
  }
}

std::vector<SourceMaterial> SceneLooks::materials(std::vector<std::string>& warnings) const {
  std::vector<SourceMaterial> materials;
  materials.reserve(scene_.mNumMaterials);
  for (const aiMaterial* material : std::span(scene_.mMaterials, scene_.mNumMaterials)) {
    SourceMaterial& converted = materials.emplace_back();
    aiString string;
    if (material->Get(AI_MATKEY_NAME, string) == AI_SUCCESS) converted.name = text(string);
    const aiColor4D color = colorOf(*material, reader_);
    converted.base_color = {unitInterval(color.r), unitInterval(color.g), unitInterval(color.b),
                            unitInterval(color.a)};
    const auto [first, second] = colorTexturesOf(reader_);
    if (material->GetTexture(first, 0, &string) == AI_SUCCESS ||
        material->GetTexture(second, 0, &string) == AI_SUCCESS) {
      converted.base_color_texture = imageOf(string);
    }
    const bool is_factor =
        !converted.base_color_texture.empty() || has_vertex_colors_[materials.size() - 1];
    if (is_factor && isNoFactor(color, reader_)) converted.base_color = {1, 1, 1, 1};
    convertAlpha(*material, converted, warnings);
    // Other formats do not say which triangles are one-sided: show both sides, so that no surface
    // is lost.
    bool two_sided = reader_ != kGltf2Reader;
    if (!two_sided) material->Get(AI_MATKEY_TWOSIDED, two_sided);
    converted.two_sided = two_sided;
  }
  return materials;
}

std::vector<EmbeddedTexture> SceneLooks::textures(std::vector<std::string>& warnings) const {
  std::vector<EmbeddedTexture> textures;
  textures.reserve(scene_.mNumTextures);
  for (const aiTexture* texture : std::span(scene_.mTextures, scene_.mNumTextures)) {
    EmbeddedTexture& converted = textures.emplace_back();
    if (texture->mHeight != 0) {
      converted.format = "raw";
      warnings.push_back(
          fmt::format("embedded texture {} is not an encoded image: its pixels are ignored",
                      textures.size() - 1));
      continue;
    }
    const auto* hint = texture->achFormatHint;
    converted.format.assign(hint, std::find(hint, hint + sizeof(texture->achFormatHint), '\0'));
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(texture->pcData);
    converted.bytes.assign(bytes, bytes + texture->mWidth);
  }
  return textures;
}

}  // namespace galactic::bake
