#include "import/assimp_reader_wraps.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace galactic::bake {
namespace {

/// Reaching this far beyond an edge is invisible: it is one texel of the largest textures that are
/// baked by default.
constexpr float kUnseen = 1.0F / 512;

bool repeats(const aiMaterial& material, const char* key, aiTextureType type) {
  int mode = aiTextureMapMode_Wrap;
  material.Get(key, type, 0, mode);
  return mode == aiTextureMapMode_Wrap;
}

/// Whether the color texture repeats along u and along v; true if the material has no texture.
std::array<bool, 2> repeatsAlong(const aiMaterial& material) {
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    if (material.GetTextureCount(type) == 0) continue;
    return {repeats(material, _AI_MATKEY_MAPPINGMODE_U_BASE, type),
            repeats(material, _AI_MATKEY_MAPPINGMODE_V_BASE, type)};
  }
  return {true, true};
}

/// Whether a triangle has a corner where its texture would have to repeat, but does not.
bool reachesBeyond(const aiMesh& mesh, const std::array<bool, 2>& repeat) {
  if (!mesh.HasTextureCoords(0) || mesh.mFaces == nullptr) return false;
  const auto beyond = [](float along) { return along < -kUnseen || along > 1 + kUnseen; };
  const auto corner_is = [&](unsigned corner) {
    if (corner >= mesh.mNumVertices) return false;  // refused later
    const aiVector3D& uv = mesh.mTextureCoords[0][corner];
    return (!repeat[0] && beyond(uv.x)) || (!repeat[1] && beyond(uv.y));
  };
  return std::ranges::any_of(std::span(mesh.mFaces, mesh.mNumFaces), [&](const aiFace& face) {
    return std::ranges::any_of(std::span(face.mIndices, face.mNumIndices), corner_is);
  });
}

}  // namespace

void warnOfWraps(const aiScene& scene, std::vector<std::string>& warnings) {
  std::vector<bool> told(scene.mNumMaterials);
  for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
    const unsigned number = mesh->mMaterialIndex;
    if (number >= told.size() || told[number]) continue;
    const aiMaterial& material = *scene.mMaterials[number];
    const std::array<bool, 2> repeat = repeatsAlong(material);
    if ((repeat[0] && repeat[1]) || !reachesBeyond(*mesh, repeat)) continue;
    told[number] = true;
    aiString name;
    material.Get(AI_MATKEY_NAME, name);
    warnings.push_back(fmt::format(
        "the texture of material '{}' is clamped or mirrored in its file, and texture coordinates "
        "lie beyond its edges, where it is drawn repeated; export them from 0 to 1",
        name.C_Str()));
  }
}

}  // namespace galactic::bake
